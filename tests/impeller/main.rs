//! The finite-element generator against closed forms and invariants.

mod annulus;
mod beam;
mod calculix;
mod disk;
mod eigen;
mod element;
mod impeller_a;
mod plate;
mod sector;
mod wheel;
