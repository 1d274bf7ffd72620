//! Physics of the wheel: cyclic structure, reduction, contact and time integration, in the words of docs/method.md.

mod amplitude_sums;
pub mod bending;
#[cfg(test)]
mod bouncing_bar;
pub mod casing;
pub mod centrifugal;
pub mod clearance_change;
pub mod clearance_drift;
pub mod contact;
pub mod coriolis;
pub mod direction;
pub mod effects;
pub mod energy;
pub mod error;
pub mod euler;
pub mod excitation;
pub mod families;
pub mod findings;
pub mod flexible_casing;
pub mod initial;
pub mod integrate;
pub mod kept_rows;
pub mod mistuning;
pub mod modal_wheel;
pub mod node_rows;
pub mod nodes;
#[cfg(test)]
mod numbers;
pub mod orbit;
pub mod oscillators;
pub mod reduction;
pub mod run_up;
pub mod schemes;
pub mod sector;
pub mod states;
pub mod statistics;
pub mod steady;
pub mod symmetry;
pub mod waves;
