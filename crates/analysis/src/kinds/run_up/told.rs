//! Results of run-ups, put together from their legs.

use super::passing::passing;
use crate::model::ModelFacts;
use crate::resolved::ResolvedRunUps;
use crate::result::{PointStatus, RunUp, RunUpEnd, RunUpLeg, RunUps, Spectrogram};
use rubmap_wheel::revision::VERSION;

impl RunUpEnd {
    /// Whether the run was completed.
    pub fn is_complete(&self) -> bool {
        self.status == PointStatus::Completed
    }
}

impl RunUpLeg {
    /// Number of the run of this leg.
    pub fn run(&self) -> u32 {
        self.run
    }

    /// Status of the run at its end, if this is its last leg.
    pub fn status(&self) -> Option<PointStatus> {
        self.end.as_ref().map(|end| end.status)
    }

    /// Spectra of the frames, `[frame][sensor][line]`, which are stored apart from the leg.
    pub fn spectra(&self) -> Vec<&[Vec<f64>]> {
        self.frames.iter().map(|frame| frame.spectra.as_slice()).collect()
    }

    /// Adds the spectra of the frames.
    #[must_use]
    pub fn with_spectra(mut self, spectra: Vec<Vec<Vec<f64>>>) -> Self {
        self.frames.iter_mut().zip(spectra).for_each(|(frame, spectra)| frame.spectra = spectra);
        self
    }
}

/// Run-ups of the legs so far, in their order; none without a leg.
pub fn run_ups(asked: &ResolvedRunUps, facts: &ModelFacts, legs: Vec<RunUpLeg>) -> Option<RunUps> {
    let vectors = legs.first()?.vectors.clone();
    let mut runs: Vec<RunUp> = Vec::new();
    for RunUpLeg { run, order_step, frames, end, .. } in legs {
        match runs.last_mut().filter(|last| last.run == run) {
            Some(last) => {
                last.frames.extend(frames);
                last.end = end;
            }
            None => runs.push(RunUp { run, rate_rad_s2: asked.speed.rate(run), order_step, frames, end }),
        }
    }
    let ended = runs.iter().filter(|run| run.end.is_some()).count();
    let complete = ended == asked.runs() as usize;
    let rated = runs.iter().all(|run| run.rate_rad_s2.is_some());
    Some(RunUps {
        sensors: asked.sweep.sensors.iter().copied().map(Into::into).collect(),
        units: facts.units.clone(),
        complete,
        passing: asked
            .limit
            .filter(|_| complete && rated)
            .and_then(|limit| passing(limit, &facts.units.length, &runs)),
        runs,
        settings: asked.clone().into(),
        version: VERSION.to_owned(),
        vectors,
    })
}

/// Amplitudes of a sensor in a run, frame by frame; none for a run or a sensor that does not exist.
pub fn spectrogram(run_ups: &RunUps, run: u32, sensor: usize) -> Option<Spectrogram> {
    let found = run_ups.runs.iter().find(|found| found.run == run)?;
    let frames = || found.frames.iter().filter(|frame| !frame.spectra.is_empty());
    let lines = frames().next().map_or(0, |frame| frame.spectra.get(sensor).map_or(0, Vec::len));
    Some(Spectrogram {
        run,
        rate_rad_s2: found.rate_rad_s2,
        sensor: *run_ups.sensors.get(sensor)?,
        units: run_ups.units.clone(),
        engine_orders: (0..lines).map(|line| line as f64 * found.order_step).collect(),
        times_s: frames().map(|frame| 0.5 * (frame.times_s[0] + frame.times_s[1])).collect(),
        speeds_rad_s: frames().map(|frame| frame.speeds_rad_s).collect(),
        amplitudes: frames().filter_map(|frame| frame.spectra.get(sensor).cloned()).collect(),
        settings: run_ups.settings.clone(),
        version: run_ups.version.clone(),
    })
}
