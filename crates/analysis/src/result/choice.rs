//! The settings that were chosen for an accuracy or a budget, and why.

use serde::{Deserialize, Serialize};

use crate::request::{Accuracy, Budget, SchemeChoice, Setting};
use crate::resolved::{ResolvedModalAnalysis, ResolvedSweep};
use rubmap_wheel::response::settling::Verdict;

/// Settings that the service chose for a job, with the reasons.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Chosen {
    /// Settings of a sweep, chosen by pilot runs.
    Setting(Choice),
    /// Modes per speed of a modal analysis, chosen by its reductions.
    Modes(ModesChoice),
}

/// The setting that pilot runs chose, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Choice {
    /// The accuracy that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// The budget that was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Setting that was chosen.
    pub setting: Setting,
    /// Estimated relative error of the steady response, or of the stress if `accuracy.of` names it; the largest of the pilot speeds: the sum of
    /// `error_of_modes`, `error_of_steps`, `difference` and `spread`.
    pub estimated_error: f64,
    /// Part of `estimated_error` that more modes would remove.
    pub error_of_modes: f64,
    /// Part of `estimated_error` that more steps would remove.
    pub error_of_steps: f64,
    /// Part of `estimated_error` that the difference from a finer setting by `exact_modal` adds; `error_of_modes` and `error_of_steps` are then those
    /// of that setting. 0 where the chosen setting is itself one of these.
    #[serde(default)]
    pub difference: f64,
    /// Part of `estimated_error` that only a longer window would remove: the standard error of levels that do not repeat.
    pub spread: f64,
    /// Number of pilot speeds that the estimates rest on; at the others no run was completed.
    pub estimated_at: u32,
    /// Expected wall time of all speeds and of those that are simulated again with their reduction, s; with a budget, if no march ends before its
    /// limit.
    pub expected_wall_time_s: f64,
    /// Wall time from the beginning of the job to this choice, s; 0 in a plan.
    #[serde(default)]
    pub spent_s: f64,
    /// Reason for the choice, in words.
    pub reason: String,
    /// Speeds of the pilot runs, rad/s.
    pub pilot_speeds_rad_s: Vec<f64>,
    /// Pilot runs, setting by setting as they were tried.
    pub pilots: Vec<Pilot>,
}

impl Choice {
    /// Request with the knobs that were chosen, as if they had been given.
    #[must_use]
    pub fn explicit(&self, request: &ResolvedSweep) -> ResolvedSweep {
        request.at(self.setting)
    }
}

/// Errors of one setting at one pilot speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Pilot {
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// Time-stepping scheme.
    #[serde(default = "of_the_climb")]
    pub scheme: SchemeChoice,
    /// Time steps per revolution.
    pub steps_per_revolution: u32,
    /// Steady-state verdict; absent where the run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// Estimated error that more modes would remove; absent where a run was not completed, so that it is unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_of_modes: Option<f64>,
    /// Estimated error that more steps would remove; absent where a run was not completed, so that it is unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_of_steps: Option<f64>,
    /// Difference from a finer setting of the climb, for a setting that was compared with one; absent where the two cannot be compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difference: Option<f64>,
    /// Computing time of this run, s.
    pub time_s: f64,
}

/// Scheme of choices that earlier versions stored, which knew no other.
fn of_the_climb() -> SchemeChoice {
    SchemeChoice::ExactModal
}

/// The modes that were chosen, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ModesChoice {
    /// The accuracy that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// The budget that was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k.
    pub modes_per_speed: u32,
    /// Largest relative difference of the ten lowest frequencies of any nodal diameter from the full sector's.
    pub error: f64,
    /// Reason for the choice, in words.
    pub reason: String,
    /// Reductions that were compared.
    pub tried: Vec<TriedModes>,
}

impl ModesChoice {
    /// Request with the modes that were chosen, as if they had been given.
    #[must_use]
    pub fn explicit(&self, request: &ResolvedModalAnalysis) -> ResolvedModalAnalysis {
        request.at(self.modes_per_speed)
    }
}

/// A reduction that was compared with others to choose the modes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct TriedModes {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k.
    pub modes_per_speed: u32,
    /// Largest relative difference of the ten lowest frequencies of any nodal diameter from the full sector's.
    pub error: f64,
    /// Wall time of the reduction, s.
    pub wall_time_s: f64,
}
