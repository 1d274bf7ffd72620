//! Run-ups and run-downs (docs/method.md, Run-up and run-down): responses of a scene whose speed changes.

pub(crate) mod cutting;
pub(crate) mod frame;
pub(crate) mod kind;
pub(crate) mod march;
pub(crate) mod passing;
pub(crate) mod plan;
pub mod request;
pub(crate) mod resolve;
pub mod resolved;
pub mod result;
pub(crate) mod told;

pub use kind::{LEGS, RUN_UP, SPECTRA};
