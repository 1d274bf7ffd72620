//! Trials: one speed at one setting, run to be compared with others, with its cost.

use std::borrow::Cow;
use std::cell::Cell;
use std::time::Duration;

use cpu_time::ThreadTime;

use crate::discretisation::aligned_samples;
use crate::error::AnalysisError;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::record::{Recorded, record_run};
use crate::request::Setting;
use crate::request::auto_or::MOST_STEPS;
use crate::resolved::{ResolvedSweep, TrialRequest};
use crate::result::{Cost, SpeedSpectra, Trial};
use crate::speed::{empty_point, judge_run};
use crate::speed_scene::{Recording, SpeedScene, Start};
use crate::steady::Simulated;
use rubmap_wheel::dynamics::integrate::{Outcome, Run};
use rubmap_wheel::response::sensitivity;

impl Setting {
    /// Smallest number of steps per revolution, at least `steps`, for which the histories of all settings of `request` share their instants
    /// on a wheel of `sectors`.
    pub(crate) fn aligned_steps(steps: u32, request: &ResolvedSweep, sectors: u32) -> u32 {
        let aligned = aligned_samples(request, sectors as usize) as u32;
        let most = MOST_STEPS / aligned * aligned;
        steps.checked_next_multiple_of(aligned).map_or(most, |steps| steps.min(most))
    }
}

/// Fewest parts of the window whose levels are compared, if it has that many revolutions.
const BLOCKS: usize = 5;

/// Total time after which a run is no longer repeated to measure its cost.
const TIMED: Duration = Duration::from_millis(300);
/// Most repetitions of a run to measure its cost.
const MOST_REPETITIONS: usize = 5;

/// Runs a trial on the calling thread. Deterministic but for times. A run that diverges or cannot be made is a result, with the status and
/// message of its point.
///
/// # Errors
/// Cancellation.
pub fn run_trial(
    reduced: &ReducedSector,
    request: &TrialRequest,
    monitor: &dyn Monitor,
) -> Result<Trial, AnalysisError> {
    // The growth of a perturbation shows only if both runs take all revolutions.
    let whole = request.twin.then(|| request.sweep.taking_all());
    let sweep = whole.as_ref().unwrap_or(&request.sweep);
    let speed_rad_s = request.speed_rad_s();
    let mut trial = Trial {
        point: empty_point(reduced, sweep, 0, speed_rad_s),
        unknowns: 0,
        lines: Vec::new(),
        levels: Vec::new(),
        history: Vec::new(),
        samples_per_revolution: 0,
        sensitivity: None,
        cost: Cost::default(),
    };
    let watch = |_: f64| !monitor.is_cancelled();
    let (mut repetitions, mut spent) = (Vec::new(), Duration::ZERO);
    let mut first = None;
    while repetitions.is_empty() || (spent < TIMED && repetitions.len() < MOST_REPETITIONS && first.is_some())
    {
        let clock = ThreadTime::now();
        let set_up = Cell::new(None);
        let marked = |fraction: f64| {
            if set_up.get().is_none() {
                set_up.set(Some(clock.elapsed()));
            }
            watch(fraction)
        };
        let ran = SpeedScene::new(reduced, Cow::Borrowed(sweep), speed_rad_s).and_then(|scene| {
            let simulated = scene.simulate(Start::Scene, Recording::of(sweep), &marked)?;
            Ok((scene, simulated))
        });
        let whole = clock.elapsed();
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        spent += whole;
        // One that was never set up ran no revolution.
        let set_up = set_up.get().unwrap_or(whole);
        // A run that diverged made fewer than were asked for; one that was solved for is as dear as the march in whose place it is.
        let made = |(scene, simulated): &(SpeedScene<'_>, Simulated)| match simulated.steady {
            Some(_) => f64::from(sweep.integration.revolutions()),
            None => {
                let per_revolution = scene.stepping.discretisation.per_revolution;
                simulated.run.statistics.steps as f64 / per_revolution as f64
            }
        };
        let revolutions = ran.as_ref().map_or(0.0, made);
        let running = (whole - set_up).as_secs_f64();
        let per_revolution = if revolutions > 0.0 { running / revolutions } else { 0.0 };
        repetitions.push((set_up.as_secs_f64(), per_revolution));
        match ran {
            Err(reason) => trial.point.message = Some(reason.to_string()),
            Ok(ran) => first = first.or(Some(ran)),
        }
    }
    trial.cost = Cost::of(repetitions);
    let Some((scene, simulated)) = first else { return Ok(trial) };
    let run = &simulated.run;
    trial.unknowns = scene.stepping.scheme.integrated_unknowns(&scene.wheel) as u32;
    let samples = scene.stepping.discretisation.samples;
    trial.samples_per_revolution = samples as u32;
    let recorded = record_run(&mut trial.point, &simulated, &scene)?;
    judge_run(&mut trial.point, run, &scene);
    if let (Outcome::Completed(history), Some(Recorded { spectra, .. })) = (&run.outcome, &recorded) {
        let kept = samples * request.history_revolutions.min(sweep.integration.revolutions()) as usize;
        trial.history = history.displacement.iter().map(|line| line[..kept].to_vec()).collect();
        let window = samples * sweep.integration.window_revolutions as usize;
        trial.levels =
            history.displacement.iter().map(|line| levels(&line[line.len() - window..], samples)).collect();
        trial.lines = lines(spectra, sweep);
        // A response that was solved for has no history that a perturbation could have changed.
        if request.twin && !trial.point.is_solved() {
            let twin = scene.simulate(Start::Perturbed, Recording::default(), &watch);
            if let Ok(Simulated { run: Run { outcome: Outcome::Completed(twin), .. }, .. }) = twin {
                let from = sweep.integration.ramp_revolutions.ceil() as usize;
                let (run, twin) = (&history.displacement, &twin.displacement);
                let settling = trial.point.settling.as_ref();
                trial.sensitivity =
                    settling.map(|settling| sensitivity::judge(run, twin, samples, from, settling.verdict));
            } else if monitor.is_cancelled() {
                return Err(AnalysisError::Cancelled);
            }
        }
    }
    Ok(trial)
}

/// Root mean square of each part of the window about the mean of the window. All parts have the same number of whole revolutions; a rest at
/// the end is not counted.
fn levels(window: &[f64], samples_per_revolution: usize) -> Vec<f64> {
    let revolutions = window.len() / samples_per_revolution;
    let part = samples_per_revolution * (revolutions / revolutions.clamp(1, BLOCKS));
    let mean = window.iter().sum::<f64>() / window.len() as f64;
    let level =
        |part: &[f64]| (part.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / part.len() as f64).sqrt();
    window.chunks_exact(part.max(1)).map(level).collect()
}

/// Amplitudes at the integer engine orders from 1 on, `[sensor][engine order]`.
pub(super) fn lines(spectra: &SpeedSpectra, request: &ResolvedSweep) -> Vec<Vec<f64>> {
    let window = request.integration.window_revolutions as usize;
    let orders = |amplitude: &[f64]| amplitude.iter().skip(window).step_by(window).copied().collect();
    spectra.sensors.iter().map(|sensor| orders(&sensor.amplitude)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_stand_for_repetitions() {
        let cost = Cost::of(vec![(3.0, 1.0), (1.0, 1.2), (2.0, 0.8)]);
        assert_eq!((cost.set_up_s, cost.per_revolution_s, cost.repetitions), (2.0, 1.0, 3));
        assert!((cost.spread.unwrap() - 0.2).abs() < 1e-12 && (cost.of_run(10.0) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn levels_are_of_whole_revolutions() {
        let sine = |j: u32| 7.0 + 2.0 * (0.2 * std::f64::consts::PI * f64::from(j)).sin();
        let steady: Vec<f64> = (0..120).map(sine).collect();
        for (revolutions, parts) in [(1, 1), (2, 2), (4, 4), (5, 5), (9, 9), (12, 6)] {
            let found = levels(&steady[..10 * revolutions], 10);
            assert_eq!(found.len(), parts, "{revolutions}");
            assert!(found.iter().all(|level| (level - 2f64.sqrt()).abs() < 1e-9));
        }
    }
}
