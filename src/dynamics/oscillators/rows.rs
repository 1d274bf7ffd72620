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

/// dᵀφ_m of each row direction d: row-major `[row][mode]`, modes padded.
#[derive(Debug, Clone)]
pub(super) struct RowBlock {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

impl RowBlock {
    /// The rows of `group` in `part` (`re` or `im`), each cut to `vectors` vectors so that no index needs a check.
    #[inline(always)]
    pub(super) fn rows<S: Simd, const R: usize>(
        part: &[f64],
        group: [usize; R],
        length: usize,
        vectors: usize,
    ) -> [&[S::f64s]; R] {
        let mut rows: [&[S::f64s]; R] = [&[]; R];
        for (slice, row) in rows.iter_mut().zip(group) {
            *slice = &S::as_simd_f64s(&part[row * length..][..length]).0[..vectors];
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
    let mut block =
        RowBlock { re: vec![0.0; directions.len() * length], im: vec![0.0; directions.len() * length] };
    for (row, direction) in directions.iter().enumerate() {
        for m in 0..modes {
            let value = direction.of(contact.as_ref(), m);
            block.re[row * length + m] = value.re;
            block.im[row * length + m] = value.im;
        }
    }
    block
}
