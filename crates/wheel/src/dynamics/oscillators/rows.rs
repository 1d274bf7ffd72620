//! Scalar displacements of contact nodes, as rows over the modal coordinates.

use faer::{Mat, MatRef, c64};
use pulp::Simd;

use super::super::direction::Direction;
use super::super::modal_wheel::ModalWheel;
use super::lanes::padded;
use rubmap_numerics::aligned::Aligned;

/// Scalar displacements to be read or loaded: one row a contact normal or a sensor, for every nodal diameter.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    /// Number of rows.
    pub(crate) count: usize,
    /// Rows padded to whole vectors.
    pub(crate) stride: usize,
    pub(super) blocks: Vec<RowBlock>,
}

/// Forces on rows, in Fourier coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Loads<'a> {
    pub(crate) rows: &'a Rows,
    /// Rows with a force on any sector.
    pub(crate) loaded: &'a [usize],
    /// Forces `[column][row]`, rows padded to their stride.
    pub(crate) force: &'a [f64],
}

/// Rows to be read, and where their values go.
#[derive(Debug)]
pub(crate) struct Readout<'a> {
    pub(crate) rows: &'a Rows,
    /// Values in Fourier coordinates, `[column][row]`, rows padded to their stride.
    pub(crate) out: &'a mut [f64],
}

/// Modal components dᵀφ_m of each row direction d, real and imaginary parts.
#[derive(Debug, Clone)]
pub(super) struct RowBlock {
    pub(super) re: Matrix,
    pub(super) im: Matrix,
}

/// Matrix in row-major order `[row][mode]`, modes padded to `length`; modes of the segment behind them have no part in it.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    pub(super) length: usize,
    values: Aligned,
}

impl Matrix {
    fn zeros(rows: usize, length: usize) -> Self {
        Self { length, values: Aligned::zeros(rows * length) }
    }

    /// Rows of `group`, each cut to `vectors` vectors so that no index needs a check.
    #[inline(always)]
    pub(super) fn rows<S: Simd, const R: usize>(&self, group: [usize; R], vectors: usize) -> [&[S::f64s]; R] {
        let mut rows: [&[S::f64s]; R] = [&[]; R];
        for (slice, row) in rows.iter_mut().zip(group) {
            *slice = &S::as_simd_f64s(&self.values[row * self.length..][..self.length]).0[..vectors];
        }
        rows
    }
}

impl RowBlock {
    /// Block with the entries of `matrix`, its columns padded to `length`.
    pub(super) fn padded(matrix: MatRef<'_, c64>, length: usize) -> Self {
        let zeros = || Matrix::zeros(matrix.nrows(), length);
        let mut block = Self { re: zeros(), im: zeros() };
        for row in 0..matrix.nrows() {
            for column in 0..matrix.ncols() {
                block.re.values[row * length + column] = matrix[(row, column)].re;
                block.im.values[row * length + column] = matrix[(row, column)].im;
            }
        }
        block
    }

    /// Matrix of the first `rows` rows, columns of the padding included.
    fn matrix(&self, rows: usize) -> Mat<c64> {
        let Self { re, im } = self;
        Mat::from_fn(rows, re.length, |row, m| {
            let at = row * re.length + m;
            c64::new(re.values[at], im.values[at])
        })
    }
}

impl Rows {
    /// Rows made by `of` from these, `count × modes` of each nodal diameter, modes padded.
    pub(super) fn map(&self, of: impl Fn(usize, MatRef<'_, c64>) -> Mat<c64>) -> Self {
        let block = |(index, block): (usize, &RowBlock)| {
            RowBlock::padded(of(index, block.matrix(self.count).as_ref()).as_ref(), block.re.length)
        };
        Self { blocks: self.blocks.iter().enumerate().map(block).collect(), ..*self }
    }

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
    let shape = |row: usize, m: usize| directions[row].of(contact.as_ref(), m);
    RowBlock::padded(Mat::from_fn(directions.len(), modes, shape).as_ref(), padded(modes))
}
