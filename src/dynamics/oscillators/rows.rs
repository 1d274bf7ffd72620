//! Scalar displacements of contact nodes, as rows over the modal coordinates.

use faer::{Mat, MatRef, c64};
use pulp::Simd;

use super::super::modal_wheel::ModalWheel;
use super::padded;

/// A displacement direction at a contact node in (r, θ, z) components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Contact node, from the leading edge.
    pub node: usize,
    /// Components of the direction.
    pub components: [f64; 3],
}

impl Direction {
    /// dᵀφ of mode `mode`, φ given at the contact DOF (`n_b × modes`).
    pub(crate) fn of(&self, contact: MatRef<'_, c64>, mode: usize) -> c64 {
        (0..3).map(|c| contact[(3 * self.node + c, mode)] * self.components[c]).sum()
    }
}

/// Scalar displacements to be read or loaded: one row a contact normal or a sensor, for every nodal diameter.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    /// Number of rows.
    pub(crate) count: usize,
    /// Rows padded to whole vectors.
    pub(crate) stride: usize,
    pub(super) blocks: Vec<RowBlock>,
}

/// dᵀφ_m of each row direction d, real and imaginary parts.
#[derive(Debug, Clone)]
pub(super) struct RowBlock {
    pub(super) re: Matrix,
    pub(super) im: Matrix,
}

/// Row-major `[row][mode]`, modes padded to `length`.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    length: usize,
    values: Vec<f64>,
}

impl Matrix {
    fn zeros(rows: usize, length: usize) -> Self {
        Self { length, values: vec![0.0; rows * length] }
    }

    /// The rows of `group`, each cut to `vectors` vectors so that no index needs a check.
    #[inline(always)]
    pub(super) fn rows<S: Simd, const R: usize>(&self, group: [usize; R], vectors: usize) -> [&[S::f64s]; R] {
        let mut rows: [&[S::f64s]; R] = [&[]; R];
        for (slice, row) in rows.iter_mut().zip(group) {
            *slice = &S::as_simd_f64s(&self.values[row * self.length..][..self.length]).0[..vectors];
        }
        rows
    }
}

impl Rows {
    /// Rows over the first `integrated(modes)` of the modes of every nodal diameter.
    pub(crate) fn new(
        wheel: &ModalWheel,
        directions: &[Direction],
        integrated: impl Fn(usize) -> usize,
    ) -> Self {
        let blocks = wheel
            .harmonics
            .iter()
            .map(|h| row_block(&h.contact, directions, integrated(h.omega.len())))
            .collect();
        Self { count: directions.len(), stride: padded(directions.len()), blocks }
    }
}

fn row_block(contact: &Mat<c64>, directions: &[Direction], modes: usize) -> RowBlock {
    let length = padded(modes);
    let zeros = || Matrix::zeros(directions.len(), length);
    let mut block = RowBlock { re: zeros(), im: zeros() };
    for (row, direction) in directions.iter().enumerate() {
        for m in 0..modes {
            let value = direction.of(contact.as_ref(), m);
            block.re.values[row * length + m] = value.re;
            block.im.values[row * length + m] = value.im;
        }
    }
    block
}
