//! Finite elements of one impeller sector: their matrices, and stress from displacement.
//!
//! The crate knows meshes and materials, and nothing of packages or speeds. The matrices that a wheel is simulated by come from here
//! ([`integrals`]) or from wherever the user's elements were integrated; stress needs their displacement only.

pub mod blocks;
pub mod defect;
pub mod element;
pub mod extrapolation;
pub mod frame;
pub mod gauss;
mod gradients;
pub mod green_lagrange;
pub mod inertia;
pub mod integrals;
pub mod load;
pub mod material;
pub mod mesh;
pub mod natural;
pub mod place;
pub mod rule;
pub mod shape;
pub mod silhouette;
pub mod skin;
pub mod stress;
pub mod topology;
pub mod uniform;

pub use gradients::jacobian;
