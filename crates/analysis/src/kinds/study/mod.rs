//! Convergence studies: accuracy of settings and its cost in time.

pub(crate) mod grid;
pub(crate) mod kind;
pub mod request;
pub(crate) mod resolve;
pub mod resolved;
pub mod result;
pub(crate) mod work_precision;

pub use kind::{STUDY, WORK_PRECISION};
