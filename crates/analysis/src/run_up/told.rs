//! Legs put together.

use super::passing::passing;
use crate::model::ModelFacts;
use crate::resolved::ResolvedRunUps;
use crate::result::{PointStatus, RunUp, RunUpEnd, RunUpLeg, RunUps};
use rubmap_wheel::revision::VERSION;

impl RunUpEnd {
    /// Whether the run came to its end.
    pub fn is_complete(&self) -> bool {
        self.status == PointStatus::Completed
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
        passing: asked.limit.filter(|_| complete && rated).and_then(|limit| passing(limit, &runs)),
        runs,
        settings: asked.clone().into(),
        version: VERSION.to_owned(),
        vectors,
    })
}
