//! Jobs that are computed leg by leg, each leg stored with all that the next one needs: branches and run-ups.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::patience::patiently;
use crate::analysis::error::AnalysisError;
use crate::analysis::result::{BranchLeg, PointStatus, RunUpLeg};
use crate::store::Followed;

/// Leg of a job, as it is stored.
pub(super) trait Leg: Serialize {
    /// Text stored beside the leg, if any.
    fn beside(&self) -> Result<Option<String>, serde_json::Error> {
        Ok(None)
    }

    /// Status with which the run ended, if this is its last leg.
    fn ended(&self) -> Option<PointStatus> {
        None
    }
}

impl Leg for BranchLeg {}

impl Leg for RunUpLeg {
    fn beside(&self) -> Result<Option<String>, serde_json::Error> {
        serde_json::to_string(&self.spectra()).map(Some)
    }

    fn ended(&self) -> Option<PointStatus> {
        self.status()
    }
}

/// Follows a job to its end from where it was left; `further` computes the next leg from a course, and the course after it.
pub(super) async fn follow<L, C, F>(
    engine: &Engine,
    job: &Live,
    followed: Followed,
    further: F,
) -> Result<(), Interruption>
where
    L: Leg + Send + 'static,
    C: Serialize + DeserializeOwned + Send + 'static,
    F: Fn(Option<C>) -> Result<(L, Option<C>), AnalysisError> + Clone + Send + 'static,
{
    let mut legs = engine.store.legs(job.id, followed).await?;
    let mut course: Option<C> = match engine.store.document(job.id, followed.course()).await? {
        Some(text) => Some(serde_json::from_str(&text)?),
        None => None,
    };
    while legs == 0 || course.is_some() {
        let (from, further) = (course.take(), further.clone());
        let (leg, next) = engine.computing.run(&job.watch, move || further(from)).await??;
        let (text, beside) = (serde_json::to_string(&leg)?, leg.beside()?);
        let rest = next.as_ref().map(serde_json::to_string).transpose()?;
        let kept = (text.as_str(), beside.as_deref());
        patiently(&job.watch, || {
            engine.store.keep_leg(job.id, (followed, legs), kept, leg.ended(), rest.as_deref())
        })
        .await?;
        engine.computing.acquit(job.id);
        legs += 1;
        course = next;
    }
    finish::complete(engine, job, &[], None).await
}
