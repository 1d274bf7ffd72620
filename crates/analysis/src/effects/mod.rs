//! Effects, a folder each: what a scene may say (`request.rs`, and `resolved.rs` where that has alternatives), and what the
//! program asks of it (`EFFECT` in `mod.rs`, with its checks, conversion, price and place in results beside it).

pub(crate) mod asked;
pub(crate) mod effect;
pub(crate) mod list;
pub(crate) mod physics;
pub(crate) mod table;

pub mod abradable;
pub mod casing;
pub mod centrifugal_stiffening;
pub mod clearance_change;
pub mod contact;
pub mod coriolis;
pub mod damping;
pub mod engine_order_excitation;
pub mod flexible_casing;
pub mod friction;
pub mod geometric_nonlinearity;
pub mod initial;
pub mod mistuning;
pub mod orbit;
pub mod probe;
pub mod symmetry;

/// Names of all effects, as scenes have them.
pub fn names() -> impl Iterator<Item = &'static str> {
    table::EFFECTS.iter().map(|effect| effect.name)
}
