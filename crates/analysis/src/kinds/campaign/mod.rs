//! Campaigns: designs of a scene with varied parameters, and the joint results of their speeds.

pub(crate) mod answer;
pub(crate) mod comparison;
pub(crate) mod designs;
pub mod distribution;
pub(crate) mod kind;
pub(crate) mod more;
pub(crate) mod outcomes;
pub(crate) mod plan;
pub mod request;
pub(crate) mod resolve;
pub mod resolved;
pub mod result;
pub(crate) mod sensitivities;
pub(crate) mod severity;
#[cfg(test)]
mod tests;
pub(crate) mod threshold;

pub use kind::CAMPAIGN;
