//! Verdict on a sweep from its finished speeds.

use super::evidence::{Evidence, Seen};
use super::hidden::maxima;
use super::limit::Asked;
use super::points::Finished;
use super::rule::{self, Judged};
use super::sentence;
use crate::resolved::ResolvedSweep;
use crate::result::{
    JudgedSpeed, JudgedValue, Point, Position, RangePosition, RangeVerdict, SweepVerdict, VerdictWord,
    WheelCriticalSpeed,
};
use crate::span::Span;
use crate::tips::wheel_peaks;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::revision::VERSION;

/// Number of speeds that are named as the worst.
const WORST: usize = 3;

/// Relative distance within which two speeds belong to one peak, however rough its top is.
const SAME_PEAK: f64 = 0.01;

/// Judges the finished points of a sweep by the ranges and limits of its request.
pub fn judge(request: &ResolvedSweep, units: &Units, evidence: Evidence<'_>) -> SweepVerdict {
    let Evidence { points, errors, driven, unfinished } = evidence;
    let asked = Asked::of(request, errors);
    let peaks = wheel_peaks(request, points, errors);
    let finished = Finished::of(points);
    let maxima = maxima(request, &finished, &asked);
    let seen =
        Seen { finished: &finished, peaks: &peaks, maxima: &maxima, driven, unfinished, asked: &asked };
    let (ranges_given, spans) = Span::all(request);
    let judged: Vec<Judged> = spans.iter().map(|span| rule::judge(request, span, &seen)).collect();
    let named: &[Span] = if ranges_given { &spans } else { &[] };
    let speed = |point: &Point| judged_speed(point, named, &peaks, &asked);
    let of_index = |index: u32| points.iter().find(|point| point.index == index);
    let critical_speeds: Vec<JudgedSpeed> =
        peaks.iter().filter_map(|peak| of_index(peak.index)).map(speed).collect();
    let worst = worst(&judged, &critical_speeds, &spans, &finished, |index| of_index(index).map(speed));
    let mut would_decide = Vec::new();
    would_decide.extend(asked.none_given());
    would_decide.extend(judged.iter().flat_map(|of| of.open.iter().cloned()));
    let ranges: Vec<RangeVerdict> = judged.iter().map(|of| of.range.clone()).collect();
    let verdict = ranges.iter().map(|range| range.verdict).max().unwrap_or(VerdictWord::Undecided);
    let mut all = SweepVerdict {
        verdict,
        sentence: String::new(),
        ranges_given,
        ranges,
        critical_speeds,
        worst,
        would_decide,
        units: units.clone(),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    };
    all.sentence = sentence::sentence(&all, request, unfinished);
    all
}

/// Speed of a point against ranges and limits.
fn judged_speed(point: &Point, spans: &[Span], peaks: &[WheelCriticalSpeed], asked: &Asked) -> JudgedSpeed {
    let peak = peaks.iter().find(|peak| peak.index == point.index);
    let moving = point.responses.iter().filter(|response| response.sensor.gauge.is_none());
    let loudest = moving.max_by(|a, b| a.rms.total_cmp(&b.rms));
    let position = |span: &Span| RangePosition {
        range: span.name.clone().unwrap_or_default(),
        position: span.position(point.speed_rad_s),
        distance_percent: span.distance_percent(point.speed_rad_s),
    };
    JudgedSpeed {
        index: point.index,
        speed_rad_s: point.speed_rad_s,
        critical: peak.is_some(),
        resolved: peak.map(|peak| peak.resolved),
        speed_error_rad_s: peak.map(|peak| peak.speed_error_rad_s),
        tip: point.tip,
        engine_order: loudest.and_then(|response| response.dominant_engine_order),
        nodal_diameter: loudest.and_then(|response| response.dominant_nodal_diameter),
        ranges: spans.iter().map(position).collect(),
        limits: asked.values(point),
    }
}

/// Worst speeds, of each peak one: among the critical speeds in a range and the speeds with the largest values there; where there are none, the
/// critical speeds outside.
fn worst(
    judged: &[Judged],
    critical: &[JudgedSpeed],
    spans: &[Span],
    finished: &Finished,
    speed: impl Fn(u32) -> Option<JudgedSpeed>,
) -> Vec<JudgedSpeed> {
    let is_near =
        |speed: &&JudgedSpeed| spans.iter().any(|span| span.position(speed.speed_rad_s) != Position::Outside);
    let mut all: Vec<JudgedSpeed> = critical.iter().filter(is_near).cloned().collect();
    let largest = judged.iter().flat_map(|of| &of.range.limits).map(|worst| worst.index);
    for index in largest {
        if all.iter().all(|known| known.index != index) {
            all.extend(speed(index));
        }
    }
    if all.is_empty() {
        all = critical.to_vec();
    }
    // The order of critical speeds, by severity, decides between equal ones.
    all.sort_by(|a, b| match (worst_value(a), worst_value(b)) {
        (Some(a), Some(b)) => b.concern(a),
        (a, b) => b.is_some().cmp(&a.is_some()),
    });
    let mut apart: Vec<JudgedSpeed> = Vec::new();
    for speed in all {
        let is_same_peak = |other: &JudgedSpeed| {
            let near = (other.speed_rad_s - speed.speed_rad_s).abs() < SAME_PEAK * speed.speed_rad_s;
            let both_critical = speed.critical && other.critical;
            !both_critical && (near || finished.summit(speed.index) == finished.summit(other.index))
        };
        if !apart.iter().any(is_same_peak) {
            apart.push(speed);
        }
    }
    apart.truncate(WORST);
    apart
}

/// Worst value of a speed against its limit, as sentences order them; none where no value is known.
fn worst_value(speed: &JudgedSpeed) -> Option<&JudgedValue> {
    speed.limits.iter().max_by(|a, b| a.concern(b))
}
