//! Speeds of a finished sweep that are simulated again at a finer setting.

use super::choice::facts;
use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::trials::Trials;
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{Chosen, Point};
use crate::analysis::run::{self, ErrorEstimate, FinerRun};
use crate::store::jobs::FailureCause;

/// Estimated errors of all speeds of a sweep, if any speeds are to be simulated again.
pub(super) async fn errors(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    points: &[Point],
) -> Result<Option<ErrorEstimate>, Interruption> {
    if request.control_speeds() == 0 {
        return Ok(None);
    }
    let sectors = facts(engine, job).await?.sectors;
    let mut trials = Trials::default();
    let mut controls = run::control_requests(request, sectors, points, None);
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let total = controls.len();
    let tell = |done| monitor.progress(0.0, &format!("control runs: {done} of {total}"));
    tell(0);
    let requests = |controls: &[(u32, _, run::TrialRequest)]| controls.iter().map(|c| c.2.clone()).collect();
    match trials.obtain(engine, job, requests(&controls), tell).await {
        Err(Interruption::Failed(failure)) if failure.cause == FailureCause::Memory => {
            // There is no memory for more modes: then there are more steps alone, and the settings say so.
            controls = run::control_requests(request, sectors, points, Some(request.modes_per_speed()));
            trials.obtain(engine, job, requests(&controls), tell).await?;
        }
        outcome => outcome?,
    }
    let mut spectra = Vec::new();
    for (index, ..) in &controls {
        spectra.push(engine.store.speed_result(job.id, *index).await?.and_then(|result| result.spectra));
    }
    let finer: Vec<FinerRun> = controls
        .iter()
        .zip(&spectra)
        .filter_map(|((index, setting, request), spectra)| {
            let (spectra, trial) = (spectra.as_ref()?, trials.get(request)?);
            Some(FinerRun { index: *index, setting: *setting, spectra, trial })
        })
        .collect();
    let choice = engine.store.job(job.id).await?.and_then(|job| job.choice);
    let accuracy = match choice {
        Some(Chosen::Setting(choice)) => choice.accuracy,
        Some(Chosen::Modes(_)) | None => None,
    };
    Ok(Some(run::error_estimate(request, accuracy, points, &finer)))
}
