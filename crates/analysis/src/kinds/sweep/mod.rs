//! Sweeps: contact simulations over rotational speeds.

pub(crate) mod kind;

pub use kind::{CRITICAL_SPEEDS, ERRORS, HISTORIES, STATES, SWEEP, WHEEL_CRITICAL_SPEEDS};
