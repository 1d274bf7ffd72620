//! Choice of the number of modes of a modal analysis, for the accuracy asked for or within a budget.
//!
//! Nothing is estimated here: every reduction compares its ten lowest frequencies of each nodal diameter with the full sector's.

use crate::accuracy::climb::{PLANNED_SHARE, Resources};
use crate::accuracy::rung::finer_modes;
use crate::error::Violation;
use crate::request::Accuracy;
use crate::resolved::ResolvedModalAnalysis;
use crate::result::{ModesChoice, ReductionReport, TriedModes};

/// Next step of the choice of modes.
#[derive(Debug, Clone, PartialEq)]
pub enum NextModes {
    /// Reduction that is missing, by its `modes_per_speed`.
    Reduce(u32),
    /// Choice of modes.
    Take(ModesChoice),
    /// Refusal: no number of modes meets the request.
    Refuse(Violation),
}

/// First rung of `modes_per_speed`.
const FIRST_MODES: u32 = 10;

/// Chooses for a resolved modal analysis from the reductions known so far.
pub fn next_modes(
    request: &ResolvedModalAnalysis,
    resources: &Resources,
    reports: &[ReductionReport],
) -> NextModes {
    let (_, accuracy, budget) = request.modes.fields();
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
        if let Some(Accuracy { target, .. }) = accuracy {
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
