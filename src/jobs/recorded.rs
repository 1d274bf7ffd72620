//! Jobs of which everything is recorded.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::{finish, histories};
use crate::analysis::resolved::ResolvedCaseStudy;

/// Computes and stores the job.
pub(super) async fn run(engine: &Engine, job: &Live, case: &ResolvedCaseStudy) -> Result<(), Interruption> {
    histories::record(engine, job, case, true, PhaseMonitor::whole(job.watch.clone())).await?;
    finish::complete(engine, job, &[], None).await
}
