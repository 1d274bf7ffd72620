//! Results of all speeds of a sweep: the interaction map and the critical speeds.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use crate::diagram::FrequencyDiagram;
use crate::effects::flexible_casing::convert::flexible_casing;
use crate::error::AnalysisError;
use crate::families::Families;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::resolved::{ResolvedSensor, ResolvedSweep};
use crate::response_curve::ResponseCurve;
use crate::result::{
    Coincidence, CriticalSpeed, CriticalSpeeds, Crossing, DrivenCrossing, ErrorEstimate, InteractionMap,
    Point, PointStatus, ReductionReport, Refinement, SpeedSpectra, Spent,
};
use crate::wheel::rotation;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::campbell::multiples;
use rubmap_wheel::response::critical_speed::{Resolution, peaks};
use rubmap_wheel::response::spectra::engine_orders;
use rubmap_wheel::revision::VERSION;

/// Row that one speed contributes to the map of `sensor` (index into the request's sensors).
pub fn map_row(spectra: &SpeedSpectra, sensor: usize, nodal_diameter: Option<u32>) -> Option<&[f64]> {
    let spectrum = spectra.sensors.get(sensor)?;
    match nodal_diameter {
        None => Some(&spectrum.amplitude),
        Some(i) => spectrum.nodal_diameters.get(i as usize).map(Vec::as_slice),
    }
}

/// Engine orders of the columns of a sweep's maps.
pub fn map_engine_orders(request: &ResolvedSweep) -> Vec<f64> {
    engine_orders(request.integration.window_revolutions, request.max_engine_order)
}

/// Multiples of the rotational frequency at which the fixed frame sees the lines of a sweep's maps, 0 among them, for a wheel with this
/// number of nodal diameters.
pub fn fixed_frame_orders(request: &ResolvedSweep, nodal_diameters: usize) -> Vec<f64> {
    let highest = request.max_engine_order + nodal_diameters.saturating_sub(1) as u32;
    engine_orders(request.integration.window_revolutions, highest)
}

/// Row that one speed contributes to the map of `sensor` in the fixed frame, over [`fixed_frame_orders`].
///
/// A wave of nodal diameter n at engine order k of the rotating frame is seen at k + n if it travels with the rotation, at |k − n| if
/// against it (Eq. 11); amplitudes do not tell which, so that it counts at both. Of several lines at one order the largest counts, of the
/// wheel's components in all nodal diameters or in one.
pub fn fixed_frame_row(
    spectra: &SpeedSpectra,
    sensor: usize,
    nodal_diameter: Option<u32>,
    window_revolutions: u32,
) -> Option<Vec<f64>> {
    let rows = &spectra.sensors.get(sensor)?.nodal_diameters;
    let away = |n: usize| n * window_revolutions as usize;
    let mut seen = vec![0.0; spectra.engine_orders.len() + away(rows.len().saturating_sub(1))];
    for (n, row) in rows.iter().enumerate() {
        if nodal_diameter.is_some_and(|only| only as usize != n) {
            continue;
        }
        // The mean is no vibration.
        for (bin, &amplitude) in row.iter().enumerate().skip(1) {
            for place in [bin + away(n), bin.abs_diff(away(n))] {
                seen[place] = f64::max(seen[place], amplitude);
            }
        }
    }
    Some(seen)
}

/// Interaction map of `sensor` from the speeds finished so far, in any order, each with its [`map_row`]; the caller adds the plan.
pub fn interaction_map(
    request: &ResolvedSweep,
    units: &Units,
    finished: Vec<(Point, Option<Vec<f64>>)>,
    sensor: usize,
    nodal_diameter: Option<u32>,
) -> InteractionMap {
    let speeds = request.speeds.rad_s();
    let mut amplitude = vec![None; speeds.len()];
    let mut points = Vec::with_capacity(finished.len());
    for (point, row) in finished {
        // Speeds that a refinement has added since the request was read wait for the next reader.
        if let Some(place) = amplitude.get_mut(point.index as usize) {
            *place = row;
            points.push(point);
        }
    }
    points.sort_by_key(|point| point.index);
    InteractionMap {
        speeds_rad_s: speeds.to_vec(),
        engine_orders: map_engine_orders(request),
        amplitude,
        sensor: request.sensors[sensor].into(),
        nodal_diameter,
        units: units.clone(),
        refinement: Refinement::of(request, &points),
        plan: None,
        spent: Spent::on(&points),
        stiffening: points.iter().filter_map(|point| point.stiffening).max(),
        points,
        errors: None,
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    }
}

/// Summary in words of how all speeds ended, if none of them was completed.
pub fn nothing_completed(points: &[Point]) -> Option<String> {
    if points.iter().any(|point| point.status == PointStatus::Completed) {
        return None;
    }
    let diverged = points.iter().filter(|point| point.status == PointStatus::Diverged).count();
    let first = points.iter().min_by_key(|point| point.index)?;
    Some(format!(
        "none of the {} speeds was completed: {diverged} diverged, {} could not be integrated; at {:.6} rad/s {}; the results so far \
         say it of every speed",
        points.len(),
        points.len() - diverged,
        first.speed_rad_s,
        first.message.as_deref().unwrap_or("no reason is known")
    ))
}

/// Number of families of the linear prediction beside a sweep, and its superharmonics: those of the paper.
const PREDICTED_FAMILIES: usize = 2;
const PREDICTED_SUPERHARMONICS: [u32; 3] = [1, 2, 3];

/// Critical speeds of a sweep, one table per sensor, beside the linear prediction; from the points of all speeds and their `errors` if they
/// were estimated. The caller adds the plan.
pub fn critical_speeds(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    points: &[Point],
    errors: Option<&ErrorEstimate>,
    monitor: &dyn Monitor,
) -> Result<Vec<CriticalSpeeds>, AnalysisError> {
    let speeds = request.speeds.rad_s();
    let curve = ResponseCurve::of(speeds, points);
    let prediction = predict(reduced, request, &curve.speeds_rad_s, monitor)?;
    let completed: BTreeSet<u32> = curve.points.iter().flatten().map(|point| point.index).collect();
    let missing: Vec<u32> = (0..speeds.len() as u32).filter(|index| !completed.contains(index)).collect();
    let refinement = Refinement::of(request, points);
    let table = |(sensor, &of): (usize, &ResolvedSensor)| CriticalSpeeds {
        sensor: of.into(),
        critical_speeds: response_peaks(request, &curve, sensor, &prediction.linear, errors, &reduced.report),
        linear_crossings: prediction.linear.clone(),
        driven_crossings: prediction.driven.clone(),
        casing_coincidences: prediction.coincidences.clone(),
        missing: missing.clone(),
        refinement: refinement.clone(),
        plan: None,
        spent: Spent::on(points),
        units: reduced.units.clone(),
        settings: request.clone().into(),
        reduction: reduced.report.clone(),
        version: VERSION.to_owned(),
    };
    Ok(request.sensors.iter().enumerate().map(table).collect())
}

/// Indices of the critical speeds of all sensors, from the points of all speeds.
pub fn critical_indices(request: &ResolvedSweep, points: &[Point]) -> BTreeSet<u32> {
    let curve = ResponseCurve::of(request.speeds.rad_s(), points);
    let of = |sensor: usize| peaks(&curve.level(sensor), request.peak_prominence);
    let peaks = (0..request.sensors.len()).flat_map(of);
    peaks.filter_map(|peak| Some(curve.points[peak.index]?.index)).collect()
}

/// Prominent peaks of one sensor's level over ascending speeds, each with the nearest linear crossing.
fn response_peaks(
    request: &ResolvedSweep,
    curve: &ResponseCurve,
    sensor: usize,
    linear: &[Crossing],
    errors: Option<&ErrorEstimate>,
    reduction: &ReductionReport,
) -> Vec<CriticalSpeed> {
    let level = curve.level(sensor);
    let critical = peaks(&level, request.peak_prominence).into_iter().filter_map(|peak| {
        let point = curve.points[peak.index]?;
        let resolution = Resolution::of(curve.of_values(&level), &peak);
        let response = &point.responses[sensor];
        let distance = |crossing: &&Crossing| (crossing.speed_rad_s - point.speed_rad_s).abs();
        let nearest = linear.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).cloned();
        Some(CriticalSpeed {
            speed_rad_s: point.speed_rad_s,
            index: point.index,
            at_edge: peak.at_edge,
            speed_error_rad_s: resolution.error,
            resolved: resolution.resolved,
            on_branch: resolution.on_branch,
            rms: response.rms,
            half_peak_to_peak: response.half_peak_to_peak,
            prominence: peak.prominence,
            frequency_error_rad_s: reduction.largest_difference() * point.speed_rad_s,
            amplitude_error: errors.and_then(|errors| errors.of(point.index)),
            dominant_engine_order: response.dominant_engine_order,
            dominant_nodal_diameter: response.dominant_nodal_diameter,
            settling: point.settling.as_ref()?.verdict,
            distance_rad_s: nearest.as_ref().map(|crossing| point.speed_rad_s - crossing.speed_rad_s),
            nearest_crossing: nearest,
            utilisation: point.utilisation(),
            validity: point.validity_verdict(),
            validity_lacking: point.validity_lacking(),
        })
    });
    critical.collect()
}

/// Number of speeds over the range of a sweep between which linear critical speeds are sought while it is refined.
const SOUGHT: u32 = 12;

/// Linear critical speeds in the range of a sweep that its scene can drive, by the lowest ranks of frequencies.
///
/// # Errors
/// Cancellation.
pub fn driven_crossings(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    monitor: &dyn Monitor,
) -> Result<Vec<DrivenCrossing>, AnalysisError> {
    let ascending = request.speeds.ascending();
    let (Some(&from), Some(&to)) = (ascending.first(), ascending.last()) else { return Ok(Vec::new()) };
    let speed = |place: u32| from + (to - from) * f64::from(place) / f64::from(SOUGHT);
    let speeds: Vec<f64> = (0..=SOUGHT).map(speed).collect();
    let diagram = diagram(reduced, request, &speeds, monitor)?;
    let families = Families::by_rank(&reduced.wheel, rotation(&request.scene));
    Ok(diagram.driven_crossings(&families, &driving_orders(request)))
}

/// Natural frequencies over `speeds`. A speed at which the model fails predicts nothing.
fn diagram<'a>(
    reduced: &'a ReducedSector,
    request: &ResolvedSweep,
    speeds: &[f64],
    monitor: &dyn Monitor,
) -> Result<FrequencyDiagram<'a>, AnalysisError> {
    let mut diagram = FrequencyDiagram::new(&reduced.wheel, rotation(&request.scene), PREDICTED_FAMILIES);
    for (done, &speed) in speeds.iter().enumerate() {
        monitor.progress(done as f64 / speeds.len() as f64, "linear prediction");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let _ = diagram.push(speed);
    }
    Ok(diagram)
}

/// Engine orders that a scene can drive: multiples of the lobe count, and those of its forces.
fn driving_orders(request: &ResolvedSweep) -> Vec<u32> {
    let scene = &request.scene;
    let lobes = scene.casing.as_ref().and_then(|casing| casing.shape.repeats()).unwrap_or(0);
    let mut orders = multiples(lobes, request.max_engine_order);
    orders.extend(scene.engine_order_excitation.iter().map(|force| force.order));
    orders.sort_unstable();
    orders.dedup();
    orders
}

/// Prediction of linear theory over the range of a sweep.
struct Prediction {
    linear: Vec<Crossing>,
    driven: Vec<DrivenCrossing>,
    coincidences: Vec<Coincidence>,
}

/// Crossings and coincidences over the range of a sweep.
fn predict(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    ascending: &[f64],
    monitor: &dyn Monitor,
) -> Result<Prediction, AnalysisError> {
    let scene = &request.scene;
    let effects = rotation(scene);
    // Repeated speeds would bracket nothing.
    let mut speeds = ascending.to_vec();
    speeds.dedup();
    let diagram = diagram(reduced, request, &speeds, monitor)?;
    let casing = scene.flexible_casing.as_ref().map(|casing| {
        flexible_casing(casing).waves.iter().map(|wave| (wave.nodal_diameter, wave.omega / TAU)).collect()
    });
    let casing: Vec<(u32, f64)> = casing.unwrap_or_default();
    let top = speeds.last().copied().unwrap_or(0.0);
    let families = Families::followed(&reduced.wheel, effects, &[], top, monitor)?;
    Ok(Prediction {
        linear: diagram.crossings(&families, &PREDICTED_SUPERHARMONICS),
        driven: diagram.driven_crossings(&families, &driving_orders(request)),
        coincidences: diagram.coincidences(&families, &casing),
    })
}
