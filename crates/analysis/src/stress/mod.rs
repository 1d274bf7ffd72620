//! Stress at every node of every blade over a revolution, and the margin that it leaves (docs/method.md, Stress).
//!
//! Stress is linear in the coordinates of the reduction, so one matrix per nodal diameter describes it; places are bounded first, and only
//! those that may be the worst are followed over all blades and instants.

#[cfg(test)]
mod against_full;
mod bounds;
mod cycle;
mod error;
mod extremes;
mod follow;
mod leaders;
mod look;
pub(crate) mod make;
mod measure;
mod metric;
mod places;
mod reduced;
mod search;
mod sums;
mod trajectory;

pub use make::{StressMaker, StressOf};
pub use reduced::{HarmonicStress, ReducedStress, StaticStress, StaticWheel};
pub(crate) use search::{Course, stress_of};

#[cfg(test)]
mod tests;
