//! Linear algebra, transforms and statistics; nothing here knows of rotors.
//!
//! faer is built without its thread pool: every call runs on the calling thread, so results do not depend on how
//! many threads a machine has.

pub mod aligned;
pub mod anderson;
pub mod arnoldi;
pub mod block_lanczos;
pub mod complementarity;
pub mod convergence;
pub mod dense;
#[cfg(test)]
#[path = "../../../tests/properties/fixed.rs"]
mod fixed;
pub mod fragility;
pub mod gmres;
pub mod hermitian;
pub mod matrix_serde;
pub mod multifrontal;
pub mod nested_dissection;
pub mod orthonormal;
pub mod p_matrix;
pub mod paired_difference;
pub mod panel;
pub mod sampling;
pub mod sector_fourier;
pub mod sensitivity_indices;
pub mod sparse_cholesky;
pub mod sparse_product;
pub mod spectrum;
pub mod vector_block;
pub mod vectors;
