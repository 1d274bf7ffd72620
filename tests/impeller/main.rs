//! The finite-element generator against closed forms and invariants.

mod annulus;
mod beam;
mod eigen;
mod element;
mod impeller_a;
mod wheel;
