//! Unilateral contact between blade tips and casing (docs/method.md, Contact; Eqs 9, 10).
//!
//! At every step the gaps of all contact nodes of all sectors and their forces solve
//!
//! ```text
//! 0 ≤ λ ⊥ g = g_p + Wλ ≥ 0,   W = C_Nᵀ A⁻¹ C_N,   A = M/h² + D/2h
//! ```
//!
//! g_p being the gaps of the predicted displacements. Eq. 10 of the paper is the special case in which every
//! penetrating node, and no other, ends up active.

pub mod coating;
pub(crate) mod delassus;
pub mod disc;
pub(crate) mod disc_operator;
pub mod flexibility;
pub mod friction;
pub(crate) mod slopes;
