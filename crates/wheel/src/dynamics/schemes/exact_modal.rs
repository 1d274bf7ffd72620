//! Exact propagator of every modal oscillator (docs/method.md, The exact propagator): no error in free motion at any step.
//!
//! ```text
//! z⁺ = 2a cosθ z − a² z⁻ + b f,   a = e^{−ζωh},  θ = ωh√(1−ζ²),  b = (1 − 2a cosθ + a²)/ω²
//! ```
//!
//! In the terms of [`super`]: keep = a², receptance = b. Exact for a steady force too; the contact force acts and closes
//! the gap as with central differences, and contact makes the order of a history between one and two.
//!
//! Step rule: none from free motion, ω²B ≤ 4 whatever h, with equality only undamped at odd multiples of ωh = π. A mode with ωh near π and
//! little damping, however, changes sign at every step and costs hardly any energy, so contact that opens and closes from step to step
//! drives it without bound. Where the wheel may touch, modes beyond [`FOLLOWS`] therefore follow statically, z⁺ = f/ω²: the limit of heavy
//! damping (a = 0), in the same recursion. The energy that they take is in the identity's loss. They also follow in part of a run under
//! forces of any kind: such a part hands on velocities, which increments do not determine at multiples of ωh = π.

use super::mode_step::ModeStep;

/// Value of ωh beyond which a mode follows statically where fast modes do: a sixth below the rhythm of the steps, π.
pub const FOLLOWS: f64 = 5.0 / 6.0 * std::f64::consts::PI;

pub(super) fn mode_step(omega: f64, zeta: f64, h: f64) -> ModeStep {
    let a = (-zeta * omega * h).exp();
    let receptance = if omega * h > 0.0 {
        // 1 − 2a cosθ + a² = (1 − a)² + 4a sin²(θ/2), without cancellation.
        let theta = omega * h * (1.0 - zeta * zeta).sqrt();
        let lag = (-zeta * omega * h).exp_m1();
        (lag * lag + 4.0 * a * (0.5 * theta).sin().powi(2)) / (omega * omega)
    } else {
        h * h
    };
    ModeStep { keep: a * a, receptance }
}

/// Whether a mode is too fast for the step.
pub(super) fn follows(omega: f64, h: f64) -> bool {
    omega * h > FOLLOWS
}

/// Recursion as of [`mode_step`], of a wheel whose fast modes follow.
pub(super) fn following_mode_step(omega: f64, zeta: f64, h: f64) -> ModeStep {
    if follows(omega, h) {
        ModeStep { keep: 0.0, receptance: 1.0 / (omega * omega) }
    } else {
        mode_step(omega, zeta, h)
    }
}

/// Value of ζωh beyond which a mode forgets its past within a step, to round-off: e^{−36} = 2e-16. Traced backwards the past would be
/// larger by as much, and its energy beyond all numbers.
const FORGETS: f64 = 36.0;

/// First increment of a mode, from the free motion backwards to −h; 0, as if held until now, for a mode that forgets its past.
pub(super) fn first_increment(omega: f64, zeta: f64, h: f64, displacement: f64, velocity: f64) -> f64 {
    if zeta * omega * h > FORGETS {
        return 0.0;
    }
    let (lag, sine) = backwards(omega, zeta, h);
    let swing = velocity + zeta * omega * displacement;
    displacement * lag + (zeta * omega * h).exp() * swing * sine
}

/// Least |sin θ| at which an increment determines the velocity.
const TELLS: f64 = 1e-3;

/// Velocity ż of a mode whose last increment is `increment`; 0 for a mode whose increments do not depend on it: ωh is near a multiple of π,
/// or its past forgotten.
pub(super) fn velocity(omega: f64, zeta: f64, h: f64, displacement: f64, increment: f64) -> f64 {
    if zeta * omega * h > FORGETS {
        return 0.0;
    }
    let (lag, sine) = backwards(omega, zeta, h);
    if (sine * omega).abs() < TELLS && omega * h > TELLS {
        return 0.0;
    }
    (increment - displacement * lag) / ((zeta * omega * h).exp() * sine) - zeta * omega * displacement
}

/// Factors of the free motion backwards: 1 − e^{ζωh} cosθ, without cancellation, and sinθ over the damped frequency.
fn backwards(omega: f64, zeta: f64, h: f64) -> (f64, f64) {
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let theta = damped * h;
    let lag = 2.0 * (0.5 * theta).sin().powi(2) - (zeta * omega * h).exp_m1() * theta.cos();
    (lag, if theta > 0.0 { theta.sin() / damped } else { h })
}
