//! The finite-element generator against closed forms and invariants.

mod eigen;
mod element;
mod wheel;
