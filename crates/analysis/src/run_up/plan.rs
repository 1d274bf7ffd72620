//! What run-ups will do and cost, before they begin.

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
use crate::plan::{contact_pairs, reduced_bytes, reduced_unknowns, running_bytes, state, touching, warnings};
use crate::resolved::ResolvedRunUps;
use crate::result::{CostRange, Estimate, PlannedEffect, PlannedRunUp, RunUpPlan, SchemeReport};
use crate::speed::ready;
use crate::wheel::wheel_of;
use rubmap_wheel::revision::VERSION;

/// Plans resolved run-ups; without `reduced`, what can be said without it. Which machine was measured is for the caller to add.
pub fn plan_run_ups(
    asked: &ResolvedRunUps,
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    calibration: &Calibration,
) -> RunUpPlan {
    let sweep = asked.sweep();
    let mut set_up_s = None;
    let runs: Vec<_> = (0..asked.runs())
        .map(|run| plan_run(asked, facts, reduced, calibration, run, &mut set_up_s))
        .collect();
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
    reduced: Option<&ReducedSector>,
    calibration: &Calibration,
    run: u32,
    set_up_s: &mut Option<f64>,
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
    match reduced.map(|reduced| price(&march, reduced, calibration, set_up_s)) {
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

/// Scheme at the lowest speed, steps and time of a run: of every band what a step takes, and of every segment what setting it up took for the
/// first run of the plan, `set_up_s`, which is measured if it is not there: that of others takes as long.
fn price(
    march: &March<'_>,
    reduced: &ReducedSector,
    calibration: &Calibration,
    set_up_s: &mut Option<f64>,
) -> Result<(SchemeReport, u64, CostRange), NotRunnable> {
    let request = march.request();
    let nodes = touching(reduced, request);
    let mut bands: Vec<(u32, u64)> = Vec::new();
    for segment in &march.segments {
        match bands.iter_mut().find(|(band, _)| *band == segment.band) {
            Some((_, samples)) => *samples += segment.samples,
            None => bands.push((segment.band, segment.samples)),
        }
    }
    bands.sort_unstable();
    let first = march.segments.first().map_or(0, |segment| segment.band);
    let stepping = march.stepping(reduced, first)?;
    let set_up_s = match *set_up_s {
        Some(known) => known,
        None => {
            let planning = reduced.for_planning();
            let clock = Instant::now();
            march.begin(&planning, &stepping)?;
            *set_up_s.insert(clock.elapsed().as_secs_f64())
        }
    };
    let set_up = set_up_s * march.segments.len() as f64;
    let (mut all, mut time, mut scheme) = (0, CostRange { free: set_up, contact: set_up }, None);
    for (band, samples) in bands {
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
        let steps =
            samples * (stepping.discretisation.per_revolution / stepping.discretisation.samples) as u64;
        all += steps;
        time.free += steps as f64 * free;
        time.contact += steps as f64 * contact;
        scheme.get_or_insert(stepping.report);
    }
    Ok((scheme.unwrap_or_else(|| unreachable!("a run has at least one segment")), all, time))
}

/// Memory that a run holds, in bytes: what a speed does, the lowest or the highest, its shapes, the samples of a frame and the amplitudes of a leg
/// with their text.
pub fn run_ups_memory(reduced: &ReducedSector, asked: &ResolvedRunUps) -> u64 {
    const LEG: u64 = 64 << 20;
    let sweep = asked.sweep();
    let (lowest, highest) = asked.speed.range();
    let of = |speed: f64| {
        let (wheel, stepping) = ready(reduced, sweep, speed).ok()?;
        // With Coriolis forces two wheels' gyroscopic matrices, what they make of a step, and the Euler force by them.
        let matrices = 2 + if sweep.scene.coriolis { 4 } else { 0 };
        Some(
            running_bytes(&wheel, sweep, &stepping, touching(reduced, sweep))
                + matrices * Shapes::bytes(&wheel),
        )
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
