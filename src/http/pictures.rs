//! Pictures of a report: the wheel when a tip had moved most, at speeds whose states were recorded.

use std::f64::consts::TAU;

use tokio::runtime::Handle;

use super::field::ViewWord;
use super::forms::READ_MEMORY;
use super::problem::Problem;
use super::state::AppState;
use crate::analysis::fields::{Part, instants, largest_instant, surface};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::FieldSurface;
use crate::analysis::run::ModelFacts;
use crate::jobs::FieldSource;
use crate::plot::SurfaceView;
use crate::store::jobs::Job;
use crate::store::results::Document;
use crate::store::{Store, StoreError, states};

/// Most speeds of which there are pictures.
const MOST: usize = 2;

/// What they are drawn from.
#[derive(Debug)]
pub(super) struct Pictures {
    source: FieldSource,
    /// Index of each speed.
    speeds: Vec<u32>,
    /// Memory while they are made.
    pub(super) bytes: u64,
}

impl Pictures {
    /// Of the first speeds of a sweep with states; none without any, or of a model without mesh or reduction.
    pub(super) async fn find(
        state: &AppState,
        job: &Job,
        sweep: &ResolvedSweep,
        facts: &ModelFacts,
    ) -> Result<Option<Self>, StoreError> {
        if facts.mesh.is_none() {
            return Ok(None);
        }
        let of_states = |document| match document {
            Document::States(speed) => Some(speed),
            _ => None,
        };
        let recorded = state.store.documents(job.id).await?;
        let speeds: Vec<u32> = recorded.into_iter().filter_map(of_states).take(MOST).collect();
        if speeds.is_empty() {
            return Ok(None);
        }
        let source = state.jobs.field_source(sweep.model(), sweep.modes_per_speed()).await?;
        let Some(source) = source else { return Ok(None) };
        let mut largest = 0;
        for &speed in &speeds {
            let bytes = state.store.document_bytes(job.id, Document::States(speed)).await?;
            largest = largest.max(bytes.unwrap_or(0));
        }
        let bytes = READ_MEMORY * largest + source.memory(facts.own_dofs, 1);
        Ok(Some(Self { source, speeds, bytes }))
    }

    /// The skin of the whole wheel at every speed. What cannot be read any more is left out of a report, and logged.
    pub(super) fn draw(
        &self,
        (store, runtime): (&Store, &Handle),
        job: &Job,
        sweep: &ResolvedSweep,
        facts: &ModelFacts,
    ) -> Vec<(FieldSurface, SurfaceView)> {
        let front = ViewWord::Front.of(&self.source);
        let drawn = |&speed: &u32| match self.draw_one((store, runtime), job, speed, facts) {
            Ok(surface) => surface.map(|mut surface| {
                let rad_s = sweep.speeds().rad_s().get(speed as usize).copied().unwrap_or_default();
                surface.title = format!("{:.0} rpm, {}", 60.0 * rad_s / TAU, surface.title);
                (surface, front)
            }),
            Err(problem) => {
                tracing::warn!(job.id = %job.id, speed, detail = problem.detail, "left a picture out of a report");
                None
            }
        };
        self.speeds.iter().filter_map(drawn).collect()
    }

    fn draw_one(
        &self,
        (store, runtime): (&Store, &Handle),
        job: &Job,
        speed: u32,
        facts: &ModelFacts,
    ) -> Result<Option<FieldSurface>, Problem> {
        let text = runtime.block_on(store.document(job.id, Document::States(speed)))?.unwrap_or_default();
        let states = states::unpack(&text, &self.source.reduced().wheel)?;
        drop(text);
        let sector = self.source.sector(true).map_err(Box::new)?;
        let field = self.source.with_basis(|wheel, basis| {
            let at = largest_instant(&states, wheel).unwrap_or(0);
            instants(&states, &sector, &[at], basis)
        })?;
        Ok(surface(&field, &sector, Part::Wheel, 0, &facts.units))
    }
}
