//! Plans of jobs: work and cost, before they run.

use std::borrow::Cow;
use std::time::Instant;

use crate::accuracy::rung::pilot_speeds;
use crate::calibration::Calibration;
use crate::calibration::effects::EffectSizes;
use crate::calibration::size::StepSize;
use crate::diagram::FrequencyDiagram;
use crate::effects::casing::convert::{clearance_given, running_clearance};
use crate::effects::symmetry::repeats::repeats;
use crate::effects::symmetry::request::Symmetry;
use crate::effects::table::planned;
use crate::kinds::modal_analysis::backbones::curve_seconds;
use crate::measured;
use crate::model::{ModelFacts, ReducedSector};
use crate::nonlinear::{bending_seconds, with_bending_cost};
use crate::refine::most_added;
use crate::request::{FamiliesBy, HistorySpeeds, Recorded, SweepDirection};
use crate::resolve::recorded::{lines, revolutions};
use crate::resolved::{ResolvedCaseStudy, ResolvedModalAnalysis, ResolvedSweep, Scene, TrialRequest};
use crate::result::{
    CostRange, Estimate, FoundShape, FoundSymmetry, ModalAnalysisPlan, PlannedPoint, ReductionState,
    SweepPlan,
};
use crate::speed_scene::SpeedScene;
use crate::steady::{self, revolutions_taken};
use crate::stepping::Stepping;
use crate::verdict::coverage_warnings;
use rubmap_numerics::sector_fourier::harmonic_count;
use rubmap_wheel::dynamics::casing::{Casing, RestrictionTable};
use rubmap_wheel::dynamics::families::{FamilyWalk, grid};
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap_wheel::revision::VERSION;

/// Plans a resolved sweep on `workers` threads; without `reduced`, as far as the facts allow. The caller adds the choice, the positions of
/// the sensors and the measured machine.
pub(crate) fn plan_sweep(
    request: &ResolvedSweep,
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    calibration: &Calibration,
    workers: usize,
) -> SweepPlan {
    let speeds = request.speeds.rad_s();
    let places = stress_places(facts, request);
    // One speed after the other.
    let workers = if request.sweep == SweepDirection::Independent { workers } else { 1 };
    let points: Vec<PlannedPoint> = match reduced {
        Some(reduced) => representatives(speeds, &reduced.report.unknowns)
            .into_iter()
            .map(|index| plan_point(reduced, request, calibration, (index, speeds[index]), places))
            .collect(),
        None => Vec::new(),
    };
    SweepPlan {
        effects: planned(&request.scene),
        symmetry: FoundSymmetry::of(&request.scene, facts.sectors),
        casing_shape: request.scene.casing.as_ref().and_then(|casing| FoundShape::of(&casing.shape)),
        contact_pairs: contact_pairs(&request.scene, facts),
        reduction: state(reduced),
        reduced_unknowns_at_most: reduced_unknowns(facts, reduced, request.modes_per_speed()),
        basis_bytes_at_most: basis_bytes(facts, reduced, request.modes_per_speed(), request.fields()),
        stress_bytes: request
            .stress_outside()
            .map(|_| stress_bytes(facts, reduced, request.modes_per_speed(), places)),
        placed_sensors: Vec::new(),
        speeds: speeds.len() as u32,
        added_speeds_at_most: request.refine.then(|| most_added(request.speeds.asked()) as u32),
        validity_speeds_at_most: measured::most(request, facts),
        workers: workers as u32,
        machine: None,
        estimate: reduced.and_then(|reduced| {
            let all = estimate(&points, speeds, workers, reduced_bytes(reduced))?;
            let all = with_bending_cost(all, request, facts);
            let recorded = recorded_speeds(request);
            if recorded.is_empty() {
                return Some(all);
            }
            Some(all.followed_by(estimate(&points, &recorded, workers, 0)?))
        }),
        points,
        choice: None,
        warnings: [warnings(&request.scene, facts, reduced), coverage_warnings(request)].concat(),
        pilot_speeds_rad_s: request.is_sought().then(|| pilot_speeds(request)),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    }
}

/// Speeds that are simulated once more for histories that name them by index, when all others are finished; in a chain with all speeds
/// before them, one after the other.
fn recorded_speeds(request: &ResolvedSweep) -> Vec<f64> {
    let Some(HistorySpeeds::Indices(indices)) = request.histories().map(|histories| &histories.speeds) else {
        return Vec::new();
    };
    let (speeds, chain) = (request.speeds.rad_s(), request.chain().unwrap_or_default());
    let with_those_before = |&index: &u32| {
        let before = chain.iter().take_while(move |&&link| link != index).copied();
        before.chain([index]).collect::<Vec<_>>()
    };
    indices.iter().flat_map(with_those_before).map(|index| speeds[index as usize]).collect()
}

/// Number of simulated pairs of contact node and casing.
pub(crate) fn contact_pairs(scene: &Scene, facts: &ModelFacts) -> u64 {
    match scene.contact {
        Some(_) => u64::from(sectors_simulated(scene, facts)) * u64::from(facts.contact_nodes),
        None => 0,
    }
}

fn sectors_simulated(scene: &Scene, facts: &ModelFacts) -> u32 {
    match scene.symmetry {
        Symmetry::Exact => facts.sectors / repeats(scene, facts.sectors),
        Symmetry::Full | Symmetry::Probe => facts.sectors,
    }
}

/// Plans a resolved modal analysis; without `reduced`, as far as the facts allow. The caller adds the choice.
pub(crate) fn plan_modal_analysis(
    request: &ResolvedModalAnalysis,
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
) -> ModalAnalysisPlan {
    let speeds = request.speeds.ascending();
    let one = |reduced: &ReducedSector| {
        let effects = RotationEffects { stiffening: true, coriolis: request.coriolis };
        let mut diagram = FrequencyDiagram::new(&reduced.wheel, effects, request.families as usize);
        let start = Instant::now();
        diagram.push(speeds[speeds.len() / 2]).ok()?;
        let frequencies = start.elapsed().as_secs_f64() * speeds.len() as f64;
        if request.families_by == FamiliesBy::Rank {
            return Some(frequencies);
        }
        let start = Instant::now();
        for nodal_diameter in 0..reduced.wheel.harmonics.len() {
            FamilyWalk::new(&reduced.wheel, nodal_diameter, true).ok()?;
        }
        let steps = grid(&reduced.wheel, true, speeds.last().copied()?).len() + speeds.len();
        Some(frequencies + start.elapsed().as_secs_f64() * steps as f64)
    };
    let scene = Scene {
        centrifugal_stiffening: facts.has_stiffening(),
        coriolis: request.coriolis,
        ..Scene::default()
    };
    let curves = request.backbones.as_ref().map(|asked| {
        let count = asked.nodal_diameters.len() * request.families as usize;
        bending_seconds(asked.coordinates, facts) + count as f64 * curve_seconds(asked.coordinates)
    });
    let mut effects = planned(&scene);
    effects.retain(|effect| ["centrifugal_stiffening", "coriolis"].contains(&effect.name.as_str()));
    ModalAnalysisPlan {
        effects,
        reduction: state(reduced),
        reduced_unknowns_at_most: reduced_unknowns(facts, reduced, request.modes_per_speed()),
        basis_bytes_at_most: basis_bytes(facts, reduced, request.modes_per_speed(), request.fields()),
        speeds: speeds.len() as u32,
        nodal_diameters: harmonic_count(facts.sectors as usize) as u32,
        computing_time_s: reduced.and_then(one).map(|frequencies| frequencies + curves.unwrap_or(0.0)),
        backbones_time_s: curves,
        choice: None,
        warnings: warnings(&scene, facts, reduced),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    }
}

/// Warnings about the package, and about K(Ω), if `scene` uses it: those of the reduction, or, while there is none, those of the matrices.
pub(crate) fn warnings(scene: &Scene, facts: &ModelFacts, reduced: Option<&ReducedSector>) -> Vec<String> {
    let found = reduced.map(|reduced| &reduced.report.stiffening);
    let found = found.map(|found| (found.verdict, &found.message));
    let preliminary = facts.stiffening.as_ref().map(|found| (found.verdict, &found.message));
    let known = found.or(preliminary).filter(|_| scene.centrifugal_stiffening);
    let stiffening =
        known.filter(|(verdict, _)| verdict.warning().is_some()).map(|(_, message)| message.clone());
    // The report of a reduction has the sentence on digits in its message.
    let told = |sentence: &String| stiffening.as_ref().is_some_and(|message| message.contains(sentence));
    let digits = reduced.zip(facts.digits).and_then(|(reduced, digits)| reduced.cost_of(digits));
    let digits = digits.filter(|sentence| !told(sentence));
    facts.warnings.iter().cloned().chain(digits).chain(stiffening).collect()
}

/// Whether a reduction is stored.
pub(crate) fn state(reduced: Option<&ReducedSector>) -> ReductionState {
    if reduced.is_some() { ReductionState::Stored } else { ReductionState::ToBeComputed }
}

/// Upper bound of the real unknowns of the whole reduced wheel.
pub(crate) fn reduced_unknowns(
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    modes_per_speed: u32,
) -> u64 {
    let modes = facts.speeds_rad_s.len() as u64 * u64::from(modes_per_speed);
    let expected = || u64::from(facts.sectors) * (3 * u64::from(facts.contact_nodes) + modes);
    reduced.map_or_else(expected, |reduced| reduced.report.wheel_unknowns.into())
}

/// Disk space that the basis of a reduction will take, in bytes; 0 for one that is left out.
pub(crate) fn basis_bytes(
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    modes_per_speed: u32,
    fields: Option<bool>,
) -> Option<u64> {
    let is_kept = reduced.is_none() && fields != Some(false);
    is_kept.then(|| most_basis_bytes(facts, modes_per_speed))
}

/// Upper bound of the bytes of the basis of a reduction.
pub fn most_basis_bytes(facts: &ModelFacts, modes_per_speed: u32) -> u64 {
    let columns =
        3 * u64::from(facts.contact_nodes) + facts.speeds_rad_s.len() as u64 * u64::from(modes_per_speed);
    // Nobody has more columns than DOF.
    let columns = columns.min(facts.own_dofs.into());
    let harmonics = harmonic_count(facts.sectors as usize) as u64;
    u64::from(facts.own_dofs) * columns * 16 * harmonics
}

/// Disk space, and memory, that the stress of a reduction will take, in bytes: single precision, six components at about a node for every
/// three DOF.
fn stress_bytes(
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    modes_per_speed: u32,
    places: u64,
) -> u64 {
    let columns = u64::from(facts.speeds_rad_s.len() as u32) * u64::from(modes_per_speed)
        + 3 * u64::from(facts.contact_nodes);
    let unknowns = match reduced {
        Some(reduced) => reduced.report.unknowns.iter().map(|&n| u64::from(n)).sum(),
        None => columns.min(facts.own_dofs.into()) * harmonic_count(facts.sectors as usize) as u64,
    };
    stress_numbers(places, unknowns) * size_of::<f32>() as u64
}

/// Count of real numbers of the stress of `unknowns` over all nodal diameters.
fn stress_numbers(places: u64, unknowns: u64) -> u64 {
    6 * 2 * places * unknowns
}

/// Memory of the stress of one speed, in bytes, with that of the reduction: its numbers, the states of the last revolution as they are
/// recorded and in two other coordinates, and the bounds of every place.
fn stress_memory(places: u64, wheel: &ModalWheel, stepping: &Stepping) -> u64 {
    /// Approximate number of directions of a nodal diameter for the bounds.
    const DIRECTIONS: u64 = 12;
    /// Bytes of the bounds and the static stress of a place.
    const PLACE: u64 = 256;
    if places == 0 {
        return 0;
    }
    let real = size_of::<f32>() as u64;
    let states = 4 * 16 * modes(wheel) * stepping.discretisation.samples as u64;
    let parts = 6 * 2 * DIRECTIONS * wheel.harmonics.len() as u64 * real * places;
    real * stress_numbers(places, modes(wheel)) + states + parts + PLACE * places
}

/// Approximate number of nodes of a sector with stress; 0 where stress is not asked for.
fn stress_places(facts: &ModelFacts, request: &ResolvedSweep) -> u64 {
    request.stress_outside().map_or(0, |_| u64::from(facts.own_dofs).div_ceil(3))
}

/// Number of modes of all nodal diameters.
fn modes(wheel: &ModalWheel) -> u64 {
    wheel.harmonics.iter().map(|harmonic| harmonic.omega.len() as u64).sum()
}

/// Largest sum of cubed unknowns over all nodal diameters for which a plan solves three eigenproblems: about a second.
const EIGEN_WORK: f64 = 1e8;

/// Indices of all speeds or of the slowest, the middle and the fastest one, in ascending speed; only the slowest where its eigenproblems of
/// `unknowns` take long.
fn representatives(speeds: &[f64], unknowns: &[u32]) -> Vec<usize> {
    let mut ascending: Vec<usize> = (0..speeds.len()).collect();
    ascending.sort_by(|&a, &b| speeds[a].total_cmp(&speeds[b]));
    if unknowns.iter().map(|&n| f64::from(n).powi(3)).sum::<f64>() > EIGEN_WORK {
        ascending.truncate(1);
    }
    if ascending.len() <= 3 {
        return ascending;
    }
    [0, ascending.len() / 2, ascending.len() - 1].map(|place| ascending[place]).to_vec()
}

fn plan_point(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    calibration: &Calibration,
    (index, speed_rad_s): (usize, f64),
    places: u64,
) -> PlannedPoint {
    let start = Instant::now();
    let ready = SpeedScene::new(reduced, Cow::Borrowed(request), speed_rad_s).and_then(|scene| {
        scene.check()?;
        // While the growth of the tips has still to be solved for, as they are given.
        let clearance = match reduced.growth {
            Some(_) => running_clearance(reduced, request, speed_rad_s)?,
            None => clearance_given(&reduced.wheel.contact, request),
        };
        let casing = scene.casing(clearance, request.integration.ramp_revolutions)?;
        scene.initial(casing.as_ref())?;
        let interference = casing.as_ref().filter(|_| request.scene.contact.is_some());
        Ok((scene, interference.and_then(Casing::interference)))
    });
    let set_up = start.elapsed().as_secs_f64();
    let planned = PlannedPoint {
        index: index as u32,
        speed_rad_s,
        message: None,
        interference: None,
        integrated_unknowns: 0,
        scheme: None,
        steps_per_revolution: 0,
        steps: 0,
        computing_time_s: None,
        memory_bytes: 0,
    };
    let (scene, interference) = match ready {
        Ok(ready) => ready,
        Err(reason) => return PlannedPoint { message: Some(reason.to_string()), ..planned },
    };
    let SpeedScene { wheel, stepping, .. } = &scene;
    let unknowns = stepping.scheme.integrated_unknowns(wheel);
    let per_revolution = stepping.discretisation.per_revolution as u64;
    let [least, most] = revolutions_taken(request).map(|revolutions| per_revolution * revolutions);
    let nodes = scene.touching();
    let size = StepSize { sectors: wheel.sectors, nodes, unknowns };
    let effects = EffectSizes::of(&request.scene, wheel, stepping.scheme, nodes);
    let (free, contact) = calibration.step_seconds(size, &effects);
    let histories = request.histories().map_or(0, |asked| recorded_bytes(&asked.recorded(), &scene));
    let windowed = per_revolution * u64::from(request.integration.window_revolutions);
    let spectra = windowed as f64 * calibration.spectra_seconds(size, request.sensors.len());
    let stress = calibration.stress_seconds(stress_numbers(places, modes(wheel)));
    PlannedPoint {
        interference,
        integrated_unknowns: unknowns as u32,
        steps_per_revolution: stepping.discretisation.per_revolution as u32,
        steps: most,
        computing_time_s: Some(CostRange {
            free: set_up + stress + least as f64 * free + spectra,
            contact: set_up + stress + most as f64 * contact + spectra,
        }),
        memory_bytes: scene.running_bytes() + stress_memory(places, wheel, stepping) + histories,
        scheme: Some(scene.stepping.report),
        ..planned
    }
}

/// Memory that a trial takes while it runs, in bytes; 0 where its speed cannot be integrated.
pub fn trial_memory(reduced: &ReducedSector, request: &TrialRequest) -> u64 {
    let sweep = &request.sweep;
    let Ok(scene) = SpeedScene::new(reduced, Cow::Borrowed(sweep), request.speed_rad_s()) else { return 0 };
    // A twin has a history of its own.
    let runs = 1 + u64::from(request.twin);
    let places = reduced.stress.as_ref().map_or(0, |stress| stress.places() as u64);
    runs * scene.running_bytes() + stress_memory(places, &scene.wheel, &scene.stepping)
}

/// Memory that speed `place` of a case study takes while it is recorded, in bytes: its run, and its histories twice, as numbers and as
/// text.
pub fn histories_memory(reduced: &ReducedSector, case: &ResolvedCaseStudy, place: usize) -> u64 {
    let sweep = &case.sweep;
    let speed = sweep.speeds.rad_s()[case.speeds[place] as usize];
    let Ok(scene) = SpeedScene::new(reduced, Cow::Borrowed(sweep), speed) else { return 0 };
    recorded_bytes(&case.record, &scene) + scene.running_bytes()
}

/// Memory of histories, in bytes: twice, as numbers and as text.
fn recorded_bytes(record: &Recorded, scene: &SpeedScene<'_>) -> u64 {
    /// Bytes of a number as numbers and as text.
    const NUMBER: usize = 8 + 24;
    let SpeedScene { request: sweep, wheel, stepping, .. } = scene;
    let (from, to) = revolutions(record, sweep);
    let state = wheel.harmonics.iter().map(|harmonic| 2 * harmonic.omega.len()).sum();
    let lines = lines(record, sweep, wheel.sectors * scene.touching(), state);
    (NUMBER * lines * stepping.discretisation.samples * (to - from)) as u64
}

impl SpeedScene<'_> {
    /// Memory that a speed takes while it runs, in bytes: its modes with the work space of their eigenproblems, the table of the casing, the
    /// histories, the work space of a spectrum, and the spectra, as they are and on their way into the database.
    pub(crate) fn running_bytes(&self) -> u64 {
        const REAL: usize = size_of::<f64>();
        const COMPLEX: usize = 2 * REAL;
        let Self { request, wheel, stepping, .. } = self;
        let nodes = self.touching();
        let steps = &stepping.discretisation;
        let (revolutions, window) =
            (request.integration.revolutions() as usize, request.integration.window_revolutions as usize);
        let sizes = wheel.harmonics.iter().map(|h| h.omega.len());
        let eigen = COMPLEX * 6 * sizes.clone().max().unwrap_or(0).pow(2);
        let shapes: usize =
            wheel.harmonics.iter().map(|h| COMPLEX * h.contact.nrows() * h.contact.ncols()).sum();
        let stride = nodes.next_multiple_of(8);
        let casing = request.scene.casing.as_ref().filter(|_| nodes > 0);
        let shaped = casing.is_some_and(|casing| !casing.shape.is_circular() || casing.may_press());
        // Points, heights and bends of measured curves, of the casing and of what is made of it.
        let measured = casing.and_then(|casing| casing.shape.measured.as_ref());
        let points = measured.map_or(0, |measured| measured.angles_rad.len() * measured.heights.len());
        let table = 6 * REAL * points
            + if shaped {
                REAL * RestrictionTable::size(steps.per_revolution, wheel.around(), stride)
            } else {
                0
            };
        // Rows of the sensor nodes in the reduced coordinates and in the modes.
        let read = 2 * COMPLEX * 3 * request.sensor_nodes().len() * sizes.clone().sum::<usize>();
        // Normals, tips in three components, sensors.
        let rows = 2 * REAL * (4 * nodes + request.sensors.len()) * sizes.sum::<usize>() + read;
        let history =
            REAL * steps.samples * request.sensors.len() * (revolutions + (2 * wheel.sectors + 1) * window);
        let spectrum = 4 * COMPLEX * steps.samples * window;
        let bins = request.max_engine_order as usize * window + 1;
        let spectra = 4 * REAL * request.sensors.len() * (1 + wheel.harmonics.len()) * bins;
        let search =
            steady::memory(request, stepping.scheme.integrated_unknowns(wheel), wheel.sectors * nodes);
        (eigen + shapes + table + rows + history + spectrum + spectra) as u64 + search
    }
}

/// Memory of mass and stiffness of every nodal diameter, in bytes.
pub(crate) fn reduced_bytes(reduced: &ReducedSector) -> u64 {
    let matrices = 1 + reduced.wheel.speeds_rad_s.len() as u64;
    reduced.report.unknowns.iter().map(|&n| 16 * matrices * u64::from(n).pow(2)).sum()
}

/// Estimate for all `speeds` from the `planned` ones, in ascending speed.
fn estimate(planned: &[PlannedPoint], speeds: &[f64], workers: usize, kept_bytes: u64) -> Option<Estimate> {
    let known: Vec<(f64, f64, CostRange)> = planned
        .iter()
        .filter_map(|point| Some((point.speed_rad_s, point.steps as f64, point.computing_time_s?)))
        .collect();
    known.first()?;
    let (mut steps, mut sum, mut longest) = (0.0, CostRange::default(), CostRange::default());
    for &speed in speeds {
        let of = |value: fn(&(f64, f64, CostRange)) -> f64| interpolate(&known, speed, value);
        let (free, contact) = (of(|point| point.2.free), of(|point| point.2.contact));
        steps += of(|point| point.1);
        sum = CostRange { free: sum.free + free, contact: sum.contact + contact };
        longest = CostRange { free: longest.free.max(free), contact: longest.contact.max(contact) };
    }
    let together = workers.clamp(1, speeds.len());
    let side_by_side = |sum: f64, longest: f64| longest.max(sum / together as f64);
    let largest = planned.iter().map(|point| point.memory_bytes).max().unwrap_or(0);
    Some(Estimate {
        steps: steps.round() as u64,
        computing_time_s: sum,
        wall_time_s: CostRange {
            free: side_by_side(sum.free, longest.free),
            contact: side_by_side(sum.contact, longest.contact),
        },
        workers: together as u32,
        memory_bytes: kept_bytes + together as u64 * largest,
        speed_memory_bytes: largest,
    })
}

/// Value at `speed`, interpolated between the `known` ones linearly in 1/Ω, as the steps per revolution that resolve a frequency are;
/// constant beyond them.
fn interpolate<P: Copy>(known: &[(f64, f64, P)], speed: f64, value: fn(&(f64, f64, P)) -> f64) -> f64 {
    let above = known.partition_point(|point| point.0 < speed);
    match (above.checked_sub(1).map(|below| &known[below]), known.get(above)) {
        (Some(below), Some(above)) => {
            let span = 1.0 / below.0 - 1.0 / above.0;
            // Neighbouring numbers may have the same reciprocal.
            let share = if span > 0.0 { (1.0 / below.0 - 1.0 / speed) / span } else { 0.0 };
            value(below) + share * (value(above) - value(below))
        }
        (Some(end), None) | (None, Some(end)) => value(end),
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slowest_middle_and_fastest_stand_for_many() {
        assert_eq!(representatives(&[3.0, 1.0], &[90; 6]), [1, 0]);
        assert_eq!(representatives(&[5.0, 1.0, 4.0, 2.0, 3.0], &[90; 6]), [1, 4, 0]);
        assert_eq!(representatives(&[5.0, 1.0], &[1500; 6]), [1]);
    }

    #[test]
    fn costs_between_planned_speeds_follow_the_steps() {
        let point = |index, speed_rad_s: f64, steps: u64| PlannedPoint {
            index,
            speed_rad_s,
            message: None,
            interference: None,
            integrated_unknowns: 10,
            scheme: None,
            steps_per_revolution: steps as u32,
            steps,
            computing_time_s: Some(CostRange { free: steps as f64, contact: 2.0 * steps as f64 }),
            memory_bytes: 100 * steps,
        };
        // A fixed frequency resolved: S ∝ 1/Ω.
        let planned = [point(0, 1.0, 1200), point(2, 3.0, 400), point(4, 6.0, 200)];
        let found = estimate(&planned, &[1.0, 2.0, 3.0, 4.0, 6.0], 2, 7).unwrap();
        assert_eq!(found.steps, 1200 + 600 + 400 + 300 + 200);
        assert!((found.computing_time_s.contact - 2.0 * 2700.0).abs() < 1e-9);
        assert!((found.wall_time_s.free - 1350.0).abs() < 1e-9);
        assert_eq!(found.memory_bytes, 7 + 2 * 120_000);
        // More workers than speeds do not help, and the longest speed is the least.
        let found = estimate(&planned, &[1.0, 6.0], 8, 0).unwrap();
        assert_eq!((found.workers, found.wall_time_s.free), (2, 1200.0));
        // Speeds that cannot be integrated cost nothing that could be told.
        let failed = PlannedPoint { computing_time_s: None, ..point(0, 1.0, 0) };
        assert_eq!(estimate(&[failed], &[1.0], 1, 0), None);
    }
}
