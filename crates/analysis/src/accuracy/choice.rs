//! Choice of the cheapest setting that meets a target, or of the most accurate one within a budget.
//!
//! Pilot runs at a few speeds of the scene climb two ladders that double: modes per speed and steps per revolution. At a setting (k, S) the
//! error of the modes is estimated from the difference to (2k, S), that of the steps from the difference to (k, 2S), and whichever is
//! larger is refined. In the climb time is stepped by the exact propagator with mass, which converges to the finite-element model as both
//! are refined. At the end of the climb, settings beside it are tried: settings between its rungs, and a boundary without mass, which is
//! cheaper but has a limit of its own. Their error is bounded by their difference from a run of the climb.
//!
//! [`next`] is a pure function of the runs known so far: it names the missing runs, and ends with a choice or a refusal.

use crate::accuracy::climb::{Climb, Next, Resources};
use crate::accuracy::rung::{Pilots, pilot_speeds};
use crate::error::Violation;
use crate::resolved::{Aim, Modes, ResolvedSweep, TrialRequest};
use crate::result::Trial;

/// Chooses for a resolved sweep of a wheel of `sectors`; `trial` looks up a known run.
pub fn next<'a>(
    request: &ResolvedSweep,
    sectors: u32,
    resources: &Resources,
    trial: &dyn Fn(&TrialRequest) -> Option<&'a Trial>,
) -> Next {
    let most_modes = resources.most_modes;
    let pilots = Pilots { request, sectors, most_modes, speeds: pilot_speeds(request), trial };
    let climb = Climb { request, resources, pilots };
    match request.modes {
        Modes::Sought(Aim::Accuracy(accuracy)) => climb.to_target(accuracy.target),
        Modes::Sought(Aim::Budget(budget)) => climb.within(budget.seconds),
        Modes::Given(_) => Next::Refuse(Violation::new("/accuracy", "there is no target and no budget")),
    }
}
