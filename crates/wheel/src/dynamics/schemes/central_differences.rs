//! Central differences, the paper's scheme (Eqs 8–10): second order in free motion.
//!
//! ```text
//! (z⁺ − 2z + z⁻)/h² + 2ζω (z⁺ − z⁻)/2h + ω² z = f
//! ```
//!
//! In the terms of [`super`]: keep = (1 − ζωh)/(1 + ζωh), receptance = h²/(1 + ζωh), so c = ζωh and B = h². The contact
//! force acts at the middle of the three instants and is the one that closes the gap at the last: the mass at the
//! contact DOF is stopped within a step and loses its kinetic energy at every closing. Contact makes the order of a
//! history between one and two.
//!
//! Step rule: ωh < 2 for every mode. At the limit itself the energy grows without bound while displacements still
//! look right.

use std::f64::consts::PI;

use super::mode_step::ModeStep;

/// Relative accuracy of ω_max and ω_max h: a step closer to the limit counts as the limit.
const ROUND_OFF: f64 = 1e-12;

/// Smallest number of steps per revolution with h = 2π/(ΩS) < 2/ω_max.
pub fn smallest_stable_steps(largest_frequency: f64, speed_rad_s: f64) -> u64 {
    let limit = PI * largest_frequency / speed_rad_s;
    ((limit * (1.0 + ROUND_OFF)).floor() as u64).saturating_add(1)
}

pub(super) fn mode_step(omega: f64, zeta: f64, h: f64) -> ModeStep {
    let c = zeta * omega * h;
    ModeStep { keep: (1.0 - c) / (1.0 + c), receptance: h * h / (1.0 + c) }
}

/// Velocity ż of a mode whose last increment is `increment`, as of [`first_increment`].
pub(super) fn velocity(omega: f64, zeta: f64, h: f64, displacement: f64, increment: f64) -> f64 {
    let ModeStep { keep, receptance } = mode_step(omega, zeta, h);
    ((1.0 + keep) * increment - omega * omega * receptance * displacement) / (2.0 * h)
}

/// First increment of a mode, from z⁺ − z⁻ = 2hż, the scheme's own velocity.
pub(super) fn first_increment(omega: f64, zeta: f64, h: f64, displacement: f64, velocity: f64) -> f64 {
    let ModeStep { keep, receptance } = mode_step(omega, zeta, h);
    (2.0 * h * velocity + omega * omega * receptance * displacement) / (1.0 + keep)
}
