//! Pictures of a report: the wheel at the instant of the largest tip displacement, at speeds whose states were recorded.

use tokio::runtime::Handle;

use super::field::{ViewWord, read_states};
use super::fields::recorded_speeds;
use super::forms::READ_MEMORY;
use super::problem::Problem;
use super::state::AppState;
use crate::analysis::fields::{FieldSector, Part, instants, largest_instant, surface};
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::STATES;
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::FieldSurface;
use crate::analysis::run::ModelFacts;
use crate::jobs::FieldSource;
use crate::plot::SurfaceView;
use crate::store::jobs::Job;
use crate::store::{Store, StoreError};

/// Largest number of speeds with pictures.
const MOST: usize = 2;

/// Source of the pictures of a report.
#[derive(Debug)]
pub(super) struct Pictures {
    source: FieldSource,
    /// Indices of the speeds that have pictures.
    speeds: Vec<u32>,
    /// Memory that the pictures take while they are made, bytes.
    pub(super) bytes: u64,
}

impl Pictures {
    /// Finds the first speeds of a sweep with states; `None` if there are none, or the model has no mesh or reduction.
    pub(super) async fn find(
        state: &AppState,
        job: &Job,
        sweep: &ResolvedSweep,
        facts: &ModelFacts,
    ) -> Result<Option<Self>, StoreError> {
        if facts.mesh.is_none() {
            return Ok(None);
        }
        let recorded = recorded_speeds(&state.store, job.id).await?;
        let speeds: Vec<u32> = recorded.into_iter().take(MOST).collect();
        if speeds.is_empty() {
            return Ok(None);
        }
        let source = state.jobs.field_source(sweep.model(), sweep.modes_per_speed()).await?;
        let Some(source) = source else { return Ok(None) };
        let mut largest = 0;
        for &speed in &speeds {
            let bytes = state.store.document_bytes(job.id, Document::part(STATES, speed)).await?;
            largest = largest.max(bytes.unwrap_or(0));
        }
        let bytes = READ_MEMORY * largest + source.memory(facts.own_dofs, 1);
        Ok(Some(Self { source, speeds, bytes }))
    }

    /// Draws the skin of the whole wheel at every speed. A picture that cannot be made any more is left out of the report, and logged.
    pub(super) fn draw(
        &self,
        (store, runtime): (&Store, &Handle),
        job: &Job,
        sweep: &ResolvedSweep,
        facts: &ModelFacts,
    ) -> Vec<(FieldSurface, SurfaceView)> {
        let left_out = |speed: Option<u32>, problem: &Problem| {
            tracing::warn!(job.id = %job.id, speed, detail = problem.detail, "left a picture out of a report");
        };
        let sector = match self.source.sector(true, sweep.stress_outside()).map_err(Box::new) {
            Ok(sector) => sector,
            Err(error) => {
                left_out(None, &error.into());
                return Vec::new();
            }
        };
        let front = ViewWord::Front.of(&self.source);
        let drawn =
            |&speed: &u32| match self.draw_one((store, runtime), (job, sweep), speed, (&sector, facts)) {
                Ok(surface) => surface.map(|surface| (surface, front)),
                Err(problem) => {
                    left_out(Some(speed), &problem);
                    None
                }
            };
        self.speeds.iter().filter_map(drawn).collect()
    }

    fn draw_one(
        &self,
        (store, runtime): (&Store, &Handle),
        (job, sweep): (&Job, &ResolvedSweep),
        speed: u32,
        (sector, facts): (&FieldSector, &ModelFacts),
    ) -> Result<Option<FieldSurface>, Problem> {
        let states = read_states((store, runtime), job.id, Document::part(STATES, speed), &self.source)?;
        let field = self.source.with_basis(|wheel, basis| {
            let at = largest_instant(&states, wheel).unwrap_or(0);
            instants(&states, sector, &[at], basis)
        })?;
        let speed_rad_s = sweep.speeds().rad_s().get(speed as usize).copied().unwrap_or_default();
        let field = field.at_speed(speed_rad_s).upon(sector, None);
        Ok(surface(&field, sector, Part::Wheel, 0, &facts.units))
    }
}
