//! Threshold of a campaign: value of a parameter at which the limit is met with a given probability, from the designs so far.

use crate::digits::short;
use crate::request::Threshold;
use crate::resolved::ResolvedCampaign;
use crate::result::{CampaignThreshold, DesignOutcome, ThresholdShare};
use rubmap_numerics::fragility::{self, Curve, Fragility};

/// Confidence of intervals.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// Threshold found from the designs so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Answer {
    /// Fitted fragility; none where no design has been decided.
    pub(super) fragility: Option<Fragility>,
    /// Value at which the probability is met, if known.
    pub(super) value: Option<f64>,
    /// Interval in which the threshold is undecided; an end is infinite where the designs do not bound it.
    pub(super) open: Option<(f64, f64)>,
    /// Whether a parameter that varies alone crosses the limit more than once, between the ends of `open`: no value divides its range.
    pub(super) is_crossed_again: bool,
}

/// Finds the threshold from `cases`, each a value of the parameter and whether the limit is met there; `varies_alone`: no other parameter
/// varies.
pub(super) fn answer(cases: &[(f64, bool)], asked: &Threshold, varies_alone: bool) -> Answer {
    let fragility = fragility::fit(cases);
    if varies_alone && matches!(fragility, Some(Fragility::Curve(_))) {
        return Answer { fragility, value: None, open: crossings(cases), is_crossed_again: true };
    }
    let (value, open) = match fragility {
        Some(Fragility::Apart { below, above, rising }) => {
            let open = if varies_alone {
                (below, above)
            } else {
                fragility::open_of_apart(cases, rising, asked.probability, CONFIDENCE)
            };
            (Some(0.5 * (below + above)), Some(open))
        }
        Some(Fragility::Curve(curve)) => {
            let crossing = curve.crossing(asked.probability, CONFIDENCE);
            (Some(crossing.x).filter(|x| x.is_finite()), Some(crossing.interval))
        }
        Some(Fragility::Always | Fragility::Never) | None => (None, None),
    };
    Answer { fragility, value, open, is_crossed_again: false }
}

/// Interval from the last case before the first crossing of the limit to the first case after its last crossing.
fn crossings(cases: &[(f64, bool)]) -> Option<(f64, f64)> {
    let mut sorted = cases.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let crossing = |pair: &&[(f64, bool)]| pair[0].1 != pair[1].1;
    let first = sorted.windows(2).find(crossing)?;
    let last = sorted.windows(2).rfind(crossing)?;
    Some((first[0].0, last[1].0))
}

impl Answer {
    /// Fitted curve; none for a parameter that varies alone, which has no probabilities.
    fn curve(&self) -> Option<Curve> {
        match self.fragility {
            Some(Fragility::Curve(curve)) if !self.is_crossed_again => Some(curve),
            _ => None,
        }
    }

    /// Whether the value is known to ± `within`.
    pub(super) fn is_within(&self, within: f64) -> bool {
        !self.is_crossed_again && self.open.is_some_and(|(low, high)| high - low <= 2.0 * within)
    }
}

/// Threshold of the limit, from the outcomes of designs with one model.
pub(super) fn threshold(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome]) -> Option<CampaignThreshold> {
    let (threshold, index) = asked.threshold()?;
    let cases = cases(asked, outcomes, index);
    let found = answer(&cases, threshold, asked.varies_alone());
    let range = asked.distributions.get(index).and_then(|of| Some(of.as_ref()?.range()));
    Some(CampaignThreshold {
        probability: threshold.probability,
        value: found.value,
        from: found.open.map(|(low, _)| low).filter(|end| end.is_finite()),
        to: found.open.map(|(_, high)| high).filter(|end| end.is_finite()),
        mean: thresholds(&found).map(|(mean, _)| mean),
        standard_deviation: thresholds(&found).map(|(_, deviation)| deviation),
        met_within: threshold.within.map(|within| found.is_within(within)),
        decided: cases.len() as u32,
        shares: shares(cases, &found),
        message: words(&found, &threshold.parameter, threshold.probability)
            + beyond(&found, range)
            + &left_out(outcomes),
        parameter: threshold.parameter.clone(),
    })
}

/// Designs with all speeds known: the value of parameter `index`, and whether the limit is met.
pub(super) fn cases(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome], index: usize) -> Vec<(f64, bool)> {
    let designs = asked.settings.designs.iter().zip(outcomes);
    let known = designs.filter(|(_, outcome)| outcome.is_complete());
    known.filter_map(|(values, outcome)| Some((values[index], outcome.meets_limit?))).collect()
}

fn thresholds(found: &Answer) -> Option<(f64, f64)> {
    let thresholds = found.curve()?.thresholds();
    Some(thresholds).filter(|(mean, deviation)| mean.is_finite() && deviation.is_finite())
}

/// Most groups of designs whose share is reported beside the curve, and the fewest designs of a group.
const GROUPS: usize = 10;
const FEWEST: usize = 5;

/// Shares of designs that meet the limit, in groups of equally many neighbouring designs, with the share that the curve expects.
fn shares(mut cases: Vec<(f64, bool)>, found: &Answer) -> Vec<ThresholdShare> {
    cases.sort_by(|a, b| a.0.total_cmp(&b.0));
    let groups = (cases.len() / FEWEST).clamp(1, GROUPS);
    let group = |group: usize| {
        let cases = &cases[group * cases.len() / groups..(group + 1) * cases.len() / groups];
        let (first, last) = (cases.first()?, cases.last()?);
        let mean =
            |curve: Curve| cases.iter().map(|(x, _)| curve.probability(*x)).sum::<f64>() / cases.len() as f64;
        let expected = found.curve().map(mean);
        let designs = cases.len() as u32;
        let met = cases.iter().filter(|(_, met)| *met).count() as u32;
        Some(ThresholdShare { from: first.0, to: last.0, designs, met, expected })
    };
    (0..groups).filter_map(group).collect()
}

/// Sentence about a value outside the range in which designs lie; empty inside.
fn beyond(found: &Answer, range: Option<(f64, f64)>) -> &'static str {
    match found.value.zip(range) {
        Some((value, (from, to))) if value < from || value > to => {
            "; that is outside the parameter's range, where nothing was simulated"
        }
        _ => "",
    }
}

/// Sentence about finished designs that do not count; empty if there are none.
fn left_out(outcomes: &[&DesignOutcome]) -> String {
    let finished = outcomes.iter().filter(|outcome| outcome.finished as usize == outcome.by_speed.len());
    let unknown = finished.clone().filter(|outcome| !outcome.is_complete()).count();
    if unknown == 0 {
        return String::new();
    }
    format!(
        "; {unknown} of {} finished designs are left out, as some of their speeds had not settled or could not be integrated",
        finished.count()
    )
}

fn words(found: &Answer, parameter: &str, probability: f64) -> String {
    let percent = short(100.0 * probability);
    match (found.fragility, found.value, found.open) {
        (None, ..) => "no design has been decided yet".to_owned(),
        (_, _, Some((low, high))) if found.is_crossed_again => {
            let (low, high) = (short(low), short(high));
            format!(
                "{parameter} crosses the limit more than once between {low} and {high}: no single value has designs that meet the limit on one \
                 side only"
            )
        }
        (Some(Fragility::Always), ..) => {
            format!(
                "all designs so far meet the limit, whatever their {parameter}: widen its range, or lower the limit"
            )
        }
        (Some(Fragility::Never), ..) => {
            format!(
                "no design so far meets the limit, whatever its {parameter}: widen its range, or raise the limit"
            )
        }
        (Some(Fragility::Apart { below, above, rising }), ..) => {
            let side = if rising { "from" } else { "up to" };
            let (below, above) = (short(below), short(above));
            let bounds = match found.open {
                Some((low, high)) if low.is_finite() && high.is_finite() && (low, high) != (below, above) => {
                    let (low, high) = (short(low), short(high));
                    format!(
                        "; with a probability of {percent} % between {low} and {high}, with a confidence of {} %",
                        100.0 * CONFIDENCE
                    )
                }
                Some((low, high)) if low.is_finite() && high.is_finite() => String::new(),
                _ => format!("; they are too few to say where that has a probability of {percent} %"),
            };
            format!(
                "the limit is met {side} a {parameter} between {below} and {above}, by all designs so far{bounds}"
            )
        }
        (Some(Fragility::Curve(curve)), Some(value), Some((low, high))) if low.is_finite() => {
            let side = if curve.is_rising() { "from" } else { "up to" };
            let [value, low, high] = [value, low, high].map(short);
            format!(
                "the limit is met with a probability of {percent} % {side} a {parameter} of {value}, between {low} and {high} with a \
                 confidence of {} %, if the thresholds of designs are normally distributed: compare shares and what is expected of them",
                100.0 * CONFIDENCE
            )
        }
        (Some(Fragility::Curve(_)), ..) => format!(
            "the designs so far do not tell how {parameter} bears on the limit: it may make no difference, or there are too few of them"
        ),
    }
}
