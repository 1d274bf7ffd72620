//! Finite elements of one impeller sector: stress from displacement.
//!
//! The crate knows meshes and materials, and nothing of matrices, packages or speeds: the matrices that a wheel is simulated by come from
//! wherever the user's elements were integrated, and only their displacement comes here.

pub mod defect;
pub mod element;
pub mod extrapolation;
pub mod frame;
pub mod gauss;
mod gradients;
pub mod load;
pub mod material;
pub mod mesh;
pub mod natural;
pub mod rule;
pub mod shape;
pub mod skin;
pub mod stress;
pub mod topology;
pub mod uniform;
