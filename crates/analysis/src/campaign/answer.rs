//! What the speeds of a campaign say together, finished or not.

use super::severity::severity;
use super::threshold::{Answer, CONFIDENCE, answer};
use crate::request::DesignKind;
use crate::resolved::ResolvedCampaign;
use crate::result::{
    Campaign, CampaignDesign, CampaignThreshold, ParameterSensitivity, Point, PointStatus, Sensitivities,
    Spent, ThresholdShare,
};
use rubmap_numerics::fragility::Fragility;
use rubmap_numerics::sensitivity_indices::{self, Indices};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::revision::VERSION;

/// The campaign from the simulations finished so far, in any order; the plan is for the caller to add.
pub fn campaign(asked: &ResolvedCampaign, units: &Units, points: &[Point]) -> Campaign {
    let designs = designs_of(asked, points);
    Campaign {
        speeds_rad_s: asked.sweep.speeds.rad_s().to_vec(),
        sensitivities: sensitivities(asked, &designs),
        threshold: asked.threshold().map(|(threshold, index)| {
            let found = answer(&designs, threshold, index);
            let parameter = threshold.parameter.clone();
            CampaignThreshold {
                probability: threshold.probability,
                value: found.value,
                from: found.open.map(|(low, _)| low).filter(|end| end.is_finite()),
                to: found.open.map(|(_, high)| high).filter(|end| end.is_finite()),
                mean: thresholds(&found).map(|(mean, _)| mean),
                standard_deviation: thresholds(&found).map(|(_, deviation)| deviation),
                met_within: threshold.within.map(|within| found.is_within(within)),
                decided: designs.iter().filter(|design| design.meets_limit.is_some()).count() as u32,
                shares: shares(&designs, index, &found),
                message: words(&found, &parameter, threshold.probability),
                parameter,
            }
        }),
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
    let limit = asked.settings.limit;
    let empty = |(index, values): (usize, &Vec<f64>)| CampaignDesign {
        index: index as u32,
        values: values.clone(),
        finished: 0,
        diverged: 0,
        failed: 0,
        by_speed: vec![None; speeds.len()],
        severity: None,
        worst_speed_rad_s: None,
        meets_limit: None,
    };
    let mut designs: Vec<CampaignDesign> = asked.settings.designs.iter().enumerate().map(empty).collect();
    for point in points {
        let place = point.index as usize;
        // Designs that were added since the request was read wait for the next reader.
        let Some(design) = designs.get_mut(place / speeds.len()) else { continue };
        design.finished += 1;
        design.diverged += u32::from(point.status == PointStatus::Diverged);
        design.failed += u32::from(point.status == PointStatus::Failed);
        design.by_speed[place % speeds.len()] = severity(asked.settings.severity, point);
    }
    for design in &mut designs {
        let known = design.by_speed.iter().enumerate().filter_map(|(speed, value)| Some((speed, (*value)?)));
        let worst = known.clone().max_by(|a, b| a.1.total_cmp(&b.1));
        let all_known = known.count() == speeds.len();
        if all_known {
            design.severity = worst.map(|(_, severity)| severity);
            design.worst_speed_rad_s = worst.map(|(speed, _)| speeds[speed]);
        }
        design.meets_limit = limit.and_then(|limit| {
            // Of what grew beyond all bounds no number is needed.
            let exceeds = design.diverged > 0 || worst.is_some_and(|(_, severity)| severity > limit);
            (exceeds || all_known).then_some(!exceeds)
        });
    }
    designs
}

fn sensitivities(asked: &ResolvedCampaign, designs: &[CampaignDesign]) -> Option<Sensitivities> {
    if asked.settings.design.kind != DesignKind::Indices {
        return None;
    }
    let parameters = &asked.settings.parameters;
    let blocks = asked.settings.design.size.unwrap_or(0) as usize;
    // Those that were added belong to no block.
    let first = &designs[..blocks * sensitivity_indices::block_len(parameters.len())];
    let severities: Vec<Option<f64>> = first.iter().map(|design| design.severity).collect();
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
fn shares(designs: &[CampaignDesign], index: usize, found: &Answer) -> Vec<ThresholdShare> {
    let case = |design: &CampaignDesign| Some((design.values[index], design.meets_limit?));
    let mut cases: Vec<_> = designs.iter().filter_map(case).collect();
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
            format!(
                "the limit is met {side} a {parameter} between {below} and {above}, by all designs so far: nothing in between was simulated, \
                 and the others have made no difference yet"
            )
        }
        (Some(Fragility::Curve(curve)), Some(value), Some((low, high))) if low.is_finite() => {
            let side = if curve.is_rising() { "from" } else { "up to" };
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
