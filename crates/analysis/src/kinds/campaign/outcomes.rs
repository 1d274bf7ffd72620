//! Outcomes of the designs of a campaign.

use super::severity::{is_unsettled, severity};
use crate::resolved::ResolvedCampaign;
use crate::result::{CampaignDesign, DesignOutcome, Point, PointStatus};

/// Designs with their outcomes, from the finished speeds.
pub(super) fn designs_of(asked: &ResolvedCampaign, points: &[Point]) -> Vec<CampaignDesign> {
    let speeds = asked.sweep.speeds.rad_s();
    let of = asked.settings.severity;
    let nothing = DesignOutcome {
        finished: 0,
        diverged: 0,
        failed: 0,
        not_settled: 0,
        message: None,
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
        if point.status == PointStatus::Failed && outcome.message.is_none() {
            outcome.message.clone_from(&point.message);
        }
    }
    for design in &mut designs {
        for outcome in std::iter::once(&mut design.outcome).chain(&mut design.compared) {
            conclude(outcome, speeds, asked.settings.limit);
        }
    }
    designs
}

/// Completes the outcome of a design from its speeds: severity, worst speed, and whether the limit is met.
fn conclude(outcome: &mut DesignOutcome, speeds: &[f64], limit: Option<f64>) {
    let known = outcome.by_speed.iter().enumerate().filter_map(|(speed, value)| Some((speed, (*value)?)));
    let worst = known.clone().max_by(|a, b| a.1.total_cmp(&b.1));
    let all_known = known.count() == speeds.len();
    if all_known {
        outcome.severity = worst.map(|(_, severity)| severity);
        outcome.worst_speed_rad_s = worst.map(|(speed, _)| speeds[speed]);
    }
    outcome.meets_limit = limit.and_then(|limit| {
        // A diverged speed exceeds any limit, without a number.
        let exceeds = outcome.diverged > 0 || worst.is_some_and(|(_, severity)| severity > limit);
        (exceeds || all_known).then_some(!exceeds)
    });
}
