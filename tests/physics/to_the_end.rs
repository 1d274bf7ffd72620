//! Runs run-ups to their end, leg by leg.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::resolved::ResolvedRunUps;
use rubmap::analysis::result::RunUps;
use rubmap::analysis::run::{ModelFacts, ReducedSector, run_up_leg, run_ups};

pub(crate) fn to_the_end(reduced: &ReducedSector, asked: &ResolvedRunUps, facts: &ModelFacts) -> RunUps {
    let (mut legs, mut course) = (Vec::new(), None);
    loop {
        let (leg, next) = run_up_leg(reduced, asked, course, &Unwatched).unwrap();
        legs.push(leg);
        course = next;
        if course.is_none() {
            return run_ups(asked, facts, legs).unwrap();
        }
    }
}
