//! Hexahedral elements: displacement functions on the cube −1 ≤ ξ, η, ζ ≤ 1 and their integrals.
//!
//! [`Hex20`] is the 20-node serendipity hexahedron, [`Hex8`] the 8-node one with incompatible modes for coarse
//! meshes. What both share is written once, in the default methods of [`Hexahedron`]: an element type states its
//! functions and its integration points.
//!
//! For an isotropic material all of a stiffness follows from `S_ab = ∫ ∇N_a ⊗ ∇N_b dV`:
//! `K_ab = λ S_ab + μ S_abᵀ + μ tr(S_ab) 1`.

mod blocks;
mod hex20;
mod hex8;
mod hexahedron;

pub use blocks::{Blocks, NodalMatrix, nodal_blocks};
pub use hex8::Hex8;
pub use hex20::Hex20;
pub use hexahedron::Hexahedron;
pub use rubmap_solid::gauss::{GaussPoint, gauss_points};
pub use rubmap_solid::natural::{CORNERS, EDGES, Natural};

pub use super::material::Stress;
