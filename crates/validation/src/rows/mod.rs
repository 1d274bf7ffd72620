//! Rows, a file for each part of the physics.

pub(crate) mod bending;
mod blade;
pub(crate) mod by_tests;
pub(crate) mod contact;
pub(crate) mod effects;
pub(crate) mod frequencies;
pub(crate) mod importers;
pub(crate) mod run_up;
pub(crate) mod sensitivities;
pub(crate) mod steady;
pub(crate) mod stress;
pub(crate) mod turning;
