//! Checks of mistuning.

use super::resolved::Mistuning;
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::mistuning::LARGEST_DEVIATION;

const MOST_SPREAD: f64 = 0.1;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    const AT: &str = "/scene/mistuning";
    match &request.scene.mistuning {
        None => {}
        Some(Mistuning::Given(deviations)) => {
            found.require(
                deviations.len() == facts.sectors as usize,
                &format!("{AT}/deviations"),
                format!("the wheel has {} sectors, not {}", facts.sectors, deviations.len()),
            );
            for (index, delta) in deviations.iter().enumerate().take(facts.sectors as usize) {
                found.require(
                    delta.abs() <= LARGEST_DEVIATION,
                    &format!("{AT}/deviations/{index}"),
                    format!("a sector deviates by at most {LARGEST_DEVIATION} of the stiffness"),
                );
            }
        }
        Some(Mistuning::Drawn { spread, .. }) => found.require(
            (0.0..=MOST_SPREAD).contains(spread),
            &format!("{AT}/spread"),
            format!("a spread lies between 0 and {}", MOST_SPREAD),
        ),
    }
}
