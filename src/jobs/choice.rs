//! Settings that the service chooses for a job, once its pilot runs or reductions are there.

use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use chrono::{DateTime, Utc};

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::trials::Trials;
use crate::analysis::error::{AnalysisError, Violation};
use crate::analysis::kinds::kind::{ResolvedJob, ToChoose};
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::{Aim, Modes, ResolvedModalAnalysis, ResolvedSweep};
use crate::analysis::result::Chosen;
use crate::analysis::run::{self, Choice, ModelFacts, ModesChoice, Next, NextModes, Resources};
use crate::store::StoreError;
use crate::store::jobs::FailureCause;

/// Chooses the settings that the job leaves open and returns the job with them; returns the job as it is where nothing is left to choose.
pub(super) async fn made(engine: &Engine, job: Arc<Live>) -> Result<Arc<Live>, Interruption> {
    match job.request.choice() {
        Some(ToChoose::Setting(request)) => of_sweep(engine, &job, request).await,
        Some(ToChoose::Modes(request)) => of_modal_analysis(engine, &job, request).await,
        None => Ok(job),
    }
}

/// Choice for the settings that `job` leaves open, if the runs or reductions that it rests on are stored, and the job with it.
pub(super) async fn stored(
    engine: &Engine,
    job: &dyn ResolvedJob,
    sectors: u32,
) -> Result<Result<Option<(Chosen, Arc<dyn ResolvedJob>)>, Violation>, StoreError> {
    Ok(match job.choice() {
        Some(ToChoose::Setting(sweep)) => stored_setting(engine, sweep, sectors).await?.map(|choice| {
            choice.map(|choice| {
                let explicit = choice.explicit(sweep);
                (Chosen::Setting(choice), Arc::new(explicit) as Arc<dyn ResolvedJob>)
            })
        }),
        Some(ToChoose::Modes(analysis)) => stored_modes(engine, analysis).await?.map(|choice| {
            choice.map(|choice| {
                let explicit = choice.explicit(analysis);
                (Chosen::Modes(choice), Arc::new(explicit) as Arc<dyn ResolvedJob>)
            })
        }),
        None => Ok(None),
    })
}

/// Chooses the settings of a sweep by pilot runs.
async fn of_sweep(engine: &Engine, job: &Live, request: &ResolvedSweep) -> Result<Arc<Live>, Interruption> {
    let (facts, begin) = begun(engine, job).await?;
    let choosing = setting(engine, job, request, (facts.sectors, begin));
    let choice = in_time(job, request.modes(), begin, choosing).await?;
    tracing::info!(
        job.id = %job.id, setting = ?choice.setting, estimated_error = choice.estimated_error, "chose a setting"
    );
    let chosen = choice.explicit(request);
    // These settings have not been checked yet.
    let chosen = run::resolve_sweep(chosen.into(), &facts).map_err(AnalysisError::Refused)?;
    engine.choose(job, Arc::new(chosen), Chosen::Setting(choice)).await
}

/// Chooses, by pilot runs, the setting for a wheel of `sectors`.
async fn setting(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    (sectors, begin): (u32, DateTime<Utc>),
) -> Result<Choice, Interruption> {
    let (mut trials, mut most_modes) = (Trials::default(), None);
    loop {
        let resources = resources(engine, request.model(), seconds_since(begin), most_modes).await?;
        let runs = match run::next(request, sectors, &resources, &|trial| trials.get(trial)) {
            Next::Take(choice) => return Ok(*choice),
            Next::Refuse(violation) => return Err(AnalysisError::Refused(vec![violation]).into()),
            Next::Run(runs) => runs,
        };
        let Some(first) = runs.first() else { return Err(Interruption::NotWanted) };
        let (modes, total) = (first.sweep().modes_per_speed(), runs.len());
        let monitor = PhaseMonitor::uncounted(job.watch.clone());
        let tell = |done| {
            monitor.progress(0.0, &format!("pilot runs with {modes} modes per speed: {done} of {total}"))
        };
        tell(0);
        match trials.obtain(engine, job, runs, tell).await {
            Err(Interruption::Failed(failure)) if failure.cause == FailureCause::Memory => {
                most_modes = Some(largest_below(modes, &resources).ok_or(Interruption::Failed(failure))?);
            }
            outcome => outcome?,
        }
    }
}

/// Waits for `choosing` for the time that an accuracy allows from `begin` on, and returns its outcome. When the time is over, what
/// still computes for it is stopped and waited for: whoever asks again finds what it stored.
async fn in_time<T>(
    job: &Live,
    modes: Modes,
    begin: DateTime<Utc>,
    choosing: impl Future<Output = Result<T, Interruption>>,
) -> Result<T, Interruption> {
    let Modes::Sought(Aim::Accuracy(accuracy)) = modes else { return choosing.await };
    let left = Duration::try_from_secs_f64(accuracy.seconds - seconds_since(begin)).unwrap_or_default();
    let mut choosing = pin!(choosing);
    if let Ok(outcome) = tokio::time::timeout(left, choosing.as_mut()).await {
        return outcome;
    }
    job.watch.dismiss();
    // The dismissed choice returns an error, which is expected.
    let _ = choosing.await;
    let message = format!(
        "nothing was found within {} s that is known to be as accurate: ask for a larger target, or give more time; the next job with \
         the same scene goes on from what this one has computed",
        accuracy.seconds
    );
    Err(AnalysisError::Refused(vec![Violation::new("/accuracy/seconds", message)]).into())
}

/// Choice for a resolved sweep, if all that it rests on is stored.
async fn stored_setting(
    engine: &Engine,
    request: &ResolvedSweep,
    sectors: u32,
) -> Result<Result<Option<Choice>, Violation>, StoreError> {
    let resources = resources(engine, request.model(), 0.0, None).await?;
    let mut trials = Trials::default();
    loop {
        match run::next(request, sectors, &resources, &|trial| trials.get(trial)) {
            Next::Take(choice) => return Ok(Ok(Some(*choice))),
            Next::Refuse(violation) => return Ok(Err(violation)),
            Next::Run(runs) => {
                if !trials.recall(engine, &runs).await? {
                    return Ok(Ok(None));
                }
            }
        }
    }
}

/// Chooses the modes of a modal analysis by its reductions.
async fn of_modal_analysis(
    engine: &Engine,
    job: &Live,
    request: &ResolvedModalAnalysis,
) -> Result<Arc<Live>, Interruption> {
    let (_, begin) = begun(engine, job).await?;
    let choosing = modes(engine, job, request, begin);
    let choice = in_time(job, request.modes(), begin, choosing).await?;
    let chosen = Arc::new(choice.explicit(request));
    engine.choose(job, chosen, Chosen::Modes(choice)).await
}

/// Chooses the modes of a modal analysis by reductions.
async fn modes(
    engine: &Engine,
    job: &Live,
    request: &ResolvedModalAnalysis,
    begin: DateTime<Utc>,
) -> Result<ModesChoice, Interruption> {
    let mut most_modes = None;
    let mut reports = engine.store.reduction_reports(request.model()).await?;
    loop {
        let resources = resources(engine, request.model(), seconds_since(begin), most_modes).await?;
        let modes = match run::next_modes(request, &resources, &reports) {
            NextModes::Take(choice) => return Ok(choice),
            NextModes::Refuse(violation) => return Err(AnalysisError::Refused(vec![violation]).into()),
            NextModes::Reduce(modes) => modes,
        };
        let monitor = PhaseMonitor::uncounted(job.watch.clone());
        // Who needs rows of a basis needs those of the choice.
        let left_out = request.fields().filter(|wanted| !wanted);
        match engine.reductions.get((request.model(), modes), left_out, monitor).await {
            Err(Interruption::Failed(failure)) if failure.cause == FailureCause::Memory => {
                most_modes = Some(largest_below(modes, &resources).ok_or(Interruption::Failed(failure))?);
            }
            outcome => reports.push(outcome?.report.clone()),
        }
    }
}

/// Choice of modes for a resolved modal analysis, if the reductions that it rests on are stored.
async fn stored_modes(
    engine: &Engine,
    request: &ResolvedModalAnalysis,
) -> Result<Result<Option<ModesChoice>, Violation>, StoreError> {
    let resources = resources(engine, request.model(), 0.0, None).await?;
    let reports = engine.store.reduction_reports(request.model()).await?;
    Ok(match run::next_modes(request, &resources, &reports) {
        NextModes::Take(choice) => Ok(Some(choice)),
        NextModes::Refuse(violation) => Err(violation),
        NextModes::Reduce(_) => Ok(None),
    })
}

/// Facts of the model that `job` computes from, and time at which the job began.
async fn begun(engine: &Engine, job: &Live) -> Result<(ModelFacts, DateTime<Utc>), Interruption> {
    let stored = engine.store.job(job.id).await?.ok_or(Interruption::NotWanted)?;
    let begin = stored.started_at.as_deref().and_then(|time| DateTime::parse_from_rfc3339(time).ok());
    let begin = begin.map_or_else(Utc::now, |time| time.with_timezone(&Utc));
    Ok((stored.facts.ok_or(Interruption::NotWanted)?, begin))
}

/// Seconds since `begin` by the clock on the wall: what was spent before the service was stopped counts, and so does the pause.
fn seconds_since(begin: DateTime<Utc>) -> f64 {
    (Utc::now() - begin).as_seconds_f64().max(0.0)
}

/// Facts of the model that `job` computes from.
pub(super) async fn facts(engine: &Engine, job: &Live) -> Result<ModelFacts, Interruption> {
    Ok(begun(engine, job).await?.0)
}

/// Number of modes of the largest stored reduction that has fewer than `modes`.
fn largest_below(modes: u32, resources: &Resources) -> Option<u32> {
    resources.reductions.iter().map(|&(k, _)| k).filter(|&k| k < modes).max()
}

async fn resources(
    engine: &Engine,
    model: &str,
    spent_s: f64,
    most_modes: Option<u32>,
) -> Result<Resources, StoreError> {
    let reports = engine.store.reduction_reports(model).await?;
    let reductions = reports.iter().map(|report| (report.modes_per_speed, report.wall_time_s)).collect();
    Ok(Resources { workers: engine.computing.threads(), spent_s, reductions, most_modes })
}
