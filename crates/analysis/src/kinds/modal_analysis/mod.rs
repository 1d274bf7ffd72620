//! Modal analyses: natural frequencies over speed, and the linear interaction criterion.

pub(crate) mod compute;
pub mod interference;
pub(crate) mod kind;
pub mod request;
pub mod resolved;
pub mod result;

pub use kind::{CAMPBELL, MODAL_ANALYSIS};
