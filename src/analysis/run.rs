//! The verbs.

use std::f64::consts::TAU;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::discretisation::least_steps_for_lobes;
use super::error::{AnalysisError, Violation};
use super::monitor::Monitor;
use super::request::{ModalAnalysisRequest, Sensor, StepsPerRevolution, SweepRequest};
use super::result::{
    AbsoluteFrequencies, Campbell, CriticalSpeed, CriticalSpeeds, Crossing, DrivenCrossing, InteractionMap,
    Point, PointStatus, ReductionReport, SpeedSpectra, StiffeningReport, StiffeningVerdict,
};
use crate::dynamics::error::ModelError;
use crate::dynamics::integrate::smallest_stable_steps;
use crate::dynamics::modal_wheel::natural_frequencies;
use crate::dynamics::reduction::{
    InterpolationCheck, InterpolationVerdict, ReducedWheel, ReductionError, ReductionOptions, reduce,
};
use crate::dynamics::sector::{SectorModel, Units};
use crate::numerics::sector_fourier::{harmonic_count, is_single};
use crate::response::campbell::{
    Frequencies, absolute_frequency, crossings as linear_crossings, driven_crossings,
};
use crate::response::critical_speed::peaks;
use crate::response::spectra::engine_orders;

pub use super::resolve::{resolve_modal_analysis, resolve_sweep};
pub use super::speed::run_speed;

/// Version of the code, stamped on every result.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A reduced sector: all that simulations need of a model. Computed once per (model, `modes_per_speed`) and stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedSector {
    /// Units of the model.
    pub units: Units,
    /// The reduced wheel.
    pub wheel: ReducedWheel,
    /// What the reduction found and cost.
    pub report: ReductionReport,
}

/// The few facts about a model that requests are checked against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
pub struct ModelFacts {
    /// Free text of the user.
    pub name: String,
    /// Number of sectors N.
    pub sectors: u32,
    /// Number of contact nodes.
    pub contact_nodes: u32,
    /// Own DOF of a sector (internal with the low face, and contact).
    pub own_dofs: u32,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Units.
    pub units: Units,
}

impl ModelFacts {
    /// The facts of `sector`.
    pub fn of(sector: &SectorModel) -> Self {
        Self {
            name: sector.name.clone(),
            sectors: sector.sectors as u32,
            contact_nodes: sector.contact.len() as u32,
            own_dofs: sector.own_dofs() as u32,
            speeds_rad_s: sector.speeds_rad_s.clone(),
            units: sector.units.clone(),
        }
    }

    /// Whether the model has stiffness at three speeds.
    pub fn has_stiffening(&self) -> bool {
        self.speeds_rad_s.len() == 3
    }
}

/// Reduces a sector (METHOD §2–§4). Deterministic; runs on the calling thread.
pub fn prepare(
    sector: &SectorModel,
    modes_per_speed: u32,
    monitor: &dyn Monitor,
) -> Result<ReducedSector, AnalysisError> {
    let start = Instant::now();
    let options = ReductionOptions::new(modes_per_speed as usize);
    let watch = |fraction: f64, phase: &str| {
        monitor.progress(fraction, phase);
        !monitor.is_cancelled()
    };
    let wheel = reduce(sector, &options, &watch).map_err(|error| match error {
        ReductionError::Cancelled => AnalysisError::Cancelled,
        ReductionError::Model(error) => error.into(),
    })?;
    let report = report(&wheel, &options, sector, start.elapsed().as_secs_f64());
    Ok(ReducedSector { units: sector.units.clone(), wheel, report })
}

fn report(
    wheel: &ReducedWheel,
    options: &ReductionOptions,
    sector: &SectorModel,
    wall_time_s: f64,
) -> ReductionReport {
    let size = |i: usize| wheel.harmonics[i].mass.nrows() as u32;
    let copies = |i: usize| if is_single(i, wheel.sectors) { 1 } else { 2 };
    let residual = wheel.harmonics.iter().fold(0.0f64, |m, h| m.max(h.largest_mode_residual));
    ReductionReport {
        modes_per_speed: options.modes_per_speed as u32,
        unknowns: (0..wheel.harmonics.len()).map(size).collect(),
        wheel_unknowns: (0..wheel.harmonics.len()).map(|i| copies(i) * size(i)).sum(),
        largest_mode_residual: residual,
        basis_tolerance: options.basis_tolerance,
        stiffening: stiffening_report(&wheel.interpolation, sector),
        wall_time_s,
        version: VERSION.to_owned(),
    }
}

fn stiffening_report(check: &InterpolationCheck, sector: &SectorModel) -> StiffeningReport {
    let InterpolationCheck { verdict, linear_ratio, quadratic_ratio, frequency_error } = *check;
    let highest = sector.speeds_rad_s.last().copied().unwrap_or(0.0);
    let percent = 100.0 * frequency_error;
    let advice = "Export K(Ω) = K_e + K_σ(Ω) − Ω²M_spin on the undeformed geometry instead (linear static \
                  pre-stress, no geometrically non-linear step).";
    let (verdict, message) = match verdict {
        InterpolationVerdict::Absent => (
            StiffeningVerdict::Absent,
            "One stiffness matrix: the model has no centrifugal stiffening.".into(),
        ),
        InterpolationVerdict::Sound => (
            StiffeningVerdict::Sound,
            format!(
                "K(Ω) is linear in Ω² up to {highest} rad/s, as it must be on the undeformed geometry \
                 (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e})."
            ),
        ),
        InterpolationVerdict::Suspect => (
            StiffeningVerdict::Suspect,
            format!(
                "K(Ω) is not linear in Ω² (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}, |Ω1²K1|/|K0| = \
                 {linear_ratio:.1e}): it was probably exported on the deformed geometry of a non-linear pre-stress \
                 step. Results are right at the given speeds; between them the lowest frequencies deviate by an \
                 estimated {percent:.2} %. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound if frequency_error.is_finite() => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) cannot be interpolated: between the given speeds the lowest frequencies deviate by {percent:.1} \
                 % from a smooth curve (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}). The matrices were probably exported on \
                 the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) interpolated between the given speeds is not positive definite (|Ω1⁴K2|/|K0| = \
                 {quadratic_ratio:.1e}); speeds at which this is so are refused. The matrices were probably exported \
                 on the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
    };
    // JSON has no infinity; an indefinite K is an error of at least 100 %.
    let frequency_error = frequency_error.min(1.0);
    StiffeningReport { verdict, linear_ratio, quadratic_ratio, frequency_error, message }
}

/// Checks what only the reduced sector can tell, before any speed runs: a fixed step against the stability limit at
/// every speed of the sweep, and against the width of the lobes. Speeds at which the model itself fails are left to their own run.
pub fn check(
    reduced: &ReducedSector,
    request: &SweepRequest,
    monitor: &dyn Monitor,
) -> Result<(), AnalysisError> {
    let StepsPerRevolution::Fixed(steps) = request.integration.steps_per_revolution else { return Ok(()) };
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let mut worst = (0, 0.0);
    for (index, &speed) in speeds.iter().enumerate() {
        monitor.progress(index as f64 / speeds.len() as f64, "stability limit of the time step");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let frequencies = reduced
            .wheel
            .harmonics
            .iter()
            .map(|h| natural_frequencies(h, speed, request.scene.centrifugal_stiffening))
            .collect::<Result<Vec<_>, ModelError>>();
        let Ok(frequencies) = frequencies else { continue };
        let largest = frequencies.iter().filter_map(|f| f.last()).fold(0.0f64, |m, &f| m.max(f));
        let smallest_steps = smallest_stable_steps(largest, speed);
        if smallest_steps > worst.0 {
            worst = (smallest_steps, speed);
        }
    }
    let (stable, speed) = worst;
    let seen = least_steps_for_lobes(request) as u64;
    let smallest = stable.max(seen);
    if u64::from(steps) >= smallest {
        return Ok(());
    }
    let reason = if stable >= seen {
        format!(
            "are unstable: central differences need h < 2/ω_max of the reduced wheel, which at {speed:.6} rad/s is met \
             from {stable} steps per revolution on"
        )
    } else {
        format!("pass the lobes by, which are seen from {seen} steps per revolution on")
    };
    Err(AnalysisError::Refused(vec![Violation::new(
        "/integration/steps_per_revolution",
        format!("{steps} steps per revolution {reason}; give at least {smallest}, or \"auto\""),
    )]))
}

/// The reduced wheel as a source of frequencies in Hz.
struct WheelFrequencies<'a> {
    wheel: &'a ReducedWheel,
    stiffening: bool,
}

impl Frequencies for WheelFrequencies<'_> {
    fn at(&self, speed_rad_s: f64, nodal_diameter: u32) -> Option<Vec<f64>> {
        self.hertz(speed_rad_s, nodal_diameter).ok()
    }
}

impl WheelFrequencies<'_> {
    fn hertz(&self, speed_rad_s: f64, nodal_diameter: u32) -> Result<Vec<f64>, ModelError> {
        let harmonic = &self.wheel.harmonics[nodal_diameter as usize];
        let omega = natural_frequencies(harmonic, speed_rad_s, self.stiffening)?;
        Ok(omega.into_iter().map(|w| w / TAU).collect())
    }

    /// `[nodal diameter][family]` in Hz at one speed, the first `families`.
    fn row(&self, speed: f64, families: usize) -> Result<Vec<Vec<f64>>, ModelError> {
        let of = |i: u32| {
            let mut frequencies = self.hertz(speed, i)?;
            frequencies.truncate(families);
            Ok(frequencies)
        };
        (0..harmonic_count(self.wheel.sectors) as u32).map(of).collect()
    }

    /// The same at every speed, `[speed][nodal diameter][family]`.
    fn table(
        &self,
        speeds: &[f64],
        families: usize,
        monitor: &dyn Monitor,
    ) -> Result<Vec<Vec<Vec<f64>>>, AnalysisError> {
        let mut table = Vec::with_capacity(speeds.len());
        for (index, &speed) in speeds.iter().enumerate() {
            monitor.progress(index as f64 / speeds.len() as f64, "natural frequencies");
            if monitor.is_cancelled() {
                return Err(AnalysisError::Cancelled);
            }
            table.push(self.row(speed, families)?);
        }
        Ok(table)
    }
}

/// Natural frequencies over speed and the linear criterion.
pub fn modal_analysis(
    reduced: &ReducedSector,
    request: &ModalAnalysisRequest,
    monitor: &dyn Monitor,
) -> Result<Campbell, AnalysisError> {
    let start = Instant::now();
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let families = request.families as usize;
    let source = WheelFrequencies { wheel: &reduced.wheel, stiffening: true };
    let table = source.table(&speeds, families, monitor)?;
    let absolute = |n: u32| {
        let at = |(row, &speed): (&Vec<Vec<f64>>, &f64)| {
            let of = |(i, line): (usize, &Vec<f64>)| {
                line.iter().map(|&f| absolute_frequency(f, i as u32, n, speed)).collect()
            };
            row.iter().enumerate().map(of).collect()
        };
        let frequencies_hz = table.iter().zip(&speeds).map(at).collect();
        AbsoluteFrequencies { superharmonic: n, frequencies_hz }
    };
    Ok(Campbell {
        absolute_frequencies_hz: request.superharmonics.iter().map(|&n| absolute(n)).collect(),
        crossings: linear_crossings(&source, &table, &speeds, families, &request.superharmonics),
        driven_crossings: driven_crossings(
            &source,
            &table,
            &speeds,
            families,
            request.lobes,
            request.max_engine_order,
            reduced.wheel.sectors as u32,
        ),
        frequencies_hz: table,
        speeds_rad_s: speeds,
        reduction: reduced.report.clone(),
        settings: request.clone(),
        wall_time_s: start.elapsed().as_secs_f64(),
        version: VERSION.to_owned(),
    })
}

/// The row that one speed contributes to the map of `sensor` (index into the request's sensors).
pub fn map_row(spectra: &SpeedSpectra, sensor: usize, nodal_diameter: Option<u32>) -> Option<&[f64]> {
    let spectrum = spectra.sensors.get(sensor)?;
    match nodal_diameter {
        None => Some(&spectrum.amplitude),
        Some(i) => spectrum.nodal_diameters.get(i as usize).map(Vec::as_slice),
    }
}

/// The interaction map of `sensor` from the speeds finished so far, in any order, each with its [`map_row`].
pub fn interaction_map(
    request: &SweepRequest,
    units: &Units,
    finished: Vec<(Point, Option<Vec<f64>>)>,
    sensor: usize,
    nodal_diameter: Option<u32>,
) -> InteractionMap {
    let speeds = request.speeds.resolve().unwrap_or_default();
    let mut amplitude = vec![None; speeds.len()];
    let mut points = Vec::with_capacity(finished.len());
    for (point, row) in finished {
        amplitude[point.index as usize] = row;
        points.push(point);
    }
    points.sort_by_key(|point| point.index);
    InteractionMap {
        speeds_rad_s: speeds,
        engine_orders: engine_orders(request.integration.window_revolutions, request.max_engine_order),
        amplitude,
        sensor: request.sensors[sensor],
        nodal_diameter,
        units: units.clone(),
        points,
        settings: request.clone(),
        version: VERSION.to_owned(),
    }
}

/// Families and superharmonic numbers of the linear prediction beside a sweep: those the paper looks at.
const PREDICTED_FAMILIES: usize = 2;
const PREDICTED_SUPERHARMONICS: [u32; 3] = [1, 2, 3];

/// Peaks of the response that rise above their surroundings by less than this share of the largest are left out.
const PROMINENT: f64 = 0.1;

/// Critical speeds of a sweep, one table per sensor, beside the linear prediction; from the points of all speeds.
pub fn critical_speeds(
    reduced: &ReducedSector,
    request: &SweepRequest,
    points: &[Point],
    monitor: &dyn Monitor,
) -> Result<Vec<CriticalSpeeds>, AnalysisError> {
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let mut ascending: Vec<usize> = (0..speeds.len()).collect();
    ascending.sort_by(|&a, &b| speeds[a].total_cmp(&speeds[b]));
    let mut completed = vec![None; speeds.len()];
    for point in points.iter().filter(|point| point.status == PointStatus::Completed) {
        completed[point.index as usize] = Some(point);
    }
    let prediction = predict(reduced, request, ascending.iter().map(|&index| speeds[index]), monitor)?;
    let ordered: Vec<Option<&Point>> = ascending.iter().map(|&index| completed[index]).collect();
    let missing: Vec<u32> =
        (0..).zip(&completed).filter(|(_, point)| point.is_none()).map(|(i, _)| i).collect();
    let table = |(sensor, &of): (usize, &Sensor)| CriticalSpeeds {
        sensor: of,
        critical_speeds: response_peaks(&ordered, sensor, &prediction.0),
        linear_crossings: prediction.0.clone(),
        driven_crossings: prediction.1.clone(),
        missing: missing.clone(),
        units: reduced.units.clone(),
        reduction: reduced.report.clone(),
        version: VERSION.to_owned(),
    };
    Ok(request.sensors.iter().enumerate().map(table).collect())
}

/// Prominent peaks of one sensor's level over ascending speeds, each with the nearest linear crossing.
fn response_peaks(ordered: &[Option<&Point>], sensor: usize, linear: &[Crossing]) -> Vec<CriticalSpeed> {
    let level = |point: &&Point| point.responses[sensor].rms;
    let curve: Vec<Option<f64>> = ordered.iter().map(|point| point.as_ref().map(level)).collect();
    let critical = peaks(&curve, PROMINENT).into_iter().filter_map(|peak| {
        let point = ordered[peak.index]?;
        let response = &point.responses[sensor];
        let distance = |crossing: &&Crossing| (crossing.speed_rad_s - point.speed_rad_s).abs();
        let nearest = linear.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).cloned();
        Some(CriticalSpeed {
            speed_rad_s: point.speed_rad_s,
            index: point.index,
            at_edge: peak.at_edge,
            rms: response.rms,
            half_peak_to_peak: response.half_peak_to_peak,
            prominence: peak.prominence,
            dominant_engine_order: response.dominant_engine_order,
            dominant_nodal_diameter: response.dominant_nodal_diameter,
            settling: point.settling.as_ref()?.verdict,
            distance_rad_s: nearest.as_ref().map(|crossing| point.speed_rad_s - crossing.speed_rad_s),
            nearest_crossing: nearest,
        })
    });
    critical.collect()
}

/// Linear and driven crossings over the range of a sweep.
fn predict(
    reduced: &ReducedSector,
    request: &SweepRequest,
    ascending: impl Iterator<Item = f64>,
    monitor: &dyn Monitor,
) -> Result<(Vec<Crossing>, Vec<DrivenCrossing>), AnalysisError> {
    let source = WheelFrequencies { wheel: &reduced.wheel, stiffening: request.scene.centrifugal_stiffening };
    // Repeated speeds would bracket nothing; speeds at which the model fails predict nothing.
    let mut speeds: Vec<f64> = ascending.collect();
    speeds.dedup();
    let (mut grid, mut table) = (Vec::new(), Vec::new());
    for (done, &speed) in speeds.iter().enumerate() {
        monitor.progress(done as f64 / speeds.len() as f64, "linear prediction");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        if let Ok(row) = source.row(speed, PREDICTED_FAMILIES) {
            grid.push(speed);
            table.push(row);
        }
    }
    let linear = linear_crossings(&source, &table, &grid, PREDICTED_FAMILIES, &PREDICTED_SUPERHARMONICS);
    let lobes = request.scene.casing.as_ref().and_then(|casing| casing.lobes.as_ref()).map_or(0, |l| l.count);
    let sectors = reduced.wheel.sectors as u32;
    let driven = driven_crossings(
        &source,
        &table,
        &grid,
        PREDICTED_FAMILIES,
        lobes,
        request.max_engine_order,
        sectors,
    );
    Ok((linear, driven))
}
