//! Where a parameter meets the limit with a probability: what the designs so far say.

use crate::request::Threshold;
use rubmap_numerics::fragility::{self, Fragility};

/// Confidence of intervals.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// What designs say of a threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Answer {
    /// What they say; none where no design has been decided.
    pub(super) fragility: Option<Fragility>,
    /// Where the probability is met, if that is known.
    pub(super) value: Option<f64>,
    /// Between which values the answer is open; an end is infinite where the designs do not bound it.
    pub(super) open: Option<(f64, f64)>,
}

/// Reads `cases`: values of the parameter, and whether the limit is met there.
pub(super) fn answer(cases: &[(f64, bool)], asked: &Threshold) -> Answer {
    let fragility = fragility::fit(cases);
    let (value, open) = match fragility {
        Some(Fragility::Apart { below, above, .. }) => (Some(0.5 * (below + above)), Some((below, above))),
        Some(Fragility::Curve(curve)) => {
            let crossing = curve.crossing(asked.probability, CONFIDENCE);
            (Some(crossing.x).filter(|x| x.is_finite()), Some(crossing.interval))
        }
        Some(Fragility::Always | Fragility::Never) | None => (None, None),
    };
    Answer { fragility, value, open }
}

impl Answer {
    /// Whether the value is known to `within` either way.
    pub(super) fn is_within(&self, within: f64) -> bool {
        self.open.is_some_and(|(low, high)| high - low <= 2.0 * within)
    }
}
