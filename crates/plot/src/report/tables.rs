//! Tables of a report.

use maud::{Markup, html};
use rubmap_analysis::result::{
    Backbones, CriticalSpeed, CriticalSpeeds, DrivenCrossing, InteractionMap, Point, SensorResponse,
    SweepLevel, Verdict,
};

use crate::axis::significant;
use crate::cells::rpm;
use crate::validity;

/// Number of largest responses that are listed.
const LISTED: usize = 10;

pub(super) fn critical_speeds(level: &SweepLevel, tables: &[CriticalSpeeds]) -> Markup {
    html! {
        (of_wheel(level))
        @for table in tables {
            h3 { "As one sensor sees them: " (table.sensor.to_string()) }
            @if table.critical_speeds.is_empty() {
                p { "No critical speed within the range." }
            } @else {
                (of_sensor(table))
            }
        }
        @if let Some(table) = tables.first() {
            h3 { "What the lobes can drive in this range (linear, without contact)" }
            (driven_crossings(&table.driven_crossings))
        }
    }
}

/// Critical speeds of the wheel, over all contact nodes, components and blades.
fn of_wheel(level: &SweepLevel) -> Markup {
    let all = &level.verdict.critical_speeds;
    let unit = &level.verdict.units.length;
    html! {
        p { (all.len()) " critical speeds of the wheel, over all contact nodes, components and blades, the most severe first." }
        @if !all.is_empty() {
            table class="numbers" {
                tr {
                    th { "Ω, rpm" } th { "within, rpm" } th { "engine order" } th { "nodal diameter" } th { "tip motion, " (unit) }
                    th { "over clearance" } th { "tip" } th { "resolved" }
                }
                @for speed in all {
                    tr {
                        td { (format!("{:.0}", rpm(speed.speed_rad_s))) }
                        td { (speed.speed_error_rad_s.map_or_else(|| "–".to_owned(), |error| format!("{:.0}", rpm(error)))) }
                        td { (or_none(speed.engine_order)) }
                        td { (or_none(speed.nodal_diameter)) }
                        @match &speed.tip {
                            Some(tip) => {
                                td { (significant(tip.half_peak_to_peak)) }
                                td { (tip.over_clearance.map_or_else(|| "–".to_owned(), significant)) }
                                td { "blade " (tip.sector) ", node " (tip.contact_node) ", " (tip.component.name()) }
                            }
                            None => { td { "–" } td { "–" } td { "–" } }
                        }
                        td { (if speed.resolved == Some(true) { "yes" } else { "no" }) }
                    }
                }
            }
        }
    }
}

fn of_sensor(table: &CriticalSpeeds) -> Markup {
    let unit = table.sensor.unit(&table.units);
    let peaks = || table.critical_speeds.iter();
    let (used, judged) =
        (peaks().any(|peak| peak.utilisation.is_some()), peaks().any(|peak| peak.validity.is_some()));
    html! {
        table class="numbers" {
            tr {
                th { "Ω, rpm" } th { "within, rpm" } th { "level, " (unit) " rms" } th { "peak, " (unit) }
                th { "engine order" } th { "nodal diameter" } th { "steady state" } th { "resolved" }
                th { "nearest linear (i, j, n)" } th { "at, rpm" } th { "off" }
                @if used { th { "utilisation" } }
                @if judged { th { "linear theory" } }
            }
            @for peak in &table.critical_speeds { (row(peak, used, judged)) }
        }
    }
}

/// Decimals of a critical speed in rpm: the maximum on a branch may be known better.
fn decimals(peak: &CriticalSpeed) -> usize {
    if peak.on_branch && rpm(peak.speed_error_rad_s) < 1.0 { 2 } else { 0 }
}

fn row(peak: &CriticalSpeed, used: bool, judged: bool) -> Markup {
    html! {
        tr {
            td { (format!("{:.*}", decimals(peak), rpm(peak.speed_rad_s))) }
            td { (format!("{:.*}", decimals(peak), rpm(peak.speed_error_rad_s))) }
            td { (significant(peak.rms)) }
            td { (significant(peak.half_peak_to_peak)) }
            td { (or_none(peak.dominant_engine_order)) }
            td { (or_none(peak.dominant_nodal_diameter)) }
            td { (verdict(peak.settling)) }
            td { (if peak.on_branch { "on a branch" } else if peak.resolved { "yes" } else { "no" }) }
            @match &peak.nearest_crossing {
                Some(near) => {
                    td { (format!("({}, {}, {})", near.nodal_diameter, near.family, near.superharmonic)) }
                    td { (format!("{:.0}", rpm(near.speed_rad_s))) }
                    td { (format!("{:+.1} %", 100.0 * (peak.speed_rad_s / near.speed_rad_s - 1.0))) }
                }
                None => { td { "none in range" } td { "–" } td { "–" } }
            }
            @if used { td { (peak.utilisation.map_or_else(|| "–".to_owned(), significant)) } }
            @if judged { td { (peak.validity.map_or("–", |verdict| validity::words_without(verdict, &peak.validity_lacking))) } }
        }
    }
}

pub(super) fn driven_crossings(crossings: &[DrivenCrossing]) -> Markup {
    html! {
        @if crossings.is_empty() {
            p { "None." }
        } @else {
            table class="numbers" {
                tr { th { "engine order" } th { "nodal diameter" } th { "family" } th { "Ω, rpm" } th { "f, Hz" } }
                @for crossing in crossings {
                    tr {
                        td { (crossing.engine_order) }
                        td { (crossing.nodal_diameter) }
                        td { (crossing.family) }
                        td { (format!("{:.0}", rpm(crossing.speed_rad_s))) }
                        td { (format!("{:.1}", crossing.frequency_hz)) }
                    }
                }
            }
        }
    }
}

/// Table of backbone curves: change of the frequency where each ends.
pub(super) fn backbones(found: &Backbones) -> Markup {
    html! {
        table class="numbers" {
            tr {
                th { "family" } th { "nodal diameter" } th { "up to, " (found.units.length) } th { "change of frequency" } th { "end" }
            }
            @for curve in &found.curves {
                @if let Some(last) = curve.points.last() {
                    tr {
                        td { (curve.family) }
                        td { (curve.nodal_diameter) }
                        td { (significant(last.amplitude)) }
                        td { (format!("{:+.2} %", last.change_percent)) }
                        td { (curve.end) }
                    }
                }
            }
        }
    }
}

/// Table of the speeds and sensors that move most, largest first.
pub(super) fn largest_responses(map: &InteractionMap) -> Markup {
    let responses = |point| -> Vec<(&Point, &SensorResponse)> {
        let point: &Point = point;
        point.responses.iter().map(|response| (point, response)).collect()
    };
    let mut all: Vec<_> = map.points.iter().flat_map(responses).collect();
    all.sort_by(|a, b| b.1.half_peak_to_peak.total_cmp(&a.1.half_peak_to_peak));
    let unit = &map.units.length;
    html! {
        table class="numbers" {
            tr {
                th { "Ω, rpm" } th { "where" } th { "peak, " (unit) } th { "level, " (unit) " rms" } th { "mean, " (unit) }
                th { "engine order" } th { "nodal diameter" } th { "contact" } th { "steady state" }
            }
            @for (point, response) in all.into_iter().take(LISTED) {
                tr {
                    td { (format!("{:.0}", rpm(point.speed_rad_s))) }
                    td { (response.sensor.to_string()) }
                    td { (significant(response.half_peak_to_peak)) }
                    td { (significant(response.rms)) }
                    td { (significant(response.mean)) }
                    td { (or_none(response.dominant_engine_order)) }
                    td { (or_none(response.dominant_nodal_diameter)) }
                    td { (format!("{:.1} %", 100.0 * point.contact_share)) }
                    td { (point.settling.as_ref().map_or("–", |settling| verdict(settling.verdict))) }
                }
            }
        }
        p class="small" { "Peak: half the peak-to-peak displacement over the window at the end of the run." }
    }
}

fn or_none<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| value.to_string())
}

/// Words for a verdict on the steady state.
pub(super) fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Periodic => "periodic",
        Verdict::Subharmonic => "subharmonic",
        Verdict::Aperiodic => "aperiodic",
        Verdict::NotSettled => "not settled",
    }
}
