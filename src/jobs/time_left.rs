//! Time that a job still takes, by the pace of its first results, and how the plan's estimate stands against that pace.

use std::time::{Duration, Instant};

use crate::analysis::result::CostRange;
use crate::duration::in_words;

/// Least time and least share of the work by which a pace is known.
const FIRST: (Duration, f64) = (Duration::from_secs(5), 0.03);

/// Time between two changes of the words.
const BETWEEN: Duration = Duration::from_secs(2);

/// Ratio to the plan's range beyond which the plan was wrong.
const WRONG: f64 = 1.25;

/// Pace of the work of a job, in units of which some are done: speeds, or the whole.
#[derive(Debug, Default)]
pub(super) struct Pace {
    /// Time at which the work began here, and the units that were done then.
    begun: Option<(Instant, f64)>,
    /// Estimate of the plan, and the units that it is for.
    plan: Option<(CostRange, f64)>,
    words: String,
    worded: Option<Instant>,
}

impl Pace {
    /// Holds the pace against the estimate of the plan for so many `units`.
    pub(super) fn hold_against(&mut self, plan: CostRange, units: f64) {
        self.plan = Some((plan, units));
    }

    /// Begins with so many units `done`, unless the work has begun.
    pub(super) fn begin(&mut self, now: Instant, done: f64) {
        self.begun.get_or_insert((now, done));
    }

    /// Lets the next words be new, as there is more to do than before.
    pub(super) fn reword(&mut self) {
        self.worded = None;
    }

    /// Words on the time left with `done` units of `all`, to be set behind the phase; empty before the pace is known.
    pub(super) fn words(&mut self, now: Instant, done: f64, all: f64) -> &str {
        if self.worded.is_none_or(|last| now.duration_since(last) >= BETWEEN) {
            self.worded = Some(now);
            self.words = self.per_unit(now, done, all).map_or_else(String::new, |per_unit| {
                format!(
                    ", about {} left{}",
                    in_words(per_unit * (all - done).max(0.0)),
                    self.against_plan(per_unit)
                )
            });
        }
        &self.words
    }

    /// Seconds that a unit takes, once enough is done to tell and unless all is.
    fn per_unit(&self, now: Instant, done: f64, all: f64) -> Option<f64> {
        let (begin, before) = self.begun?;
        let (time, units) = (now.duration_since(begin), done - before);
        (time >= FIRST.0 && units >= FIRST.1 * all && done < all).then(|| time.as_secs_f64() / units)
    }

    /// Words on a plan whose range the pace leaves.
    fn against_plan(&self, per_unit: f64) -> String {
        let Some((plan, units)) = self.plan else { return String::new() };
        let takes = per_unit * units;
        let not = |word: &str, planned: f64| {
            format!("the plan was too {word}: {}, not {}", in_words(takes), in_words(planned))
        };
        if takes > WRONG * plan.contact {
            format!("; {} at most", not("low", plan.contact))
        } else if WRONG * takes < plan.free {
            format!("; {} at least", not("high", plan.free))
        } else {
            String::new()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Words after `seconds` of a job that began with nothing done.
    fn after(seconds: u64, done: f64, plan: Option<CostRange>) -> String {
        let begin = Instant::now();
        let mut pace = Pace::default();
        pace.begin(begin, 0.0);
        if let Some(plan) = plan {
            pace.hold_against(plan, 100.0);
        }
        pace.words(begin + Duration::from_secs(seconds), done, 100.0).to_owned()
    }

    #[test]
    fn the_first_results_tell_what_is_left() {
        assert_eq!(after(4, 10.0, None), "", "too soon");
        assert_eq!(after(60, 2.0, None), "", "too little");
        assert_eq!(after(10, 10.0, None), ", about 90 s left");
        assert_eq!(after(60, 20.0, None), ", about 4.0 min left");
        assert_eq!(after(60, 100.0, None), "", "all is done");
    }

    #[test]
    fn work_of_an_earlier_start_and_added_units_count() {
        let begin = Instant::now();
        let mut pace = Pace::default();
        pace.begin(begin, 50.0);
        pace.begin(begin, 0.0);
        let at = |seconds| begin + Duration::from_secs(seconds);
        assert_eq!(pace.words(at(10), 60.0, 100.0), ", about 40 s left");
        assert_eq!(pace.words(at(11), 61.0, 100.0), ", about 40 s left", "changes now and then only");
        pace.reword();
        assert_eq!(pace.words(at(11), 61.0, 100.0), ", about 39 s left");
        // As many again were added.
        assert_eq!(pace.words(at(50), 100.0, 200.0), ", about 1.7 min left");
    }

    #[test]
    fn a_plan_that_the_pace_leaves_is_named() {
        let plan = |free: f64, contact: f64| Some(CostRange { free, contact });
        // 1 s each: 100 s in all.
        assert_eq!(after(10, 10.0, plan(50.0, 80.5)), ", about 90 s left");
        assert_eq!(
            after(10, 10.0, plan(5.0, 45.0)),
            ", about 90 s left; the plan was too low: 1.7 min, not 45 s at most"
        );
        assert_eq!(after(10, 10.0, plan(124.0, 200.0)), ", about 90 s left");
        assert_eq!(
            after(10, 10.0, plan(180.0, 400.0)),
            ", about 90 s left; the plan was too high: 1.7 min, not 3.0 min at least"
        );
    }
}
