//! Tips of the whole wheel: the one that moves most, and the speeds at which that is dangerous.

use crate::request::{Component, Sensor};
use crate::resolved::ResolvedSweep;
use crate::response_curve::ResponseCurve;
use crate::result::{
    CriticalSpeeds, ErrorEstimate, Point, SensorView, TipResponse, WheelCriticalSpeed, WheelCriticalSpeeds,
};
use crate::span::Span;
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::direction::COMPONENTS;
use rubmap_wheel::dynamics::integrate::TipMotion;
use rubmap_wheel::dynamics::sector::ContactNode;
use rubmap_wheel::response::critical_speed::{Peak, Resolution, peaks};

/// Components in the order of the wheel's motions.
const IN_ORDER: [Component; COMPONENTS] = [Component::Radial, Component::Tangential, Component::Axial];

/// Relative difference up to which peaks count as one: blades that move alike differ by round-off.
const SAME_PEAK: f64 = 1e-9;

/// Tip with the largest root mean square, the first of equal ones, from the motions `[sector][contact node][component]`.
pub(super) fn largest_tip(
    motions: &[TipMotion],
    clearance: Option<&[f64]>,
    contact_nodes: &[ContactNode],
) -> Option<TipResponse> {
    let later_if_larger = |best: usize, now: usize| {
        if motions[now].rms > motions[best].rms { now } else { best }
    };
    let place = (0..motions.len()).reduce(later_if_larger)?;
    let motion = motions[place];
    let largest = motions.iter().map(|motion| motion.half_peak_to_peak).fold(0.0, f64::max);
    let (pair, component) = (place / COMPONENTS, place % COMPONENTS);
    let (sector, node) = (pair / contact_nodes.len(), pair % contact_nodes.len());
    let positions: Vec<_> = contact_nodes.iter().map(|node| node.position).collect();
    let over = |length: f64| (length > 0.0).then(|| motion.half_peak_to_peak / length);
    Some(TipResponse {
        rms: motion.rms,
        half_peak_to_peak: motion.half_peak_to_peak,
        largest_half_peak_to_peak: (largest > (1.0 + SAME_PEAK) * motion.half_peak_to_peak)
            .then_some(largest),
        contact_node: node as u32,
        sector: sector as u32,
        component: IN_ORDER[component],
        over_clearance: clearance.and_then(|clearance| over(clearance[node])),
        over_chord: over(arc_lengths(&positions).last().copied().unwrap_or(0.0)),
    })
}

/// Critical speeds of the wheel from the points of all speeds and the tables of its sensors.
pub fn wheel_critical_speeds(
    request: &ResolvedSweep,
    points: &[Point],
    errors: Option<&ErrorEstimate>,
    tables: &[CriticalSpeeds],
) -> Option<WheelCriticalSpeeds> {
    let first = tables.first()?;
    let view = |table: &CriticalSpeeds| SensorView {
        sensor: Sensor::clone(&table.sensor),
        critical_speeds: table.critical_speeds.clone(),
    };
    Some(WheelCriticalSpeeds {
        critical_speeds: wheel_peaks(request, points, errors),
        sensors: tables.iter().map(view).collect(),
        missing: first.missing.clone(),
        refinement: first.refinement.clone(),
        units: first.units.clone(),
        settings: first.settings.clone(),
        version: first.version.clone(),
    })
}

/// Peaks of the wheel's level that stand out by the asked share of the largest level: of the sweep, or of an operating range that reaches the peak,
/// so that a higher peak elsewhere hides none in a range.
pub(super) fn prominent(request: &ResolvedSweep, curve: &ResponseCurve, level: &[Option<f64>]) -> Vec<Peak> {
    let largest = |holds: &dyn Fn(f64) -> bool| {
        let values = curve.speeds_rad_s.iter().zip(level).filter(|(speed, _)| holds(**speed));
        values.filter_map(|(_, value)| *value).fold(0.0, f64::max)
    };
    let whole = largest(&|_| true);
    let spans = Span::of_ranges(request);
    let ranges: Vec<(&Span, f64)> =
        spans.iter().map(|span| (span, largest(&|speed| span.reaches(speed)))).collect();
    let stands_out = |peak: &Peak| {
        let near = ranges.iter().filter(|(span, _)| span.reaches(curve.speeds_rad_s[peak.index]));
        let scale = near.map(|(_, largest)| *largest).fold(whole, f64::min);
        peak.prominence >= request.peak_prominence * scale
    };
    let mut found = peaks(level, 0.0);
    found.retain(stands_out);
    found
}

/// Critical speeds of the wheel from the finished points of a sweep, the most severe first.
pub(super) fn wheel_peaks(
    request: &ResolvedSweep,
    points: &[Point],
    errors: Option<&ErrorEstimate>,
) -> Vec<WheelCriticalSpeed> {
    let curve = ResponseCurve::of(request.speeds.rad_s(), points);
    let level = curve.tip_level();
    let tips = || curve.points.iter().flatten().filter_map(|point| point.tip);
    // One scale for all.
    let severity: fn(&TipResponse) -> f64 = if tips().all(|tip| tip.over_clearance.is_some()) {
        |tip| tip.over_clearance.unwrap_or_default()
    } else if tips().all(|tip| tip.over_chord.is_some()) {
        |tip| tip.over_chord.unwrap_or_default()
    } else {
        |tip| tip.half_peak_to_peak
    };
    let critical = |peak: Peak| {
        let point = curve.points[peak.index]?;
        let tip = point.tip?;
        let resolution = Resolution::of(curve.of_values(&level), &peak);
        let contact = point.contact.as_ref();
        Some(WheelCriticalSpeed {
            speed_rad_s: point.speed_rad_s,
            index: point.index,
            severity: severity(&tip),
            tip,
            mean_force: contact.map(|contact| contact.mean_force),
            peak_force: contact.map(|contact| contact.peak_force),
            clearance_consumption: contact.map(|contact| contact.clearance_consumption),
            prominence: peak.prominence,
            at_edge: peak.at_edge,
            speed_error_rad_s: resolution.error,
            resolved: resolution.resolved,
            on_branch: resolution.on_branch,
            amplitude_error: errors.and_then(|errors| errors.of(point.index)),
            settling: point.settling.as_ref()?.verdict,
            utilisation: point.utilisation(),
            validity: point.validity_verdict(),
            validity_lacking: point.validity_lacking(),
        })
    };
    let mut critical_speeds: Vec<_> =
        prominent(request, &curve, &level).into_iter().filter_map(critical).collect();
    critical_speeds.sort_by(|a, b| b.severity.total_cmp(&a.severity));
    critical_speeds
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One blade swings steadily, another is still but for a knock that takes it farther.
    #[test]
    fn the_largest_peak_may_be_that_of_a_tip_that_moves_less() {
        let node = ContactNode { id: 1, position: [9.0, 0.0, 0.0], normal: [1.0, 0.0, 0.0], dofs: [0, 1, 2] };
        let still = TipMotion { rms: 0.0, half_peak_to_peak: 0.0 };
        let steady = TipMotion { rms: 0.7, half_peak_to_peak: 1.0 };
        let knocked = TipMotion { rms: 0.2, half_peak_to_peak: 1.5 };
        let tip = |motions: [TipMotion; 6]| {
            largest_tip(&motions, Some(&[2.0]), std::slice::from_ref(&node)).unwrap()
        };
        let both = tip([still, steady, still, knocked, still, still]);
        assert_eq!((both.sector, both.component, both.rms), (0, Component::Tangential, 0.7));
        assert_eq!((both.half_peak_to_peak, both.over_clearance), (1.0, Some(0.5)));
        assert_eq!((both.largest_half_peak_to_peak, both.peak_motion()), (Some(1.5), 1.5));
        // The same motion of another blade, but for round-off.
        let alike = TipMotion { half_peak_to_peak: 1.0 + 1e-15, ..steady };
        let alone = tip([still, steady, still, still, alike, still]);
        assert_eq!((alone.largest_half_peak_to_peak, alone.peak_motion()), (None, 1.0));
    }
}
