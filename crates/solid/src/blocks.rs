//! Matrices of one element.

use std::ops::{Index, IndexMut};

use nalgebra::{DMatrix, Matrix3, Vector3};

/// Matrix of an element as one 3 × 3 block (x, y, z) per pair of its functions, both triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    count: usize,
    /// Blocks, row by row.
    blocks: Vec<Matrix3<f64>>,
}

impl Blocks {
    /// Matrix of zeros over `count` functions.
    pub fn zeros(count: usize) -> Self {
        Self { count, blocks: vec![Matrix3::zeros(); count * count] }
    }

    /// Matrix with the block `block(a, b)` for the functions a and b.
    pub fn from_fn(count: usize, block: impl Fn(usize, usize) -> Matrix3<f64>) -> Self {
        let block = &block;
        Self { count, blocks: (0..count).flat_map(|a| (0..count).map(move |b| block(a, b))).collect() }
    }

    /// Matrix of `m_ab` times the diagonal block `directions` (x, y, z).
    pub fn scaled(m: &DMatrix<f64>, directions: [f64; 3]) -> Self {
        let unit = Matrix3::from_diagonal(&Vector3::from(directions));
        Self::from_fn(m.nrows(), |a, b| unit * m[(a, b)])
    }

    /// Number of functions.
    pub fn count(&self) -> usize {
        self.count
    }
}

impl Index<(usize, usize)> for Blocks {
    type Output = Matrix3<f64>;

    fn index(&self, (a, b): (usize, usize)) -> &Matrix3<f64> {
        &self.blocks[a * self.count + b]
    }
}

impl IndexMut<(usize, usize)> for Blocks {
    fn index_mut(&mut self, (a, b): (usize, usize)) -> &mut Matrix3<f64> {
        &mut self.blocks[a * self.count + b]
    }
}
