//! Settings of the time integration.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;

/// Settings of the time integration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// Time-stepping scheme.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, or `"auto"` for as many as the step carries.
    pub kept_modes: AutoOr,
    /// Time steps per revolution, or `"auto"` for a safe number at each speed.
    pub steps_per_revolution: AutoOr,
    /// Revolutions to simulate, or `"auto"`: until the motion repeats, when one of its periods becomes the window, and at most `most_revolutions`.
    /// With a number, every speed is marched for all of them.
    pub revolutions: AutoOr,
    /// Revolutions over which the restriction grows from zero to its full height.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub ramp_revolutions: f64,
    /// Revolutions at the end of the run that spectra are computed from.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub window_revolutions: u32,
    /// How the steady response is found.
    pub steady: SteadyChoice,
    /// Largest number of revolutions, after which a motion that does not repeat is left, with `revolutions: "auto"`.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub most_revolutions: u32,
    /// Share of the motion by which it may still change where it counts as repeating, with `revolutions: "auto"`; a tenth of `accuracy.target` if
    /// that is less.
    #[cfg_attr(feature = "schema", schema(minimum = 1e-12, maximum = 0.01))]
    pub settled_to: f64,
}

impl Default for Integration {
    fn default() -> Self {
        Self {
            scheme: SchemeChoice::Auto,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: AutoOr::Auto,
            revolutions: AutoOr::Auto,
            ramp_revolutions: 1.0,
            window_revolutions: 20,
            steady: SteadyChoice::March,
            most_revolutions: 100,
            settled_to: 1e-3,
        }
    }
}

impl Integration {
    /// Whether every speed takes as many revolutions as the request says.
    pub fn takes_all(&self) -> bool {
        self.revolutions != AutoOr::Auto && self.steady == SteadyChoice::March
    }

    /// Largest number of revolutions of a march.
    pub fn revolutions(&self) -> u32 {
        match self.revolutions {
            AutoOr::Fixed(revolutions) => revolutions,
            AutoOr::Auto => self.most_revolutions,
        }
    }
}

/// How the steady response of a speed is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SteadyChoice {
    /// March from where the scene begins, through the transient and over all revolutions; the window is their end.
    March,
    /// Periodic response, solved for whether it is stable or not: a motion that repeats with the lobes, of which one revolution is recorded. Where
    /// none is found the speed is marched, and says why.
    Periodic,
    /// Periodic response where it is stable and a march comes to it; elsewhere the speed is marched, and the periodic response reported beside.
    Auto,
}

/// Time-stepping scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SchemeChoice {
    /// Scheme chosen at each speed, with the step; the result says what and why.
    Auto,
    /// Central differences of the paper (Eqs 8–10); the stiffest mode bounds the step.
    CentralDifferences,
    /// Exact propagator of every mode; the contact sets the step.
    ExactModal,
    /// Massless boundary: the lowest modes carry the mass, the boundary responds quasi-statically; nothing is lost when a gap closes.
    MasslessBoundary,
}

impl SchemeChoice {
    /// Name of the scheme on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::CentralDifferences => "central_differences",
            Self::ExactModal => "exact_modal",
            Self::MasslessBoundary => "massless_boundary",
        }
    }
}
