//! Case studies: chosen speeds of which everything is recorded.

pub(crate) mod kind;
pub mod request;
pub(crate) mod resolve;
pub mod resolved;

pub use kind::{CASE_STUDY, HistoriesOfSweep};
