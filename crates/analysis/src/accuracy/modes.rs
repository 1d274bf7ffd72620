//! How many modes a modal analysis takes for the accuracy asked for, or within a budget.
//!
//! Nothing is estimated here: every reduction holds its ten lowest frequencies of each nodal diameter against the full sector's.

use serde::{Deserialize, Serialize};

use super::choice::{PLANNED_SHARE, Resources};
use super::rung::finer_modes;
use crate::auto_or::AutoOr;
use crate::error::Violation;
use crate::request::{Accuracy, Budget, ModalAnalysisRequest};
use crate::result::ReductionReport;

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
    /// k.
    pub modes_per_speed: u32,
    /// Largest relative difference of the ten lowest frequencies of any nodal diameter from the full sector's.
    pub error: f64,
    /// Why, in words.
    pub reason: String,
    /// The reductions that were compared.
    pub tried: Vec<TriedModes>,
}

impl ModesChoice {
    /// The request with the modes that were chosen, as if they had been given.
    #[must_use]
    pub fn explicit(&self, request: &ModalAnalysisRequest) -> ModalAnalysisRequest {
        ModalAnalysisRequest {
            modes_per_speed: AutoOr::Fixed(self.modes_per_speed),
            accuracy: None,
            budget: None,
            ..request.clone()
        }
    }
}

/// A reduction that was compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct TriedModes {
    /// k.
    pub modes_per_speed: u32,
    /// Its error.
    pub error: f64,
    /// What it took, s.
    pub wall_time_s: f64,
}

/// What comes next.
#[derive(Debug, Clone, PartialEq)]
pub enum NextModes {
    /// This reduction is missing.
    Reduce(u32),
    /// The choice.
    Take(ModesChoice),
    /// It cannot be had.
    Refuse(Violation),
}

/// First rung.
const FIRST_MODES: u32 = 10;

/// Chooses for a resolved modal analysis from the reductions known so far.
pub fn next_modes(
    request: &ModalAnalysisRequest,
    resources: &Resources,
    reports: &[ReductionReport],
) -> NextModes {
    let ModalAnalysisRequest { accuracy, budget, .. } = *request;
    let mut modes = FIRST_MODES.min(resources.most_modes.unwrap_or(u32::MAX));
    let mut tried: Vec<TriedModes> = Vec::new();
    loop {
        let Some(report) = reports.iter().find(|report| report.modes_per_speed == modes) else {
            return NextModes::Reduce(modes);
        };
        let error = report.largest_difference();
        let found = TriedModes { modes_per_speed: modes, error, wall_time_s: report.wall_time_s };
        let stalled = tried.last().is_some_and(|last: &TriedModes| {
            reports.iter().any(|r| r.modes_per_speed == last.modes_per_speed && r.unknowns == report.unknowns)
        });
        tried.push(found);
        let finer = finer_modes(modes, resources.most_modes).filter(|_| !stalled);
        if let Some(Accuracy { target }) = accuracy {
            if error <= target {
                let reason =
                    format!("the fewest modes whose frequencies are within {} of the full sector's", target);
                return NextModes::Take(ModesChoice {
                    accuracy,
                    budget,
                    modes_per_speed: modes,
                    error,
                    reason,
                    tried,
                });
            }
            if finer.is_none() {
                return NextModes::Refuse(Violation::new(
                    "/accuracy/target",
                    format!(
                        "{} is not reached with {modes} modes per speed: the frequencies differ by {error:.1e} from the full \
                         sector's, and there is nothing finer; ask for that",
                        target
                    ),
                ));
            }
        } else {
            let seconds = budget.map_or(0.0, |budget| budget.seconds);
            let known = reports.iter().any(|report| Some(report.modes_per_speed) == finer);
            let expected = if known { 0.0 } else { 2.0 * report.wall_time_s };
            if finer.is_none() || expected > PLANNED_SHARE * (seconds - resources.spent_s) {
                let reason = match finer {
                    Some(finer) => {
                        format!(
                            "the most modes that fit into {seconds} s; {finer} would take some {expected:.0} s more"
                        )
                    }
                    None => "there is nothing finer".to_owned(),
                };
                return NextModes::Take(ModesChoice {
                    accuracy,
                    budget,
                    modes_per_speed: modes,
                    error,
                    reason,
                    tried,
                });
            }
        }
        modes = finer.unwrap_or(modes);
    }
}
