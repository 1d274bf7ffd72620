//! Campaigns: designs of a scene with varied parameters, and the joint results of their speeds.

pub(crate) mod answer;
mod comparison;
pub(crate) mod designs;
pub(crate) mod more;
mod outcomes;
pub(crate) mod plan;
mod sensitivities;
mod severity;
#[cfg(test)]
mod tests;
mod threshold;
