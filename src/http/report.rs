//! Reports: a job as one page.

use axum::extract::State;
use axum::http::header::CONTENT_SECURITY_POLICY;
use axum::response::{IntoResponse, Response};
use tokio::runtime::Handle;

use super::extract::{JobPath, Parameters};
use super::forms::READ_MEMORY;
use super::pictures::Pictures;
use super::problem::{Kind, Problem};
use super::results::{SensorQuery, check_sensor, expect_successful, find};
use super::spectra::ROW_MEMORY;
use super::state::AppState;
use super::stream;
use super::verdict::Judged;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::modal_analysis::{BACKBONES, CAMPBELL, MODAL_ANALYSIS};
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, ERRORS, HISTORIES, SWEEP};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{
    Backbones, Campbell, CriticalSpeeds, InteractionMap, SpeedHistories, SpeedSpectra,
};
use crate::analysis::run::{self, ModelFacts, VERSION};
use crate::kinds::JobKind;
use crate::plot::report::{self, Head, Sweep};
use crate::store::jobs::{Job, JobFilter, JobId};
use crate::store::status::JobStatus;
use crate::store::{Store, StoreError};
use crate::tokens::Principal;
use crate::version;

/// Content security policy of a report: nothing is loaded from anywhere; styles and images are in the page.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// Largest number of speeds whose histories are drawn.
const MOST_HISTORIES: usize = 3;

/// Memory of a row of a map, in multiples of its amplitudes: as read, and as it is drawn.
const MAP_MEMORY: u64 = 3;

/// Download a job as one page of HTML that needs nothing else, for a browser or for paper.
///
/// The page begins with a summary sheet of one side of A4: verdict, level of the wheel over speed, worst speeds, scene, credentials. Then come the request, warnings, credentials, the interaction map at one sensor, critical speeds at all of them, the largest
/// responses, contact forces, recorded histories of up to three speeds, pictures of up to two whose state was recorded, settings
/// and version; natural frequencies where a modal analysis of the same model was successful, of several the latest. A sweep that failed or was
/// dismissed has a page of its finished speeds, which says so in its title.
#[utoipa::path(get, path = "/v1/jobs/{id}/report", operation_id = "get_report", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep or of a modal analysis."), SensorQuery),
    responses(
        (status = 200, description = "The page.", body = String, content_type = "text/html"),
        (status = 409, description = "The job is neither a sweep nor a modal analysis, or it is not successful and has no page of finished speeds.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_report(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<SensorQuery>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    if !is_partial(&job) {
        expect_successful(&job, "the interaction map has the speeds that are done")?;
    }
    let (store, runtime) = (state.store.clone(), Handle::current());
    let (bytes, campbell) = match (job.request.get::<ResolvedSweep>(), &job.facts) {
        (Some(request), Some(_)) => {
            check_sensor(request.sensors(), query.sensor)?;
            let orders = request.max_engine_order() * request.window_revolutions();
            let map = u64::from(request.speeds().count()) * 8 * u64::from(orders);
            let row = ROW_MEMORY * state.store.largest_spectra(id).await?;
            (row + MAP_MEMORY * map, latest_modal_analysis(&state.store, &job).await?)
        }
        _ if job.kind == JobKind(&MODAL_ANALYSIS) => (0, Some(id)),
        _ => {
            let kind = job.kind.name;
            let detail = format!("a report is made of a sweep or a modal analysis; the job is a {kind}");
            return Err(Problem::new(Kind::WrongJobKind, detail));
        }
    };
    let drawn = match campbell {
        Some(of) => state.store.document_bytes(of, CAMPBELL).await?.unwrap_or(0),
        None => 0,
    };
    let mut histories = state.store.document_parts(id, HISTORIES).await?;
    histories.truncate(MOST_HISTORIES);
    let mut recorded = 0;
    for speed in &histories {
        let document = Document::part(HISTORIES, *speed);
        recorded += state.store.document_bytes(id, document).await?.unwrap_or(0);
    }
    let pictures = match (job.request.get(), &job.facts) {
        (Some(request), Some(facts)) => Pictures::find(&state, &job, request, facts).await?,
        _ => None,
    };
    let drawing = pictures.as_ref().map_or(0, |pictures| pictures.bytes);
    let leave = state.answers.leave(&state.jobs, bytes + READ_MEMORY * (drawn + recorded) + drawing).await;
    let page = stream::blocking(move || {
        let found = Found {
            job: &job,
            store: &store,
            runtime: &runtime,
            campbell,
            histories: &histories,
            pictures: pictures.as_ref(),
        };
        Ok::<_, StoreError>((found.page(query.sensor)?, leave))
    });
    let (page, leave) = page.await??;
    let page = stream::whole(leave, "text/html; charset=utf-8", page);
    Ok(([(CONTENT_SECURITY_POLICY, POLICY)], page).into_response())
}

/// Whether the job is a sweep that was cancelled or failed after some of its speeds were finished.
fn is_partial(job: &Job) -> bool {
    let was_stopped = matches!(job.status, JobStatus::Failed | JobStatus::Dismissed);
    was_stopped && job.kind == JobKind(&SWEEP) && job.speeds.finished > 0
}

/// Latest successful modal analysis of the job's model that the job's owner has.
async fn latest_modal_analysis(store: &Store, job: &Job) -> Result<Option<JobId>, StoreError> {
    let filter = JobFilter {
        owner: Some(job.owner.clone()),
        status: Some(JobStatus::Successful),
        kind: Some(JobKind(&MODAL_ANALYSIS)),
        model: job.request.models().first().map(|model| (*model).to_owned()),
        ..JobFilter::default()
    };
    Ok(store.jobs(filter, 1).await?.first().map(|job| job.id))
}

/// Sources of a report, which are read on a thread that may wait.
struct Found<'a> {
    job: &'a Job,
    store: &'a Store,
    runtime: &'a Handle,
    /// Job that computed the natural frequencies.
    campbell: Option<JobId>,
    /// Indices of the speeds whose histories are drawn.
    histories: &'a [u32],
    /// Pictures of recorded states.
    pictures: Option<&'a Pictures>,
}

impl Found<'_> {
    fn page(&self, sensor: u32) -> Result<String, StoreError> {
        let campbell = match self.campbell {
            Some(of) => self.document::<Campbell>(of, CAMPBELL)?,
            None => None,
        };
        let head = head(self.job, self.campbell.filter(|_| campbell.is_some()));
        match (self.job.request.get(), &self.job.facts, &campbell) {
            (Some(request), Some(facts), _) => {
                let map = self.map(request, facts, sensor as usize)?;
                let mut critical = Vec::new();
                for sensor in 0..request.sensors().len() as u32 {
                    critical.extend(
                        self.document::<CriticalSpeeds>(
                            self.job.id,
                            Document::part(CRITICAL_SPEEDS, sensor),
                        )?,
                    );
                }
                let row = |point: &_, contact: &_| run::force_row(point, contact);
                let rows = self.runtime.block_on(self.store.contacts(self.job.id, row))?;
                let forces = (!rows.is_empty()).then(|| run::force_map(request, &facts.units, rows));
                let mut histories = Vec::new();
                for speed in self.histories {
                    let document = Document::part(HISTORIES, *speed);
                    histories.extend(self.document::<SpeedHistories>(self.job.id, document)?);
                }
                let floors = (self.store, self.runtime);
                let pictures = self.pictures.map(|pictures| pictures.draw(floors, self.job, request, facts));
                let judged = self.runtime.block_on(Judged::read(self.store, self.job))?;
                let level = judged.ok_or(StoreError::Unseen)?.by(run::level);
                let found = Sweep {
                    level: &level,
                    map: &map,
                    critical: &critical,
                    forces: forces.as_ref(),
                    histories: &histories,
                    campbell: campbell.as_ref(),
                    strengths: &run::strengths_of_sweep(request, facts),
                    surfaces: pictures.as_deref().unwrap_or_default(),
                };
                Ok(report::sweep(&head, &found))
            }
            (_, _, Some(campbell)) => {
                let backbones = self.document::<Backbones>(self.job.id, BACKBONES)?;
                Ok(report::modal_analysis(&head, campbell, backbones.as_ref()))
            }
            // Deleted since it was found.
            _ => Err(StoreError::Unseen),
        }
    }

    /// Whole map at one sensor.
    fn map(
        &self,
        request: &ResolvedSweep,
        facts: &ModelFacts,
        sensor: usize,
    ) -> Result<InteractionMap, StoreError> {
        let id = self.job.id;
        let mut rows = Vec::new();
        for point in self.runtime.block_on(self.store.points(id))? {
            let row = |spectra: &SpeedSpectra| run::map_row(spectra, sensor, None).map(<[f64]>::to_vec);
            let row = self.runtime.block_on(self.store.map_row(id, point.index, row))?;
            rows.push((point, row));
        }
        let errors = self.document(id, ERRORS)?;
        let map = run::interaction_map(request, &facts.units, rows, sensor, None);
        Ok(InteractionMap { plan: self.job.plan.clone(), errors, ..map })
    }

    fn document<T: serde::de::DeserializeOwned>(
        &self,
        job: JobId,
        document: Document<'_>,
    ) -> Result<Option<T>, StoreError> {
        let text = self.runtime.block_on(self.store.document(job, document))?;
        Ok(text.map(|text| serde_json::from_str(&text)).transpose()?)
    }
}

/// Head of a report.
fn head(job: &Job, campbell: Option<JobId>) -> Head {
    let kind =
        if job.kind == JobKind(&MODAL_ANALYSIS) { "Modal analysis" } else { "Sweep of contact simulations" };
    let facts = job.facts.as_ref();
    let model = facts.map_or("", |facts| facts.name.as_str());
    let mut rows = vec![("job", format!("{kind} {}", job.id)), ("model", model.to_owned())];
    if let Some(facts) = facts {
        let ModelFacts { sectors, contact_nodes, own_dofs, units, .. } = facts;
        let size = format!(
            "{sectors} sectors of {own_dofs} DOF, {contact_nodes} contact nodes; lengths in {}, forces in {}",
            units.length, units.force
        );
        rows.push(("wheel", size));
    }
    rows.extend(
        job.request.models().first().map(|model| ("content of its package", format!("SHA-256 {model}"))),
    );
    if !job.labels.tags.is_empty() {
        rows.push(("tags", job.labels.tags.join(", ")));
    }
    let finished = job.finished_at.as_deref().unwrap_or("–");
    rows.push(("asked, finished", format!("{}, {finished}", job.created_at)));
    if let Some(of) = campbell.filter(|of| *of != job.id) {
        rows.push(("natural frequencies", format!("of modal analysis {of} of the same model")));
    }
    let vectors = job.vectors.as_deref().unwrap_or("unknown");
    let program =
        format!("rubmap {VERSION}, commit {}; computed on vectors of kind {vectors}", version::COMMIT);
    rows.push(("program", program));
    let mut title = job.labels.name.clone().unwrap_or_else(|| format!("{kind}: {model}"));
    if is_partial(job) {
        let how = if job.status == JobStatus::Failed { "failed" } else { "cancelled" };
        title = format!(
            "Unfinished ({how} after {} of {} speeds): {title}",
            job.speeds.finished, job.speeds.total
        );
    }
    Head { title, facts: rows, notes: job.labels.notes.clone() }
}
