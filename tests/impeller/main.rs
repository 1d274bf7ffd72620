//! The finite-element generator against closed forms and invariants.

mod eigen;
mod wheel;
