//! Modal analyses: natural frequencies over speed, and the linear interaction criterion.

pub mod backbone_curves;
pub(crate) mod backbones;
pub(crate) mod compute;
pub mod interference;
pub(crate) mod kind;
pub mod request;
pub mod resolved;
pub mod result;

pub use kind::{BACKBONES, CAMPBELL, MODAL_ANALYSIS};
