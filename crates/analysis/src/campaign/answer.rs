//! What the speeds of a campaign say together, finished or not.

use super::comparison::comparison;
use super::digits::short;
use super::severity::{is_unsettled, severity};
use super::threshold::{Answer, CONFIDENCE, answer};
use crate::request::DesignKind;
use crate::resolved::ResolvedCampaign;
use crate::result::{
    Campaign, CampaignDesign, CampaignThreshold, DesignOutcome, ParameterSensitivity, Point, PointStatus,
    Sensitivities, Spent, ThresholdShare,
};
use rubmap_numerics::fragility::Fragility;
use rubmap_numerics::sensitivity_indices::{self, Indices};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::revision::VERSION;

/// The campaign from the simulations finished so far, in any order; the plan is for the caller to add.
pub fn campaign(asked: &ResolvedCampaign, units: &Units, points: &[Point]) -> Campaign {
    let designs = designs_of(asked, points);
    let own: Vec<&DesignOutcome> = designs.iter().map(|design| &design.outcome).collect();
    Campaign {
        speeds_rad_s: asked.sweep.speeds.rad_s().to_vec(),
        sensitivities: sensitivities(asked, &own),
        threshold: threshold(asked, &own),
        comparison: comparison(asked, &designs),
        designs,
        spent: Spent::on(points),
        plan: None,
        units: units.clone(),
        settings: asked.settings.clone(),
        version: VERSION.to_owned(),
    }
}

/// Every design with what its finished speeds say.
pub(super) fn designs_of(asked: &ResolvedCampaign, points: &[Point]) -> Vec<CampaignDesign> {
    let speeds = asked.sweep.speeds.rad_s();
    let of = asked.settings.severity;
    let nothing = DesignOutcome {
        finished: 0,
        diverged: 0,
        failed: 0,
        not_settled: 0,
        by_speed: vec![None; speeds.len()],
        severity: None,
        worst_speed_rad_s: None,
        meets_limit: None,
    };
    let empty = |(index, values): (usize, &Vec<f64>)| CampaignDesign {
        index: index as u32,
        values: values.clone(),
        outcome: nothing.clone(),
        compared: asked.compared.is_some().then(|| nothing.clone()),
    };
    let mut designs: Vec<CampaignDesign> = asked.settings.designs.iter().enumerate().map(empty).collect();
    for point in points {
        let (design, is_compared, speed) = asked.place(point.index);
        // Designs that were added since the request was read wait for the next reader.
        let Some(design) = designs.get_mut(design) else { continue };
        let own = &mut design.outcome;
        let outcome = design.compared.as_mut().filter(|_| is_compared).unwrap_or(own);
        outcome.finished += 1;
        outcome.diverged += u32::from(point.status == PointStatus::Diverged);
        outcome.failed += u32::from(point.status == PointStatus::Failed);
        outcome.not_settled += u32::from(is_unsettled(of, point));
        outcome.by_speed[speed as usize] = severity(of, point);
    }
    for design in &mut designs {
        for outcome in std::iter::once(&mut design.outcome).chain(&mut design.compared) {
            conclude(outcome, speeds, asked.settings.limit);
        }
    }
    designs
}

/// What the speeds of a design say together.
fn conclude(outcome: &mut DesignOutcome, speeds: &[f64], limit: Option<f64>) {
    let known = outcome.by_speed.iter().enumerate().filter_map(|(speed, value)| Some((speed, (*value)?)));
    let worst = known.clone().max_by(|a, b| a.1.total_cmp(&b.1));
    let all_known = known.count() == speeds.len();
    if all_known {
        outcome.severity = worst.map(|(_, severity)| severity);
        outcome.worst_speed_rad_s = worst.map(|(speed, _)| speeds[speed]);
    }
    outcome.meets_limit = limit.and_then(|limit| {
        // Of what grew beyond all bounds no number is needed.
        let exceeds = outcome.diverged > 0 || worst.is_some_and(|(_, severity)| severity > limit);
        (exceeds || all_known).then_some(!exceeds)
    });
}

/// Where the limit is met, by what designs come to with one model.
pub(super) fn threshold(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome]) -> Option<CampaignThreshold> {
    let (threshold, index) = asked.threshold()?;
    let cases = cases(asked, outcomes, index);
    let found = answer(&cases, threshold);
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
        message: words(&found, &threshold.parameter, threshold.probability),
        parameter: threshold.parameter.clone(),
    })
}

/// Designs of which it is known whether they meet the limit: the value of parameter `index`, and whether they do.
pub(super) fn cases(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome], index: usize) -> Vec<(f64, bool)> {
    let designs = asked.settings.designs.iter().zip(outcomes);
    designs.filter_map(|(values, outcome)| Some((values[index], outcome.meets_limit?))).collect()
}

/// How much of the variance of the severity each parameter accounts for, by what designs come to with one model.
pub(super) fn sensitivities(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome]) -> Option<Sensitivities> {
    if asked.settings.design.kind != DesignKind::Indices {
        return None;
    }
    let parameters = &asked.settings.parameters;
    let blocks = asked.settings.design.size.unwrap_or(0) as usize;
    // Those that were added belong to no block.
    let first = &outcomes[..blocks * sensitivity_indices::block_len(parameters.len())];
    let severities: Vec<Option<f64>> = first.iter().map(|outcome| outcome.severity).collect();
    let found = sensitivity_indices::decompose(&severities, parameters.len())?;
    let named = |(name, Indices { first_order, total }): (String, &Indices)| ParameterSensitivity {
        parameter: name,
        first_order: first_order.value,
        first_order_error: first_order.standard_error,
        total: total.value,
        total_error: total.standard_error,
    };
    let names = parameters.iter().map(|parameter| parameter.name.clone());
    Some(Sensitivities {
        mean: found.mean,
        variance: found.variance,
        blocks: found.blocks as u32,
        parameters: names.zip(&found.inputs).map(named).collect(),
    })
}

fn thresholds(found: &Answer) -> Option<(f64, f64)> {
    match found.fragility {
        Some(Fragility::Curve(curve)) => {
            Some(curve.thresholds()).filter(|(mean, deviation)| mean.is_finite() && deviation.is_finite())
        }
        _ => None,
    }
}

/// Most groups of designs whose share is told beside the curve, and the fewest designs of one.
const GROUPS: usize = 10;
const FEWEST: usize = 5;

/// Of groups of equally many neighbouring designs the share that meets the limit, with what the curve says of it.
fn shares(mut cases: Vec<(f64, bool)>, found: &Answer) -> Vec<ThresholdShare> {
    cases.sort_by(|a, b| a.0.total_cmp(&b.0));
    let groups = (cases.len() / FEWEST).clamp(1, GROUPS);
    let group = |group: usize| {
        let cases = &cases[group * cases.len() / groups..(group + 1) * cases.len() / groups];
        let (first, last) = (cases.first()?, cases.last()?);
        let expected = match found.fragility {
            Some(Fragility::Curve(curve)) => {
                Some(cases.iter().map(|(x, _)| curve.probability(*x)).sum::<f64>() / cases.len() as f64)
            }
            _ => None,
        };
        let designs = cases.len() as u32;
        let met = cases.iter().filter(|(_, met)| *met).count() as u32;
        Some(ThresholdShare { from: first.0, to: last.0, designs, met, expected })
    };
    (0..groups).filter_map(group).collect()
}

fn words(found: &Answer, parameter: &str, probability: f64) -> String {
    let percent = 100.0 * probability;
    match (found.fragility, found.value, found.open) {
        (None, ..) => "no design has been decided yet".to_owned(),
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
            format!(
                "the limit is met {side} a {parameter} between {below} and {above}, by all designs so far: nothing in between was simulated, \
                 and the others have made no difference yet"
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
