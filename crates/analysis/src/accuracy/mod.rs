//! Accuracy and its computing time: runs at several settings, compared with each other.
//!
//! - [`trial`]: one run at one setting, with the compared quantities and the cost;
//! - [`errors`]: differences of a run from a finer one;
//! - a grid of settings against a reference (work and precision) is a kind of job: `kinds/study`;
//! - [`choice`]: the cheapest setting that meets a target (`target`), or the most accurate one that a budget pays for (`budget`), from
//!   a [`climb`] over [`rung`]s and what lies `beside` them;
//! - [`modes`]: the choice for a modal analysis, from its reductions;
//! - [`control`]: the error of a finished sweep, from some of its speeds at a finer setting.

mod beside;
mod budget;
mod candidate;
pub mod choice;
#[cfg(test)]
mod choice_tests;
pub mod climb;
pub mod control;
pub mod errors;
pub mod modes;
pub mod rung;
mod target;
pub mod trial;
