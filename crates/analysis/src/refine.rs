//! Refinement of a sweep: more speeds around peaks that are not resolved.

use crate::resolved::ResolvedSweep;
use crate::response_curve::ResponseCurve;
use crate::result::{Point, Refinement, Unresolvable, Unresolved};
use crate::span::Span;
use crate::tips::prominent;
use crate::verdict;
use rubmap_wheel::response::campbell::DrivenCrossing;
use rubmap_wheel::response::critical_speed::{ON_BRANCH, Peak, Resolution, Wanted, peaks};

/// Smallest limit of added speeds. A sweep gets at most as many added speeds as it had at first, or this many if those were fewer: a rough
/// curve, such as that of a chaotic response, has new peaks at every scale.
const LEAST_MOST_ADDED: usize = 50;

impl Refinement {
    /// Refinement of a sweep from the finished speeds, in any order; none if the sweep is not to be refined.
    pub(super) fn of(request: &ResolvedSweep, points: &[Point]) -> Option<Self> {
        if !request.refine {
            return None;
        }
        let speeds = request.speeds.rad_s();
        let finished = points.len() == speeds.len();
        let unresolved = if finished { unresolved(request, speeds, points) } else { Vec::new() };
        Some(Self {
            added: (speeds.len() - request.speeds.asked()) as u32,
            rounds: request.speeds.rounds(),
            complete: finished && unresolved.is_empty(),
            unresolved,
        })
    }
}

/// Largest number of speeds that a refinement adds to so many.
pub(crate) fn most_added(asked: usize) -> usize {
    asked.max(LEAST_MOST_ADDED)
}

/// Adds one more round of speeds to the request: the middles of the intervals beside the unresolved peaks of the wheel and of any sensor, the
/// expected maxima of solved responses, and speeds by which its verdict could be made. None if there is nothing to add, or no more may be added.
/// `points` are those of all speeds, `driven` the linear critical speeds that the scene can drive.
pub fn refine(request: &ResolvedSweep, points: &[Point], driven: &[DrivenCrossing]) -> Option<ResolvedSweep> {
    if !request.refine {
        return None;
    }
    let speeds = request.speeds.rad_s();
    let asked = request.speeds.asked();
    let most = (asked + most_added(asked)).saturating_sub(speeds.len());
    let mut wanted = wanted(request, speeds, points, driven);
    // Where not all can be added, those in the operating ranges go first, then peaks that are known worst; the sort is stable.
    let spans = Span::of_ranges(request);
    let elsewhere = |speed: f64| !spans.iter().any(|span| span.reaches(speed));
    wanted.sort_by(|a, b| {
        let wider = (b.width / b.speed).total_cmp(&(a.width / a.speed));
        elsewhere(a.speed).cmp(&elsewhere(b.speed)).then(wider)
    });
    wanted.truncate(most.min(request.speeds.lists().room()));
    let mut more: Vec<f64> = wanted.into_iter().map(|each| each.speed).collect();
    more.sort_by(f64::total_cmp);
    if more.is_empty() {
        return None;
    }
    // There is no middle between numbers so small that they are next to each other.
    let speeds = request.speeds.with_round(more)?;
    Some(ResolvedSweep { speeds, ..request.clone() })
}

/// Critical speeds with the index of their sensor, none for those of the wheel, and their resolution.
fn resolutions(
    request: &ResolvedSweep,
    speeds: &[f64],
    points: &[Point],
) -> Vec<(Option<u32>, f64, Resolution)> {
    let curve = ResponseCurve::of(speeds, points);
    let mut found = Vec::new();
    let mut add = |sensor: Option<u32>, level: &[Option<f64>], peaks: Vec<Peak>| {
        let of = |peak: Peak| {
            let resolution = Resolution::of(curve.of_values(level), &peak);
            (sensor, curve.speeds_rad_s[peak.index], resolution)
        };
        found.extend(peaks.into_iter().map(of));
    };
    let of_wheel = curve.tip_level();
    add(None, &of_wheel, prominent(request, &curve, &of_wheel));
    for sensor in 0..request.sensors.len() {
        let level = curve.level(sensor);
        add(Some(sensor as u32), &level, peaks(&level, request.peak_prominence));
    }
    found
}

/// Speeds that would resolve a peak of some sensor better, and those that a verdict lacks, ascending.
fn wanted(
    request: &ResolvedSweep,
    speeds: &[f64],
    points: &[Point],
    driven: &[DrivenCrossing],
) -> Vec<Wanted> {
    let resolutions = resolutions(request, speeds, points).into_iter();
    let mut wanted: Vec<_> = resolutions.flat_map(|(_, _, resolution)| resolution.wanted).collect();
    wanted.extend(verdict::wanted(request, points, driven));
    wanted.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    // Maxima of two sensors may be the same.
    wanted.dedup_by(|b, a| b.speed - a.speed <= 0.25 * ON_BRANCH * a.speed);
    wanted
}

/// Peaks that are not resolved.
fn unresolved(request: &ResolvedSweep, speeds: &[f64], points: &[Point]) -> Vec<Unresolved> {
    let why = |resolution: &Resolution| {
        if resolution.at_end {
            Unresolvable::EndOfRange
        } else if resolution.wanted.is_empty() {
            Unresolvable::BesideMissing
        } else {
            Unresolvable::TooCoarse
        }
    };
    let resolutions = resolutions(request, speeds, points).into_iter();
    let unresolved = resolutions.filter(|(_, _, resolution)| !resolution.resolved);
    unresolved
        .map(|(sensor, speed_rad_s, resolution)| Unresolved { sensor, speed_rad_s, reason: why(&resolution) })
        .collect()
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::request::MAX_SPEEDS;
    use crate::resolved::{ResolvedSpeeds, from_json};

    fn speeds(given: Value) -> ResolvedSpeeds {
        ResolvedSpeeds::of(serde_json::from_value(given).unwrap(), 0).unwrap()
    }

    /// Sweep from 900 to 1100 rad/s with two sensors.
    fn request(count: usize) -> ResolvedSweep {
        let sensor = |contact_node: u32| json!({"contact_node": contact_node, "component": "radial"});
        from_json::sweep(json!({
            "model": "m", "speeds": {"from": 900.0, "to": 1100.0, "count": count, "unit": "rad_s"}, "scene": {},
            "sensors": [sensor(0), sensor(1)], "refine": true,
        }))
    }

    /// Points of a sweep whose sensors have these levels; a level that is NaN is a run that failed.
    fn points(request: &ResolvedSweep, levels: &dyn Fn(f64) -> [f64; 2]) -> Vec<Point> {
        let point = |(index, speed): (usize, f64)| {
            let levels = levels(speed);
            let failed = levels.iter().any(|level| level.is_nan());
            let response = |sensor: usize| {
                json!({"sensor": request.sensors[sensor], "mean": 0.0, "rms": levels[sensor], "half_peak_to_peak": 1.0,
                    "dominant_engine_order": 2.0, "dominant_nodal_diameter": 2})
            };
            serde_json::from_value(json!({
                "index": index, "speed_rad_s": speed, "status": if failed { "failed" } else { "completed" },
                "steps_per_revolution": 1, "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0,
                "responses": if failed { Vec::new() } else { vec![response(0), response(1)] },
                "wall_time_s": 0.0, "version": "0",
            }))
            .unwrap()
        };
        request.speeds.rad_s().iter().copied().enumerate().map(point).collect()
    }

    /// Refines the request until nothing is added any more; returns it with the refinement.
    fn refined(mut request: ResolvedSweep, levels: &dyn Fn(f64) -> [f64; 2]) -> (ResolvedSweep, Refinement) {
        loop {
            let found = points(&request, levels);
            let Some(more) = refine(&request, &found, &[]) else {
                return (request.clone(), Refinement::of(&request, &found).unwrap());
            };
            let (before, after) = (request.speeds.rad_s(), more.speeds.rad_s());
            assert_eq!(before, &after[..before.len()], "no speed changes its index");
            assert!(after[before.len()..].windows(2).all(|pair| pair[0] < pair[1]));
            assert!(after[before.len()..].iter().all(|speed| !before.contains(speed)));
            request = more;
        }
    }

    fn resonance(speed: f64, at: f64, half_bandwidth: f64) -> f64 {
        1.0 / (1.0 + ((speed - at) / half_bandwidth).powi(2)).sqrt()
    }

    /// Distance of `speed` to the nearest speed of a request.
    fn nearest(request: &ResolvedSweep, speed: f64) -> f64 {
        let speeds = request.speeds.rad_s().iter();
        speeds.map(|other| (other - speed).abs()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn peaks_of_all_sensors_are_found() {
        let levels = |speed| [resonance(speed, 953.0, 1.0), 7.0 * resonance(speed, 1041.0, 1.5)];
        let (found, refinement) = refined(request(11), &levels);
        assert!(refinement.complete, "{refinement:?}");
        assert!((6..50).contains(&refinement.added) && refinement.rounds >= 3, "{refinement:?}");
        // A tenth of the half-bandwidth off, a resonance is half a per cent lower: nothing is resolved far from its top.
        assert!(nearest(&found, 953.0) < 0.35 && nearest(&found, 1041.0) < 0.5);
        // Fine enough from the start.
        let (_, refinement) = refined(request(500), &levels);
        assert_eq!(refinement, Refinement { added: 0, rounds: 0, complete: true, unresolved: Vec::new() });
    }

    #[test]
    fn a_fold_is_known_to_its_sharpness() {
        let sawtooth = |speed: f64| if speed < 1013.7 { (speed - 900.0) / 113.7 } else { 0.1 };
        let (found, refinement) = refined(request(8), &|speed| [sawtooth(speed), 1.0]);
        assert!(refinement.complete && refinement.added <= 20, "{refinement:?}");
        let speeds = found.speeds.ascending();
        let jump = speeds.partition_point(|&speed| speed < 1013.7);
        assert!(speeds[jump] - speeds[jump - 1] <= 5e-4 * 1013.7);
    }

    #[test]
    fn the_ends_of_the_range_are_left_alone_and_failures_are_approached() {
        let (_, refinement) = refined(request(5), &|speed| [speed, 2000.0 - speed]);
        let at_end = |sensor, speed_rad_s| Unresolved {
            sensor: Some(sensor),
            speed_rad_s,
            reason: Unresolvable::EndOfRange,
        };
        let unresolved = vec![at_end(0, 1100.0), at_end(1, 900.0)];
        assert_eq!(refinement, Refinement { added: 0, rounds: 0, complete: false, unresolved });
        // The response grows until runs fail.
        let levels = |speed: f64| [if speed < 1033.3 { 1.0 / (1034.0 - speed) } else { f64::NAN }, 1.0];
        let (found, refinement) = refined(request(5), &levels);
        let reasons: Vec<_> = refinement.unresolved.iter().map(|peak| (peak.sensor, peak.reason)).collect();
        assert_eq!(reasons, [(Some(0), Unresolvable::BesideMissing)], "{refinement:?}");
        assert!(!refinement.complete);
        let speeds = found.speeds.ascending();
        let first = speeds.partition_point(|&speed| speed < 1033.3);
        assert!(speeds[first] - speeds[first - 1] <= 5e-4 * 1033.3);
    }

    #[test]
    fn a_rough_curve_ends_at_the_most_that_may_be_added() {
        let rough = |speed: f64| {
            let bits = speed.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15);
            [(bits >> 40) as f64 / f64::from(1 << 24), 1.0]
        };
        for (count, added) in [(6, 50), (80, 80)] {
            let (found, refinement) = refined(request(count), &rough);
            assert_eq!((refinement.added, refinement.complete), (added, false));
            assert!(refinement.unresolved.iter().any(|peak| peak.reason == Unresolvable::TooCoarse));
            assert_eq!(found.speeds.rad_s().len(), count + added as usize);
        }
        let range = json!({"from": 1.0, "to": 1e6, "count": MAX_SPEEDS - 3, "unit": "rad_s"});
        let many = ResolvedSweep { speeds: speeds(range), ..request(2) };
        let (found, _) = refined(many, &rough);
        assert_eq!(found.speeds.rad_s().len(), MAX_SPEEDS);
    }

    #[test]
    fn operating_ranges_go_first() {
        let rough = |speed: f64| {
            let bits = speed.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15);
            [(bits >> 40) as f64 / f64::from(1 << 24), 1.0]
        };
        let range = json!({"ranges": [{"name": "r", "from": 1000.0, "to": 1020.0, "unit": "rad_s"}]});
        let mut asked = request(6);
        asked.operation = serde_json::from_value(range).unwrap();
        let inside = |request: &ResolvedSweep| {
            let added = &request.speeds.rad_s()[6..];
            added.iter().filter(|speed| (1000.0..=1020.0).contains(*speed)).count()
        };
        let (within, without) = (refined(asked, &rough).0, refined(request(6), &rough).0);
        assert!(inside(&within) > inside(&without), "{} {}", inside(&within), inside(&without));
    }

    #[test]
    fn numbers_without_a_middle_end_it() {
        let least = f64::from_bits(1);
        let given = json!({"values": [least, 2.0 * least, 3.0 * least], "unit": "rad_s"});
        let tiny = ResolvedSweep { speeds: speeds(given), ..request(2) };
        let (_, refinement) = refined(tiny, &|speed| [if speed == 2.0 * least { 1.0 } else { 0.1 }, 1.0]);
        assert_eq!((refinement.added, refinement.rounds, refinement.complete), (0, 0, false));
        assert_eq!(refinement.unresolved[0].reason, Unresolvable::TooCoarse);
    }

    #[test]
    fn peaks_below_the_prominence_asked_for_are_left_alone() {
        let levels = |speed| [resonance(speed, 953.0, 1.0) + 0.05 * resonance(speed, 1041.0, 3.0), 1.0];
        let (most, _) = refined(request(81), &levels);
        assert!(nearest(&most, 1041.0) > 0.5, "5 % of the largest is below the default");
        let (all, _) = refined(ResolvedSweep { peak_prominence: 0.02, ..request(81) }, &levels);
        assert!(nearest(&all, 1041.0) < 0.5);
    }

    #[test]
    fn the_order_of_the_points_and_a_repetition_make_no_difference() {
        let request = request(11);
        let levels = |speed| [resonance(speed, 953.0, 1.0), resonance(speed, 1041.0, 1.5)];
        let mut found = points(&request, &levels);
        let more = refine(&request, &found, &[]).unwrap();
        found.reverse();
        assert_eq!(refine(&request, &found, &[]).unwrap(), more);
        // A refined request that is asked for again is refined no further.
        let (last, refinement) = refined(request, &levels);
        assert_eq!(refined(last.clone(), &levels), (last, refinement));
        assert_eq!(refine(&ResolvedSweep { refine: false, ..more }, &[], &[]), None);
    }
}
