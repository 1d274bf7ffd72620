//! Strain energy of a sector that bends far, relaxed: measured validity of linear theory (docs/method.md, Stress).
//!
//! A linear field has no room for the in-plane shortening that bending brings, so its own energy under Green–Lagrange strain is mostly an
//! artefact. What remains once everything has relaxed that carries no motion tells how far linear theory holds.

mod bending;
mod condense;
mod measure;
mod modes;
mod quartic;
mod relax;
mod sector;

pub use bending::{BasisProjection, bending_bytes, blade_bending};
pub(crate) use bending::{bending_seconds, with_bending_cost};
pub use measure::{LargestMotion, MeasuredMotion, NotMeasured, measure, measuring_bytes};
pub(crate) use measure::{Neglected, PHASE, expected_bytes, relaxing_seconds};

#[cfg(test)]
mod calculix;
#[cfg(test)]
mod literal_wheel;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod wheel_tests;
