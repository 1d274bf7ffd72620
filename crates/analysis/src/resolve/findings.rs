//! Violations found in a request.

use super::limits;
use crate::error::Violation;
use crate::model::ModelFacts;
use rubmap_wheel::dynamics::integrate::DIVERGED_SHARE_OF_RADIUS;

/// A range in words.
pub(crate) fn between(range: &std::ops::RangeInclusive<f64>) -> String {
    format!("between {:?} and {:?}", range.start(), range.end())
}

/// Collects violations.
#[derive(Debug, Default)]
pub(crate) struct Findings(pub(crate) Vec<Violation>);

impl Findings {
    pub(crate) fn require(&mut self, holds: bool, pointer: &str, message: impl Into<String>) {
        if !holds {
            self.0.push(Violation::new(pointer, message));
        }
    }

    /// Whether a violation lies at `pointer` or within it.
    pub(crate) fn refused(&self, pointer: &str) -> bool {
        let within = |violation: &Violation| {
            let rest = violation.pointer.strip_prefix(pointer);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        self.0.iter().any(within)
    }

    pub(crate) fn finish<T>(self, value: T) -> Result<T, Vec<Violation>> {
        if self.0.is_empty() { Ok(value) } else { Err(self.0) }
    }
}

/// Refuses lobes, an orbit or an initial state that would move a tip so far that the run ends as diverged.
pub(crate) fn check_reach(found: &mut Findings, length: f64, pointer: &str, facts: &ModelFacts) {
    let Some(radius) = facts.contact_radius.filter(|radius| *radius > 0.0) else { return };
    let reach = DIVERGED_SHARE_OF_RADIUS * radius;
    found.require(
        !limits::LENGTH.contains(&length) || length <= reach,
        pointer,
        format!(
            "{length} is out of proportion to this wheel, whose tips lie at a radius of up to {radius}: at most a tenth of that, {reach}, \
             is accepted; check the number and its unit"
        ),
    );
}
