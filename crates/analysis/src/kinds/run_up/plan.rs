//! Plan of run-ups: work and cost, before they begin.

use std::borrow::Cow;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::time::Instant;

use super::march::March;
use crate::calibration::Calibration;
use crate::calibration::effects::EffectSizes;
use crate::calibration::size::StepSize;
use crate::discretisation::Discretisation;
use crate::effects::symmetry::result::FoundSymmetry;
use crate::effects::table::planned;
use crate::end_state::Shapes;
use crate::model::{ModelFacts, ReducedSector};
use crate::not_runnable::NotRunnable;
use crate::plan::{contact_pairs, reduced_bytes, reduced_unknowns, state, warnings};
use crate::resolved::ResolvedRunUps;
use crate::result::{CostRange, Estimate, PlannedEffect, PlannedRunUp, RunUpPlan, SchemeReport};
use crate::speed_scene::SpeedScene;
use crate::stepping::touching;
use crate::wheel::wheel_of;
use rubmap_wheel::revision::VERSION;

/// Plans resolved run-ups; without `reduced`, as far as the facts allow. The caller adds the measured machine.
pub(crate) fn plan_run_ups(
    asked: &ResolvedRunUps,
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    calibration: &Calibration,
) -> RunUpPlan {
    let sweep = asked.sweep();
    let mut prices = reduced.map(|reduced| Prices::new(reduced, calibration));
    let runs: Vec<_> = (0..asked.runs()).map(|run| plan_run(asked, facts, prices.as_mut(), run)).collect();
    let estimate = reduced.and_then(|reduced| {
        let mut all = CostRange { free: 0.0, contact: 0.0 };
        let mut steps = 0;
        for run in &runs {
            let of = run.computing_time_s?;
            all = CostRange { free: all.free + of.free, contact: all.contact + of.contact };
            steps += run.steps?;
        }
        let memory = run_ups_memory(reduced, asked);
        Some(Estimate {
            steps,
            computing_time_s: all,
            wall_time_s: all,
            workers: 1,
            memory_bytes: reduced_bytes(reduced) + memory,
            speed_memory_bytes: memory,
        })
    });
    RunUpPlan {
        effects: planned(&sweep.scene).into_iter().chain([planned_euler_force(asked)]).collect(),
        symmetry: FoundSymmetry::of(&sweep.scene, facts.sectors),
        contact_pairs: contact_pairs(&sweep.scene, facts),
        reduction: state(reduced),
        reduced_unknowns_at_most: reduced_unknowns(facts, reduced, sweep.modes_per_speed()),
        machine: None,
        runs,
        estimate,
        warnings: warnings(&sweep.scene, facts, reduced),
        settings: asked.clone().into(),
        version: VERSION.to_owned(),
    }
}

fn planned_euler_force(asked: &ResolvedRunUps) -> PlannedEffect {
    let on = asked.has_euler_force();
    let adds = "a force on the modes of nodal diameter 0 in every step, and with Coriolis forces another product with the gyroscopic matrix \
                of every nodal diameter";
    PlannedEffect { name: "euler_force".to_owned(), on, adds: on.then(|| adds.to_owned()) }
}

fn plan_run(
    asked: &ResolvedRunUps,
    facts: &ModelFacts,
    prices: Option<&mut Prices<'_>>,
    run: u32,
) -> PlannedRunUp {
    let profile = asked.speed.profile(run);
    let revolutions = profile.revolutions();
    let planned = PlannedRunUp {
        rate_rad_s2: asked.speed.rate(run),
        duration_s: profile.duration_s(),
        revolutions,
        frame_revolutions: asked.frame_revolutions(revolutions),
        segments: 0,
        message: None,
        scheme: None,
        steps: None,
        computing_time_s: None,
    };
    let march = match March::new(asked, facts.sectors as usize, run) {
        Ok(march) => march,
        Err(reason) => return PlannedRunUp { message: Some(reason.to_string()), ..planned },
    };
    let planned = PlannedRunUp { segments: march.segments.len() as u64, ..planned };
    match prices.map(|prices| prices.of_run(&march)) {
        None => planned,
        Some(Ok((scheme, steps, computing_time_s))) => PlannedRunUp {
            scheme: Some(scheme),
            steps: Some(steps),
            computing_time_s: Some(computing_time_s),
            ..planned
        },
        Some(Err(reason)) => PlannedRunUp { message: Some(reason.to_string()), ..planned },
    }
}

/// Prices that all runs of one plan share: runs with different rates over one range have the same bands.
struct Prices<'a> {
    reduced: &'a ReducedSector,
    calibration: &'a Calibration,
    /// Time of the set-up of a segment, s: the same for all segments.
    set_up_s: Option<f64>,
    /// Prices of bands, by the lowest speed and the highest band of the run.
    bands: HashMap<(u64, u32), BandPrice>,
}

/// Price of a band.
#[derive(Clone)]
struct BandPrice {
    scheme: SchemeReport,
    steps_per_sample: u64,
    /// Time of a step without contact and in contact, s.
    step_s: CostRange,
}

impl<'a> Prices<'a> {
    fn new(reduced: &'a ReducedSector, calibration: &'a Calibration) -> Self {
        Self { reduced, calibration, set_up_s: None, bands: HashMap::new() }
    }

    /// Scheme at the lowest speed, steps and time of a run: the steps of every band, and the set-up of every segment.
    fn of_run(&mut self, march: &March<'_>) -> Result<(SchemeReport, u64, CostRange), NotRunnable> {
        let mut bands = BTreeMap::<u32, u64>::new();
        for segment in &march.segments {
            *bands.entry(segment.band).or_default() += segment.samples;
        }
        let set_up = self.set_up_seconds(march)? * march.segments.len() as f64;
        let (mut all, mut time, mut scheme) = (0, CostRange { free: set_up, contact: set_up }, None);
        for (band, samples) in bands {
            let price = self.band(march, band)?;
            let steps = samples * price.steps_per_sample;
            all += steps;
            time.free += steps as f64 * price.step_s.free;
            time.contact += steps as f64 * price.step_s.contact;
            scheme.get_or_insert_with(|| price.scheme.clone());
        }
        Ok((scheme.unwrap_or_else(|| unreachable!("a run has at least one segment")), all, time))
    }

    fn set_up_seconds(&mut self, march: &March<'_>) -> Result<f64, NotRunnable> {
        if let Some(known) = self.set_up_s {
            return Ok(known);
        }
        let first = march.segments.first().map_or(0, |segment| segment.band);
        let stepping = march.stepping(self.reduced, first)?;
        let planning = self.reduced.for_planning();
        let clock = Instant::now();
        march.begin(&planning, &stepping)?;
        Ok(*self.set_up_s.insert(clock.elapsed().as_secs_f64()))
    }

    fn band(&mut self, march: &March<'_>, band: u32) -> Result<&BandPrice, NotRunnable> {
        let lowest = march.lowest_of(band);
        Ok(match self.bands.entry((lowest.to_bits(), march.highest_band())) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(unknown) => unknown.insert(price(march, self.reduced, self.calibration, band)?),
        })
    }
}

fn price(
    march: &March<'_>,
    reduced: &ReducedSector,
    calibration: &Calibration,
    band: u32,
) -> Result<BandPrice, NotRunnable> {
    let request = march.request();
    let nodes = touching(&reduced.wheel.contact, request).len();
    let stepping = march.stepping(reduced, band)?;
    let wheel = wheel_of(&request.scene, &reduced.wheel, march.lowest_of(band))?;
    let unknowns = stepping.scheme.integrated_unknowns(&wheel);
    let size = StepSize { sectors: wheel.sectors, nodes, unknowns };
    let effects = EffectSizes::of(&request.scene, &wheel, stepping.scheme, nodes);
    let effects = match march.has_euler_force() {
        true => effects.with_euler_force(&wheel, stepping.scheme, nodes),
        false => effects,
    };
    let (free, contact) = calibration.step_seconds(size, &effects);
    let steps = stepping.discretisation.per_revolution / stepping.discretisation.samples;
    Ok(BandPrice {
        scheme: stepping.report,
        steps_per_sample: steps as u64,
        step_s: CostRange { free, contact },
    })
}

/// Memory that a run takes, in bytes: that of its lowest or its highest speed, the shapes, the samples of a frame, and the amplitudes of a
/// leg with their text.
pub(crate) fn run_ups_memory(reduced: &ReducedSector, asked: &ResolvedRunUps) -> u64 {
    const LEG: u64 = 64 << 20;
    let sweep = asked.sweep();
    let (lowest, highest) = asked.speed.range();
    let of = |speed: f64| {
        let scene = SpeedScene::new(reduced, Cow::Borrowed(sweep), speed).ok()?;
        // With Coriolis forces two wheels' gyroscopic matrices, what they make of a step, and the Euler force by them.
        let matrices = 2 + if sweep.scene.coriolis { 4 } else { 0 };
        Some(scene.running_bytes() + matrices * Shapes::bytes(&scene.wheel))
    };
    let running = [lowest, highest].into_iter().filter_map(of).max().unwrap_or(0);
    let frame = |run: u32| {
        let revolutions = asked.speed.profile(run).revolutions();
        asked.frame_revolutions(revolutions).min(revolutions.ceil() as u64)
    };
    let longest = (0..asked.runs()).map(frame).max().unwrap_or(0);
    let samples = longest * Discretisation::of_every_speed(sweep, reduced.wheel.sectors) as u64;
    running + 4 * samples * sweep.sensors().len() as u64 * size_of::<f64>() as u64 + LEG
}
