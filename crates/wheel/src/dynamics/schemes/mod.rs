//! Time integration schemes: how a modal oscillator z̈ + 2ζωż + ω²z = f advances by a step h, and where contact acts.
//!
//! Every scheme is the same two-step recursion with its own numbers for each mode, so one kernel serves them all:
//!
//! ```text
//! d⁺ = keep·d − ω²·receptance·z + receptance·f,   z⁺ = z + d⁺        (d = z − z⁻)
//! ```
//!
//! Written symmetrically, with c = (1 − keep)/(1 + keep) and B = (1 + c)·receptance, it has the discrete energy identity
//! (docs/method.md, Energy)
//!
//! ```text
//! E⁺ − E = f (z⁺ − z⁻)/2 − c (d⁺ + d)²/(2B),   E = d²/(2B) + ½ ω² z z⁻
//! ```
//!
//! whose energy is positive, and the free motion stable, as long as ω²B < 4 and |keep| ≤ 1.
//!
//! | scheme | mass at the contact | gap is closed by | steps are bounded by |
//! |---|---|---|---|
//! | [`central_differences`] | yes | a force in the step before | ω_max of the reduced wheel |
//! | [`exact_modal`] | yes | a force in the step before | accuracy only |
//! | [`massless_boundary`] | no | a force at the same time | the wheel with its contact closed, twice over |

pub mod central_differences;
pub mod exact_modal;
pub mod massless_boundary;
mod mode_step;

pub use mode_step::ModeStep;

use super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::sector::ContactNode;

/// Scheme of time integration; chosen once per run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Central differences, the paper's scheme (Eqs 8–10).
    CentralDifferences,
    /// Exact propagator of every mode.
    ExactModal,
    /// Boundary without mass: the lowest modes carry the mass, the boundary follows statically.
    MasslessBoundary {
        /// Number of modes integrated per nodal diameter.
        kept_modes: usize,
    },
}

impl Scheme {
    /// Number of modes that are integrated of a nodal diameter with `modes` of them.
    pub fn integrated_modes(self, modes: usize) -> usize {
        match self {
            Self::CentralDifferences | Self::ExactModal => modes,
            Self::MasslessBoundary { kept_modes } => kept_modes.min(modes),
        }
    }

    /// Number of real unknowns of `wheel` that are integrated.
    pub fn integrated_unknowns(self, wheel: &ModalWheel) -> usize {
        let of = |h: &ModalHarmonic| self.integrated_modes(h.omega.len()) * if h.single { 1 } else { 2 };
        wheel.harmonics.iter().map(of).sum()
    }

    /// Fewest steps per revolution that are stable for `wheel`, whose blades may touch a casing at `contact_nodes` (empty: they never touch).
    pub fn smallest_stable_steps(self, wheel: &ModalWheel, contact_nodes: &[ContactNode]) -> u64 {
        match self {
            Self::CentralDifferences => {
                central_differences::smallest_stable_steps(wheel.largest_frequency(), wheel.speed_rad_s)
            }
            Self::ExactModal => 1,
            Self::MasslessBoundary { kept_modes } => {
                massless_boundary::smallest_stable_steps(wheel, kept_modes, contact_nodes)
            }
        }
    }

    /// Recursion of a mode (ω, ζ) at step h, of a wheel whose fast modes follow or not.
    pub fn mode_step(self, omega: f64, zeta: f64, h: f64, follow: bool) -> ModeStep {
        match self {
            Self::CentralDifferences => central_differences::mode_step(omega, zeta, h),
            Self::ExactModal if follow => exact_modal::following_mode_step(omega, zeta, h),
            Self::ExactModal | Self::MasslessBoundary { .. } => exact_modal::mode_step(omega, zeta, h),
        }
    }

    /// First increment d = z(0) − z(−h) of the free motion with z(0) = `displacement` and ż(0) = `velocity`; for a mode that follows
    /// statically, which has no past, the increment from its place at rest.
    pub fn first_increment(
        self,
        omega: f64,
        zeta: f64,
        h: f64,
        displacement: f64,
        velocity: f64,
        follow: bool,
    ) -> f64 {
        match self {
            Self::ExactModal if follow && exact_modal::follows(omega, h) => displacement,
            Self::CentralDifferences => {
                central_differences::first_increment(omega, zeta, h, displacement, velocity)
            }
            Self::ExactModal | Self::MasslessBoundary { .. } => {
                exact_modal::first_increment(omega, zeta, h, displacement, velocity)
            }
        }
    }

    /// Velocity ż at the end of a step of a mode with displacement z and increment d = z − z⁻: the inverse of [`Self::first_increment`]; 0
    /// for a mode that follows statically.
    pub fn velocity(self, omega: f64, zeta: f64, h: f64, z: f64, d: f64, follow: bool) -> f64 {
        match self {
            Self::CentralDifferences => central_differences::velocity(omega, zeta, h, z, d),
            Self::ExactModal if follow && exact_modal::follows(omega, h) => 0.0,
            Self::ExactModal | Self::MasslessBoundary { .. } => exact_modal::velocity(omega, zeta, h, z, d),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_is_read_back_from_its_increment() {
        let schemes =
            [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 1 }];
        for scheme in schemes {
            for (omega, zeta) in [(1.0, 0.0), (30.0, 0.02), (150.0, 0.3)] {
                let (h, z, v) = (0.01, 0.7, -20.0);
                let d = scheme.first_increment(omega, zeta, h, z, v, false);
                let found = scheme.velocity(omega, zeta, h, z, d, false);
                assert!((found - v).abs() < 1e-11 * omega.max(20.0), "{scheme:?} {omega}: {found}");
            }
        }
    }

    /// Mode that forgets its past within a step: traced backwards by a step its numbers would be 1e113 times as large, and no number at all.
    #[test]
    fn a_mode_that_forgets_its_past_within_a_step_starts_as_if_held() {
        for h in [13.0, 130.0] {
            let (omega, zeta) = (1000.0, 0.02);
            assert_eq!(Scheme::ExactModal.first_increment(omega, zeta, h, 0.7, -20.0, false), 0.0);
            assert_eq!(Scheme::ExactModal.velocity(omega, zeta, h, 0.7, 0.1, false), 0.0);
        }
    }
}
