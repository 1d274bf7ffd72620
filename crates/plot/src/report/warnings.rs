//! Warnings of a report: limits on the trust in its numbers.

use maud::{Markup, html};
use rubmap_analysis::result::{CriticalSpeeds, InteractionMap, Point, PointStatus, ReductionReport, Verdict};

use crate::cells::rpm;
use crate::validity;

/// Number of speeds without a result that are named.
const NAMED: usize = 8;

pub(super) fn section(warnings: &[String]) -> Markup {
    html! {
        h2 { "Warnings" }
        @if warnings.is_empty() {
            p { "None." }
        } @else {
            ul class="warnings" { @for warning in warnings { li { (warning) } } }
        }
    }
}

pub(super) fn sweep(map: &InteractionMap, critical: &[CriticalSpeeds]) -> Vec<String> {
    let mut found = Vec::new();
    match critical.first() {
        Some(table) => found.extend(reduction(&table.reduction)),
        None => found.extend(map.stiffening.and_then(|verdict| verdict.warning()).map(ToOwned::to_owned)),
    }
    let without: Vec<_> = map.points.iter().filter(|point| point.status != PointStatus::Completed).collect();
    for point in without.iter().take(NAMED) {
        let why = point.message.as_deref().unwrap_or("no reason is known");
        found.push(format!("No result at {:.0} rpm: {why}", rpm(point.speed_rad_s)));
    }
    if without.len() > NAMED {
        found.push(format!("No result at {} more speeds.", without.len() - NAMED));
    }
    let unsettled = map
        .points
        .iter()
        .filter_map(|point| point.settling.as_ref())
        .filter(|settling| settling.verdict == Verdict::NotSettled)
        .count();
    if unsettled > 0 {
        found.push(format!(
            "{unsettled} speeds had not settled at the end of the run: simulate more revolutions."
        ));
    }
    for verdict in validity::MARKED {
        let of_verdict = |point: &&Point| point.validity_verdict() == Some(verdict);
        let speeds = map.points.iter().filter(of_verdict).count();
        if speeds > 0 {
            found.push(format!(
                "{speeds} speeds: {}; the section on it has the numbers.",
                validity::words(verdict)
            ));
        }
    }
    if validity::without_thickness(map) {
        found.push(format!("At some speeds {}; the section on it says why.", validity::WITHOUT_THICKNESS));
    }
    let unresolved =
        critical.iter().flat_map(|table| &table.critical_speeds).filter(|peak| !peak.resolved).count();
    if unresolved > 0 {
        found.push(format!(
            "{unresolved} critical speeds are not resolved by the speeds of the sweep and may be higher between them, or beyond an \
             end of the range: \"refine\" adds speeds around them."
        ));
    }
    if map.errors.as_ref().and_then(|errors| errors.target_met) == Some(false) {
        found.push("Not all speeds are known to be within the accuracy that was asked for.".to_owned());
    }
    found
}

pub(super) fn reduction(report: &ReductionReport) -> Vec<String> {
    let mut found = Vec::new();
    let stiffening = &report.stiffening;
    if stiffening.verdict.warning().is_some() {
        found.push(stiffening.message.clone());
    }
    if report.counted_modes < report.modes {
        let missing = report.modes - report.counted_modes;
        found.push(format!("Of {missing} modes of the reduction it is not proven that they are the lowest."));
    }
    found
}
