//! The finite-element generator against closed forms and invariants.

mod annulus;
mod beam;
mod conformity;
mod disk_mesh;
mod eigen;
mod element;
mod impeller_a;
mod impeller_mesh;
mod presets;
mod wheel;
