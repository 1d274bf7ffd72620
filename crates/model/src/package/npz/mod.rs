//! Sparse matrices as `scipy.sparse.save_npz` writes them: a zip of arrays, read and written in constant extra memory
//! but for the indices.
//!
//! `csr`, `csc` and `coo` of float64 or float32 with int32 or int64 indices; positions given twice are summed, as
//! scipy does. The file does not say whether it holds a whole (skew-)symmetric matrix or one triangle of it:
//! [`from_any`](super::symmetric::from_any) has the rule.

mod read;
mod write;
mod writer;

pub(super) use read::read;
pub(super) use write::write;
pub use writer::NpzWriter;
