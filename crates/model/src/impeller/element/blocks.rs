//! Matrices of an element.

use nalgebra::{Matrix3, SMatrix, Vector3};

/// Matrix of an element as one 3 × 3 block (x, y, z) per pair of nodes, both triangles.
pub type Blocks<const N: usize> = Box<[[Matrix3<f64>; N]; N]>;
/// Matrix `m_ab` over the nodes of an element, the same for every direction.
pub type NodalMatrix<const N: usize> = SMatrix<f64, N, N>;

/// Blocks of `m_ab` times the diagonal block `directions` (x, y, z).
pub fn nodal_blocks<const N: usize>(m: &NodalMatrix<N>, directions: [f64; 3]) -> Blocks<N> {
    let unit = Matrix3::from_diagonal(&Vector3::from(directions));
    Box::new(std::array::from_fn(|a| std::array::from_fn(|b| unit * m[(a, b)])))
}
