//! Places between the speeds of a sweep where a passed limit could hide: maxima that are not resolved, and wide steps beside linear critical
//! speeds.

use super::limit::Asked;
use super::points::Finished;
use crate::resolved::ResolvedSweep;
use crate::response_curve::ResponseCurve;
use crate::result::Point;
use crate::span::Span;
use rubmap_wheel::response::campbell::DrivenCrossing;
use rubmap_wheel::response::critical_speed::{Peak, RESOLVED_SHARE, Resolution, Wanted, peaks};

/// Distance from a linear critical speed, relative to it, within which steps must be narrow: contact moves a resonance by some per cent.
const BESIDE_CRITICAL: f64 = 0.03;

/// Narrowest step that is asked for beside a linear critical speed, relative to the speed.
const NARROWEST: f64 = 5e-3;

/// Share of a limit below which a maximum between steps of a bandwidth hides nothing: the top of a linear resonance is at most √2 higher.
const LOW: f64 = 0.5;

/// Maximum of the wheel's motion that the speeds beside it do not resolve.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Maximum {
    pub(super) index: u32,
    pub(super) speed_rad_s: f64,
    /// Root mean square of the tip that moves most.
    rms: f64,
    resolution: Resolution,
}

/// Wide step between two speeds beside a linear critical speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WideStep<'a> {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) crossing: &'a DrivenCrossing,
}

/// Half-power bandwidth 2ζ of the least damped mode, relative to its frequency.
fn bandwidth(request: &ResolvedSweep) -> f64 {
    let damping = request.scene.damping.as_ref();
    2.0 * damping
        .map_or(0.0, |damping| damping.family_ratios.iter().copied().fold(damping.modal_ratio, f64::min))
}

/// Widest step beside a linear critical speed, relative to the higher speed.
pub(super) fn widest_step(request: &ResolvedSweep) -> f64 {
    bandwidth(request).max(NARROWEST)
}

/// Maxima that are not resolved and stand out: with limits, by the asked share of their own height, so that a higher peak elsewhere hides none;
/// without, by that share of the largest motion.
pub(super) fn maxima(request: &ResolvedSweep, finished: &Finished, asked: &Asked) -> Vec<Maximum> {
    let curve = ResponseCurve::of(request.speeds.rad_s(), finished.points);
    let level = curve.tip_level();
    let largest = level.iter().flatten().copied().fold(0.0, f64::max);
    let near = bandwidth(request);
    let of = |peak: Peak| {
        let point = curve.points[peak.index]?;
        let scale = if asked.limits.is_empty() { largest } else { peak.height };
        let resolution = Resolution::of(curve.of_values(&level), &peak);
        let values = asked.values(point);
        let is_low = values.len() == asked.limits.len()
            && !values.is_empty()
            && values.iter().all(|judged| judged.value <= LOW * judged.allowed);
        let is_bound = is_low && !resolution.at_end && resolution.error <= near * point.speed_rad_s;
        let hides = peak.prominence >= request.peak_prominence * scale && !resolution.resolved && !is_bound;
        hides.then_some(Maximum {
            index: point.index,
            speed_rad_s: point.speed_rad_s,
            rms: peak.height,
            resolution,
        })
    };
    peaks(&level, 0.0).into_iter().filter_map(of).collect()
}

impl Maximum {
    /// Whether the top may lie in a range: between the completed speeds beside it. At an end of the sweep the response must fall at once for
    /// a top to hide beside it.
    pub(super) fn may_lie_in(&self, span: &Span, request: &ResolvedSweep, finished: &Finished) -> bool {
        let speeds = request.speeds.ascending();
        let ends = [speeds.first().copied(), speeds.last().copied()];
        let [below, above] = finished.beside(self.speed_rad_s);
        let is_high = |point: &Point| point.tip.is_some_and(|tip| tip.rms >= RESOLVED_SHARE * self.rms);
        let is_end = ends.contains(&Some(self.speed_rad_s));
        if is_end && below.xor(above).is_some_and(is_high) {
            return false;
        }
        let from = below.map_or(self.speed_rad_s, |point| point.speed_rad_s);
        let to = above.map_or(self.speed_rad_s, |point| point.speed_rad_s);
        from <= span.highest() && to >= span.lowest()
    }
}

/// Wide steps of a range and its separation beside the linear critical speeds in it that something drives: lobes that tips may touch, or
/// harmonic forces.
pub(super) fn wide_steps<'a>(
    request: &ResolvedSweep,
    span: &Span,
    driven: &'a [DrivenCrossing],
) -> Vec<WideStep<'a>> {
    let scene = &request.scene;
    let forced = |order: u32| scene.engine_order_excitation.iter().any(|force| force.order == order);
    let widest = widest_step(request);
    let speeds = request.speeds.ascending();
    let is_near = |crossing: &&DrivenCrossing| {
        span.reaches(crossing.speed_rad_s) && (scene.contact.is_some() || forced(crossing.engine_order))
    };
    let beside = |crossing: &'a DrivenCrossing| {
        let from = (crossing.speed_rad_s * (1.0 - BESIDE_CRITICAL)).max(span.lowest());
        let to = (crossing.speed_rad_s * (1.0 + BESIDE_CRITICAL)).min(span.highest());
        let wide = speeds.windows(2).filter(move |pair| {
            pair[1] > from && pair[0] < to && pair[1] - pair[0] > widest * (1.0 + 1e-9) * pair[1]
        });
        wide.map(move |pair| WideStep { from: pair[0], to: pair[1], crossing })
    };
    driven.iter().filter(is_near).flat_map(beside).collect()
}

/// Speeds by which a verdict could be made: middles of wide steps, and those that resolve maxima in its ranges. None without limits.
pub(crate) fn wanted(request: &ResolvedSweep, points: &[Point], driven: &[DrivenCrossing]) -> Vec<Wanted> {
    let asked = Asked::of(request, None);
    if asked.limits.is_empty() {
        return Vec::new();
    }
    let finished = Finished::of(points);
    let maxima = maxima(request, &finished, &asked);
    let (_, spans) = Span::all(request);
    let of_span = |span: &Span| {
        let middle =
            |step: WideStep| Wanted { speed: 0.5 * (step.from + step.to), width: step.to - step.from };
        let within = maxima.iter().filter(|maximum| maximum.may_lie_in(span, request, &finished));
        let steps = wide_steps(request, span, driven).into_iter().map(middle);
        steps.chain(within.flat_map(|maximum| maximum.resolution.wanted.clone())).collect::<Vec<_>>()
    };
    spans.iter().flat_map(of_span).collect()
}
