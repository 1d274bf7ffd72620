//! Summary sheet of a report: one side of A4 for a review.

use maud::{Markup, html};
use rubmap_analysis::request::AutoOr;
use rubmap_analysis::result::{
    InteractionMap, JudgedSpeed, JudgedValue, Point, PointStatus, Position, SweepLevel, Verdict,
};
use serde_json::Value;

use super::asked::{plain, speeds};
use super::head::Head;
use super::page::{drawing, facts_table};
use super::verdict::sentence;
use crate::axis::{label, significant};
use crate::cells::rpm;
use crate::{marks, validity, wheel_level};

/// Number of values that a worst speed names.
const VALUES: usize = 2;

/// Number of open questions that the sheet names.
const QUESTIONS: usize = 3;

/// Renders the sheet: verdict, level over speed, worst speeds, wheel and scene, credentials.
pub(super) fn sheet(head: &Head, level: &SweepLevel, map: &InteractionMap) -> Markup {
    html! {
        section class="sheet" {
            (sentence(&level.verdict))
            (drawing(&wheel_level(level, None)))
            (worst(level))
            (questions(level))
            (facts_table(scene(head, map)))
            (facts_table(credentials(map)))
        }
    }
}

/// Table of the worst speeds against ranges and limits.
fn worst(level: &SweepLevel) -> Markup {
    let verdict = &level.verdict;
    let unit = &verdict.units.length;
    html! {
        @if !verdict.worst.is_empty() {
            table class="worst" {
                tr { th { "Worst speeds" } th { "Response" } th { "Where" } th { "Value" } th { "Limit" } th { "Against the limit" } }
                @for speed in &verdict.worst {
                    @let values = most(speed);
                    @let rows = values.len().max(1).to_string();
                    tr {
                        td rowspan=(rows) { strong { (label(rpm(speed.speed_rad_s), 0)) " rpm" } }
                        td.words rowspan=(rows) { (response(speed)) }
                        td.words rowspan=(rows) { (position(speed)) }
                        @match values.first() {
                            Some(first) => (cells(first, level)),
                            None => {
                                td { (speed.tip.map_or_else(String::new, |tip| format!("tip motion {} {unit}", significant(tip.peak_motion())))) }
                                td { "none" } td { "–" }
                            }
                        }
                    }
                    @for value in values.iter().skip(1) { tr { (cells(value, level)) } }
                }
            }
        }
    }
}

/// Values of a speed that are largest over their limits.
fn most(speed: &JudgedSpeed) -> Vec<JudgedValue> {
    let mut values = speed.limits.clone();
    values.sort_by(|a, b| (b.value / b.allowed).total_cmp(&(a.value / a.allowed)));
    values.truncate(VALUES);
    values
}

fn cells(value: &JudgedValue, level: &SweepLevel) -> Markup {
    let unit = value.limit.unit(&level.verdict.units);
    html! {
        td { (value.limit.words()) " " (value.known_words()) " " (unit) }
        td { (significant(value.allowed)) " " (unit) }
        td.standing { (value.standing_words()) }
    }
}

/// Kind of a speed, with engine order and nodal diameter.
fn response(speed: &JudgedSpeed) -> String {
    let kind = match (speed.critical, speed.resolved) {
        (true, Some(true)) => "peak",
        (true, _) => "peak, not resolved",
        (false, _) => "no peak",
    };
    let order = speed.engine_order.map(|order| format!(", engine order {}", marks::order(order)));
    let diameter = speed.nodal_diameter.map(|diameter| format!(", nodal diameter {diameter}"));
    format!("{kind}{}{}", order.unwrap_or_default(), diameter.unwrap_or_default())
}

/// Position of a speed against the nearest range.
fn position(speed: &JudgedSpeed) -> String {
    let nearest = speed.ranges.iter().min_by(|a, b| a.distance_percent.total_cmp(&b.distance_percent));
    nearest.map_or_else(
        || "no range given".to_owned(),
        |place| match place.position {
            Position::Inside => format!("in {}", place.range),
            Position::WithinSeparation => {
                format!("{:.1} % from {}, within its separation", place.distance_percent, place.range)
            }
            Position::Outside => format!("{:.1} % from {}", place.distance_percent, place.range),
        },
    )
}

/// Open questions, each with what would decide it.
fn questions(level: &SweepLevel) -> Markup {
    let open = &level.verdict.would_decide;
    html! {
        @if !open.is_empty() {
            p class="open" {
                strong { "Open: " }
                @for (place, question) in open.iter().take(QUESTIONS).enumerate() {
                    @if place > 0 { "; " }
                    (question.finding.replace('`', "")) " (" (question.remedy.replace('`', "")) ")"
                }
                @if open.len() > QUESTIONS { "; and " (open.len() - QUESTIONS) " more" }
                "."
            }
        }
    }
}

/// Wheel, casing, and settings in six lines.
fn scene(head: &Head, map: &InteractionMap) -> Vec<(&'static str, String)> {
    let fact = |wanted: &str| {
        let found = head.facts.iter().find(|(name, _)| *name == wanted);
        found.map_or_else(String::new, |(_, value)| value.clone())
    };
    let settings = &map.settings;
    let mut scene = match serde_json::to_value(&settings.scene) {
        Ok(Value::Object(scene)) => scene,
        _ => serde_json::Map::new(),
    };
    let casing = scene.remove("casing").map_or_else(|| "none".to_owned(), |casing| plain(&casing));
    let effects = scene.iter().filter(|(_, value)| **value != Value::Bool(false));
    let effects = effects.map(|(name, value)| {
        let (name, words) = (name.replace('_', " "), plain(value));
        if words == "yes" { name } else { format!("{name} ({words})") }
    });
    let integration = &settings.integration;
    let march = match integration.revolutions {
        AutoOr::Auto => format!(
            "until the motion repeats, at most {} revolutions; spectra over {}",
            integration.most_revolutions, integration.window_revolutions
        ),
        AutoOr::Fixed(revolutions) => {
            format!("{revolutions} revolutions; spectra over the last {}", integration.window_revolutions)
        }
    };
    vec![
        ("wheel", fact("model")),
        ("size", fact("wheel")),
        ("casing", format!("{casing}; lengths in {}", map.units.length)),
        ("effects", effects.collect::<Vec<_>>().join(", ")),
        ("speeds", speeds(&map.speeds_rad_s)),
        (
            "march",
            format!("{march}; {} modes per nodal diameter and speed", plain_value(&settings.modes_per_speed)),
        ),
    ]
}

fn plain_value(value: &impl serde::Serialize) -> String {
    serde_json::to_value(value).map(|value| plain(&value)).unwrap_or_default()
}

/// Credentials in words: settled, errors, energy, linear theory.
fn credentials(map: &InteractionMap) -> Vec<(&'static str, String)> {
    let completed: Vec<&Point> =
        map.points.iter().filter(|point| point.status == PointStatus::Completed).collect();
    let is_settled = |point: &&&Point| {
        point.settling.as_ref().is_some_and(|settling| settling.verdict != Verdict::NotSettled)
    };
    let settled = completed.iter().filter(is_settled).count();
    let settled = if settled == completed.len() {
        format!("all {settled} speeds")
    } else {
        format!("{settled} of {} speeds; the others need a longer march", completed.len())
    };
    let energy = completed.iter().filter_map(|point| point.energy_residual).fold(0.0, f64::max);
    let energy = if energy <= 1e-9 { "kept to round-off" } else { "violated: read the credentials below" };
    let errors = map.errors.as_ref().map_or_else(
        || "not estimated: there were no control runs".to_owned(),
        |errors| {
            let share = |value: Option<f64>| value.map(|value| format!("{} %", significant(100.0 * value)));
            let stress = share(errors.largest_of_stress)
                .map_or_else(String::new, |share| format!(", of stress {share}"));
            let response = share(errors.largest).unwrap_or_else(|| "unknown".to_owned());
            format!(
                "at most {response}{stress}; estimated from control runs at {} speeds",
                errors.controls.len()
            )
        },
    );
    let mut facts =
        vec![("settled", settled), ("error of the response", errors), ("energy balance", energy.to_owned())];
    let mut linear: Vec<(&str, usize)> = Vec::new();
    for words in completed.iter().filter_map(|point| Some(validity::words(point.validity_verdict()?))) {
        match linear.iter_mut().find(|(known, _)| *known == words) {
            Some((_, count)) => *count += 1,
            None => linear.push((words, 1)),
        }
    }
    let linear: Vec<String> =
        linear.into_iter().map(|(words, count)| format!("{words} at {count} speeds")).collect();
    if !linear.is_empty() {
        facts.push(("linear theory", linear.join(", ")));
    }
    facts
}
