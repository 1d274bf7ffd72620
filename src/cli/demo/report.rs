//! Words of the demo about its results.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use crate::analysis::result::{
    CriticalSpeed, CriticalSpeeds, DrivenCrossing, InteractionMap, PointStatus, Verdict,
};

pub(super) fn rpm(speed_rad_s: f64) -> f64 {
    speed_rad_s * 60.0 / TAU
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Periodic => "periodic",
        Verdict::Subharmonic => "subharmonic",
        Verdict::Aperiodic => "aperiodic",
        Verdict::NotSettled => "not settled",
    }
}

/// Credentials of a map: how far its numbers can be trusted, in a few lines.
pub(super) fn credentials(map: &InteractionMap) -> String {
    let completed = map.points.iter().filter(|point| point.status == PointStatus::Completed);
    let count = |wanted: Verdict| {
        let verdicts = completed.clone().filter_map(|point| point.settling.as_ref());
        verdicts.filter(|settling| settling.verdict == wanted).count()
    };
    let verdicts = [Verdict::Periodic, Verdict::Subharmonic, Verdict::Aperiodic, Verdict::NotSettled];
    let verdicts = verdicts.map(|wanted| (count(wanted), verdict(wanted)));
    let verdicts: Vec<_> = verdicts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, words)| format!("{count} {words}"))
        .collect();
    let touching = completed.clone().filter(|point| point.contact_share > 0.0).count();
    let contact = completed.clone().fold((f64::INFINITY, 0f64), |(low, high), point| {
        (low.min(point.contact_share), high.max(point.contact_share))
    });
    let largest = |value: fn(&crate::analysis::result::Point) -> Option<f64>| {
        completed.clone().filter_map(value).fold(0.0, f64::max)
    };
    let mut out = String::new();
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(
        out,
        "{} of {} speeds computed: {}",
        completed.clone().count(),
        map.speeds_rad_s.len(),
        verdicts.join(", ")
    );
    out.push_str(&marches(map));
    if touching > 0 {
        let _ = writeln!(
            out,
            "contact at {touching} of them, in {:.1} to {:.1} % of the steps; penetration left at most {:.0e} {}",
            100.0 * contact.0,
            100.0 * contact.1,
            largest(|point| point.largest_penetration),
            map.units.length
        );
    }
    let steps: u64 = map.points.iter().map(|point| point.steps).sum();
    let _ = writeln!(
        out,
        "energy identity kept to {:.0e} over {:.1} million steps",
        largest(|point| point.energy_residual),
        steps as f64 / 1e6
    );
    out
}

/// Lengths of the runs that were to end once they repeat; empty where a number of revolutions was asked for.
fn marches(map: &InteractionMap) -> String {
    let marches = || map.points.iter().filter_map(|point| point.march.as_ref());
    let ended =
        || marches().filter(|march| march.period_revolutions.is_some()).map(|march| march.revolutions);
    let whole = marches().count() - ended().count();
    let mut words = Vec::new();
    if let (Some(least), Some(most)) = (ended().min(), ended().max()) {
        words.push(format!(
            "{} ended once they repeated, after {least} to {most} revolutions",
            ended().count()
        ));
    }
    if whole > 0 {
        words.push(format!("{whole} took all {}", map.settings.integration.revolutions()));
    }
    if words.is_empty() { String::new() } else { format!("marches: {}\n", words.join("; ")) }
}

/// Table of critical speeds beside the linear prediction.
pub(super) fn critical_speeds(table: &CriticalSpeeds) -> String {
    let unit = table.sensor.unit(&table.units);
    let mut out = String::new();
    let _ = writeln!(out, "Critical speeds: peaks of the {}\n", table.sensor);
    let _ = writeln!(
        out,
        "    Ω   within      level  prominence   engine  nodal                nearest linear crossing     driven at that order"
    );
    let _ = writeln!(
        out,
        "   rpm     rpm   {:>8}  {:>9}    order  diam.  steady state  (i, j, n)    rpm     off         rpm     off",
        format!("{unit} rms"),
        format!("{unit} rms")
    );
    for speed in &table.critical_speeds {
        let _ = writeln!(
            out,
            "{:>6.0}   {:>5.0} {} {:>8.4}   {:>8.4}   {:>6}  {:>5}  {:<12}  {}    {}",
            rpm(speed.speed_rad_s),
            rpm(speed.speed_error_rad_s),
            if speed.resolved { ' ' } else { '≥' },
            speed.rms,
            speed.prominence,
            or_none(speed.dominant_engine_order),
            or_none(speed.dominant_nodal_diameter),
            verdict(speed.settling),
            nearest_linear(speed),
            nearest_driven(speed, &table.driven_crossings),
        );
    }
    if table.critical_speeds.is_empty() {
        out.push_str("  none\n");
    }
    if table.critical_speeds.iter().any(|speed| !speed.resolved) {
        out.push_str("\n≥: the speeds do not resolve this peak, which may be higher between them, or beyond an end of the range\n");
    }
    out.push_str("\noff: how far the peak lies above (+) or below (-) the prediction\n");
    out.push_str("\nWhat the lobes can drive in this range (linear, without contact)\n\n");
    out.push_str("  engine order   nodal diameter   family      rpm        Hz\n");
    for crossing in &table.driven_crossings {
        let _ = writeln!(
            out,
            "  {:>12}   {:>14}   {:>6}   {:>6.0}   {:>7.1}",
            crossing.engine_order,
            crossing.nodal_diameter,
            crossing.family,
            rpm(crossing.speed_rad_s),
            crossing.frequency_hz
        );
    }
    out
}

fn or_none<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}

fn nearest_linear(speed: &CriticalSpeed) -> String {
    let Some(crossing) = &speed.nearest_crossing else { return format!("{:<26}", "none in range") };
    format!(
        "({}, {}, {})  {:>6.0}  {:>+5.1} %",
        crossing.nodal_diameter,
        crossing.family,
        crossing.superharmonic,
        rpm(crossing.speed_rad_s),
        100.0 * (speed.speed_rad_s / crossing.speed_rad_s - 1.0)
    )
}

/// Nearest of the driven crossings with the peak's own engine order.
fn nearest_driven(speed: &CriticalSpeed, driven: &[DrivenCrossing]) -> String {
    let same =
        driven.iter().filter(|crossing| speed.dominant_engine_order == Some(crossing.engine_order.into()));
    let distance = |crossing: &&DrivenCrossing| (crossing.speed_rad_s - speed.speed_rad_s).abs();
    match same.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        Some(crossing) => format!(
            "{:>6.0}  {:>+5.1} %",
            rpm(crossing.speed_rad_s),
            100.0 * (speed.speed_rad_s / crossing.speed_rad_s - 1.0)
        ),
        None => "  none in range".to_owned(),
    }
}

/// List of the files that the demo left for a user's own package.
pub(super) fn own_places(out: &Path, request: &Path, package: &Path) -> String {
    let folder = out.display();
    format!(
        "Look at   {folder}/report.html, level.svg, interaction-map.svg, interaction-map-frequency.svg, campbell.svg
Read      {folder}/verdict.json, interaction-map.json, critical-speeds.json, campbell.json
Edit      {}, and again: rubmap demo --package {} --request {} --out {folder}
Ask       rubmap serve --data {folder}/data
",
        request.display(),
        package.display(),
        request.display(),
    )
}

/// List of the files that the demo left; with `study`, those that a study adds.
pub(super) fn places(out: &Path, map: &str, study: bool) -> String {
    let folder = out.display();
    let (look, next) = if study {
        let words = "what accuracy costs in time, when the study below is done";
        (format!("\n          {folder}/work-precision-*.svg, histories.svg   {words}"), "")
    } else {
        (
            String::new(),
            "\nNext      rubmap demo --full   what accuracy costs in time: a study of some minutes",
        )
    };
    format!(
        "Look at   {folder}/report.html                    verdict, levels and limits, map, all on one page
          {folder}/level.svg                      largest motion over speed, with ranges and limits
          {folder}/interaction-map.svg            amplitude over speed and engine order
          {folder}/interaction-map-frequency.svg  the same over speed and frequency
          {folder}/campbell.svg                   natural frequencies over speed{look}
Read      {folder}/verdict.json, interaction-map.json, critical-speeds.json, campbell.json
Ask       rubmap serve --data {folder}/data
          curl 'http://127.0.0.1:8080{map}?sensor=1'   the trailing edge
Upload    {folder}/impeller.zip or a package of your own{next}\n"
    )
}
