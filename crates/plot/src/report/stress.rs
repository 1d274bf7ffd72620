//! Stress and margin of a sweep, and whether linear theory holds.

use maud::{Markup, html};
use rubmap_analysis::result::{
    FieldSurface, InteractionMap, Point, SpeedStress, Strengths, SweepStress, Validity, ValidityCheck,
    ValidityVerdict, stress_unit,
};

use super::page::{drawing, facts_table, picture};
use crate::axis::significant;
use crate::cells::rpm;
use crate::{HaighColour, SurfaceView, validity};

/// Number of cycles that are listed.
const LISTED: usize = 15;

/// Number of speeds that are named.
const NAMED: usize = 12;

/// Renders the section on stress; nothing for a sweep without stress.
pub(super) fn section(map: &InteractionMap, strengths: &[Strengths]) -> Markup {
    let speeds: Vec<SpeedStress> = map.points.iter().filter_map(SpeedStress::of).collect();
    let stress = SweepStress {
        speeds,
        strengths: strengths.to_vec(),
        units: map.units.clone(),
        settings: map.settings.clone(),
        version: map.version.clone(),
    };
    html! {
        @if !stress.speeds.is_empty() {
            h2 { "Stress and margin" }
            (facts_table(facts(&stress)))
            (cycles(&stress))
            (drawing(&crate::haigh(&stress, HaighColour::Speed)))
        }
    }
}

fn facts(stress: &SweepStress) -> Vec<(&'static str, String)> {
    let unit = stress_unit(&stress.units);
    let mut facts = Vec::new();
    let peak = |speed: &&SpeedStress| speed.stress.largest.von_mises;
    if let Some(at) = stress.speeds.iter().max_by(|a, b| peak(a).total_cmp(&peak(b))) {
        let largest = &at.stress.largest;
        let [x, y, z] = largest.position.map(significant);
        facts.push((
            "largest stress",
            format!(
                "{} {unit} (von Mises) at {:.0} rpm: node {} at ({x}, {y}, {z}) {} of the first sector, blade {}, revolution {:.2}",
                significant(largest.von_mises),
                rpm(at.speed_rad_s),
                largest.node,
                stress.units.length,
                largest.sector,
                largest.revolution
            ),
        ));
        let share = format!("{} {unit} at this speed", significant(at.stress.largest_static));
        facts.push(("of the centrifugal load alone", share));
    }
    let used = |speed: &SpeedStress| speed.stress.utilisation().filter(|used| used.is_finite());
    let most = stress.speeds.iter().filter_map(|speed| Some((used(speed)?, speed)));
    let most = most.max_by(|a, b| a.0.total_cmp(&b.0));
    facts.push(match most {
        Some((used, speed)) => (
            "largest utilisation",
            format!("{} at {:.0} rpm; at 1 nothing is left", significant(used), rpm(speed.speed_rad_s)),
        ),
        None => {
            let lacking = stress.speeds.iter().find_map(|speed| speed.stress.lacking.clone());
            (
                "utilisation",
                format!("none: {}", lacking.unwrap_or_else(|| "strengths are not known".to_owned())),
            )
        }
    });
    if let Some(speed) = stress.speeds.first() {
        let found = &speed.stress;
        facts.push((
            "left out",
            format!(
                "{} nodes of a sector within {} {} of a contact node, where forces act on points: nothing is claimed of contact stress",
                found.excluded_nodes,
                significant(found.excluded_radius),
                stress.units.length
            ),
        ));
    }
    facts
}

fn cycles(stress: &SweepStress) -> Markup {
    let unit = stress_unit(&stress.units);
    let or_none = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), significant);
    html! {
        table class="numbers" {
            tr {
                th { "Ω, rpm" } th { "node" } th { "blade" } th { "set" } th { "mean, " (unit) } th { "alternating, " (unit) }
                th { "principal mean" } th { "principal alternating" } th { "utilisation" } th { "over yield" }
            }
            @for (speed, cycle) in stress.ranked().into_iter().take(LISTED) {
                tr {
                    td { (format!("{:.0}", rpm(speed.speed_rad_s))) }
                    td { (cycle.node) }
                    td { (cycle.sector) }
                    td { (cycle.set) }
                    td { (significant(cycle.mean)) }
                    td { (significant(cycle.alternating)) }
                    td { (significant(cycle.principal_mean)) }
                    td { (significant(cycle.principal_alternating)) }
                    td { (or_none(cycle.utilisation)) }
                    td { (or_none(cycle.over_yield)) }
                }
            }
        }
        p class="small" { "Mean and alternating: half the sum and half the difference of the largest and the smallest von Mises stress with the sign of the mean normal stress over a revolution." }
    }
}

/// Renders the section on linear theory; nothing for results of versions that did not check it.
pub(super) fn validity_section(map: &InteractionMap) -> Markup {
    let judged: Vec<(&Point, &Validity)> =
        map.points.iter().filter_map(|point| Some((point, point.validity.as_ref()?))).collect();
    html! {
        @if !judged.is_empty() {
            h2 { "Is linear theory valid?" }
            p { (verdicts(&judged)) }
            @let lacking = validity::lacking(map);
            @if !lacking.is_empty() {
                p { "Not looked at, so that theory may fail where it is said to hold:" }
                ul { @for words in lacking { li { (words) } } }
            }
            (measures(&judged))
            (speeds(&judged))
        }
    }
}

fn verdicts(judged: &[(&Point, &Validity)]) -> String {
    let mut counts: Vec<(ValidityVerdict, &str, usize)> = Vec::new();
    for (_, found) in judged {
        let words = validity::words_without(found.verdict, &found.measures_lacking());
        match counts.iter_mut().find(|(_, known, _)| *known == words) {
            Some((_, _, count)) => *count += 1,
            None => counts.push((found.verdict, words, 1)),
        }
    }
    counts.sort_by_key(|(verdict, ..)| *verdict);
    let counts = counts.into_iter().map(|(_, words, count)| format!("{words} at {count} speeds"));
    format!("Of {} speeds: {}.", judged.len(), counts.collect::<Vec<_>>().join(", "))
}

/// Renders the largest value over the speeds of every measure of validity, beside its limits.
fn measures(judged: &[(&Point, &Validity)]) -> Markup {
    let mut largest: Vec<(&Point, &ValidityCheck)> = Vec::new();
    for (point, check) in
        judged.iter().flat_map(|(point, found)| found.checks.iter().map(|check| (*point, check)))
    {
        match largest.iter_mut().find(|(_, known)| known.what == check.what) {
            Some(known) if known.1.value < check.value => *known = (point, check),
            Some(_) => {}
            None => largest.push((point, check)),
        }
    }
    html! {
        table class="numbers" {
            tr { th { "number" } th { "largest" } th { "at, rpm" } th { "doubtful above" } th { "beyond above" } }
            @for (point, check) in largest {
                tr {
                    td { (validity::measure(check.what)) }
                    td { (significant(check.value)) }
                    td { (format!("{:.0}", rpm(point.speed_rad_s))) }
                    td { (significant(check.doubtful_above)) }
                    td { (check.beyond_above.map_or_else(|| "–".to_owned(), significant)) }
                }
            }
        }
    }
}

/// Lists the speeds at which linear theory does not hold, with the number that decides.
fn speeds(judged: &[(&Point, &Validity)]) -> Markup {
    let reason = |(point, found): &(&Point, &Validity)| {
        Some(format!("{:.0} rpm: {}", rpm(point.speed_rad_s), validity::reason(found)?))
    };
    let found: Vec<String> = judged.iter().filter_map(reason).collect();
    html! {
        @if !found.is_empty() {
            ul {
                @for words in found.iter().take(NAMED) { li { (words) } }
                @if found.len() > NAMED { li { (found.len() - NAMED) " more speeds" } }
            }
        }
    }
}

/// Renders pictures of the wheel and its sectors.
pub(super) fn pictures(surfaces: &[(FieldSurface, SurfaceView)]) -> Markup {
    html! {
        @if !surfaces.is_empty() {
            h2 { "Shapes and stresses" }
            @for (surface, front) in surfaces {
                (picture(&crate::surface(surface, *front)))
                (picture(&crate::surface(surface, SurfaceView::Meridional)))
            }
        }
    }
}
