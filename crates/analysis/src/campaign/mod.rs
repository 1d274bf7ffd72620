//! Campaigns: designs of a scene with other numbers, and what their speeds say together.

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
