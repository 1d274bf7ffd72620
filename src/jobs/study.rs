//! Convergence study: its reductions and runs, then the results of all of them together.

use super::choice::facts;
use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::progress::PhaseMonitor;
use super::trials::Trials;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::study::WORK_PRECISION;
use crate::analysis::kinds::sweep::HISTORIES;
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::ResolvedStudy;
use crate::analysis::run;

/// Computes and stores a study.
pub(super) async fn run(engine: &Engine, job: &Live, request: &ResolvedStudy) -> Result<(), Interruption> {
    let facts = facts(engine, job).await?;
    let requests = request.all_trials(facts.sectors);
    let total = requests.len();
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let tell = |done: usize| {
        monitor.progress(done as f64 / total as f64, &format!("{done} of {total} runs finished"))
    };
    tell(0);
    let mut trials = Trials::default();
    trials.obtain(engine, job, requests.clone(), tell).await?;

    let sizes: Vec<u32> = requests.iter().map(|request| request.sweep().modes_per_speed()).collect();
    let mut reports = engine.store.reduction_reports(request.model()).await?;
    reports.retain(|report| sizes.contains(&report.modes_per_speed));
    let find = |request: &run::TrialRequest| trials.get(request);
    let Some((document, histories)) =
        run::work_precision(request, (facts.sectors, &facts.units), &reports, &find)
    else {
        return Err(Interruption::NotWanted);
    };
    let mut documents = vec![(WORK_PRECISION, serde_json::to_string(&document)?)];
    for (speed, histories) in (0..).zip(&histories) {
        documents.push((Document::part(HISTORIES, speed), serde_json::to_string(histories)?));
    }
    finish::complete(engine, job, &documents, None).await
}
