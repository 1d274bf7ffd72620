//! Archive of a job: a file with all that is needed to repeat the job, and with its results.

pub mod manifest;
mod writer;

use std::fs::File;
use std::io::{self, BufWriter, Write};

use axum::extract::State;
use axum::response::Response;
use serde_json::value::RawValue;
use tokio::runtime::Handle;
use utoipa::ToSchema;

use self::manifest::{
    ArchivedJob, CHOICE, COMPARED_PACKAGE, Computed, FORMAT, MANIFEST, Manifest, PACKAGE, REQUEST, RESULTS,
    SETTINGS,
};
use self::writer::Writer;
use super::extract::JobPath;
use super::forms::{READ_MEMORY, TEXT_MEMORY};
use super::problem::{Kind, Problem};
use super::results::{expect_successful, find};
use super::spectra::ROW_MEMORY;
use super::state::AppState;
use super::stream;
use crate::analysis::kinds::kind::Units;
use crate::analysis::result::SpeedResult;
use crate::analysis::run::VERSION;
use crate::store::jobs::{Job, Posted};
use crate::store::results::StoredDocument;
use crate::store::{Store, StoreError};
use crate::tokens::Principal;
use crate::version;

/// Archive of a job, a zip file; docs/figures.md lists its entries.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "describes the body in the OpenAPI document only")]
pub(super) struct ArchiveZip(Vec<u8>);

/// Download a job as an archive, from which `rubmap repeat` computes it again and compares bit by bit.
///
/// The archive is a zip file of `request.json`, which starts the same computation when it is posted again; `settings.json`, the
/// settings as results repeat them; `package.zip`, the model byte by byte, and `compared-package.zip` where two are compared;
/// `results/`; and `manifest.json` with the SHA-256 of
/// every entry, the revision of the numerics and the kind of vectors of the processor that computed the job. The archive of a job
/// always has the same bytes. Histories of a sweep that has ended are repeated with that sweep, not by themselves.
#[utoipa::path(get, path = "/v1/jobs/{id}/archive", operation_id = "get_archive", tag = "results",
    params(("id" = String, Path, description = "Id of a job.")),
    responses(
        (status = 200, description = "The archive.", body = ArchiveZip, content_type = "application/zip"),
        (status = 409, description = "The job is not successful, its model is deleted, or an earlier version did not keep its request.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_archive(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    expect_successful(&job, "an archive is made of a job that was successful")?;
    let Some(posted) = job.posted.clone() else {
        let detail = "an earlier version accepted the job and did not keep its request, which would repeat it; the results are there one by one";
        return Err(Problem::new(Kind::ResultUnavailable, detail));
    };
    let mut models: Vec<String> = job.request.models().into_iter().map(ToOwned::to_owned).collect();
    if models.is_empty() {
        // A job that computes from no model has made one.
        models.extend(job.model.clone());
    }
    let mut packages = Vec::new();
    for (model, name) in models.iter().zip([PACKAGE, COMPARED_PACKAGE]) {
        // A file that is open stays readable when its model is deleted.
        let package = match state.store.model(model, Some(&job.owner)).await? {
            Some(_) => tokio::fs::File::open(state.store.package(model).await?).await?.into_std().await,
            None => {
                let detail = "its model is deleted, and without it nobody can repeat the job; the results are there one by one";
                return Err(Problem::new(Kind::ResultUnavailable, detail));
            }
        };
        packages.push((name, package));
    }
    let documents = state.store.documents(id).await?;
    let rows = ROW_MEMORY * state.store.largest_spectra(id).await?;
    let mut bytes = rows.max(READ_MEMORY * state.store.points_bytes(id).await?);
    for document in &documents {
        bytes =
            bytes.max(TEXT_MEMORY * state.store.document_bytes(id, document.document()).await?.unwrap_or(0));
    }
    let leave = state.answers.leave(&state.jobs, bytes).await;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let model = models.into_iter().next().unwrap_or_default();
    let contents = Contents { job, model, posted, packages, documents, store, runtime };
    Ok(stream::zip(leave, &format!("rubmap-{id}.zip"), move |mut out| contents.write(&mut out)))
}

/// Contents of an archive.
struct Contents {
    job: Job,
    model: String,
    posted: Posted,
    /// Packages of its models, by the names of their entries.
    packages: Vec<(&'static str, File)>,
    documents: Vec<StoredDocument>,
    store: Store,
    runtime: Handle,
}

impl Contents {
    /// Writes the archive, reading the results one by one.
    fn write(mut self, out: &mut impl Write) -> io::Result<()> {
        let mut zip = Writer::new(BufWriter::new(out));
        // With defaults and chosen settings filled in, where that can be posted: the same job whatever a later program would choose.
        let request = self.job.request.as_posted()?.unwrap_or_else(|| self.posted.body.clone());
        zip.json(REQUEST, 0, &RawValue::from_string(request)?)?;
        zip.json(SETTINGS, 0, &RawValue::from_string(self.job.request.text()?)?)?;
        if let Some(choice) = &self.job.choice {
            zip.json(CHOICE, 0, choice)?;
        }
        for (name, package) in &mut self.packages {
            let bytes = package.metadata()?.len();
            zip.add(name, bytes, |out| io::copy(package, out).map(drop))?;
        }
        if self.job.kind.units == Units::Speeds {
            self.write_speeds(&mut zip)?;
        }
        for document in &self.documents {
            let StoredDocument { name, part } = document;
            let body = self.read(self.store.document(self.job.id, document.document()))?;
            let name = format!("{RESULTS}{}/{part}.json", name.replace('_', "-"));
            zip.add(&name, body.len() as u64, |out| out.write_all(body.as_bytes()))?;
        }
        let manifest = self.manifest(&zip);
        zip.json(MANIFEST, 0, &manifest)?;
        zip.finish()
    }

    fn write_speeds<W: Write>(&self, zip: &mut Writer<W>) -> io::Result<()> {
        let points = self.runtime.block_on(self.store.points(self.job.id)).map_err(io::Error::other)?;
        zip.json(&format!("{RESULTS}points.json"), 0, &points)?;
        for point in points {
            let index = point.index;
            let SpeedResult { spectra, wear, contact, .. } =
                self.read(self.store.speed_result(self.job.id, index))?;
            if let Some(spectra) = spectra {
                zip.json(&format!("{RESULTS}spectra/{index:05}.json"), 0, &spectra)?;
            }
            if let Some(wear) = wear {
                zip.json(&format!("{RESULTS}wear/{index:05}.json"), 0, &wear)?;
            }
            if let Some(contact) = contact {
                zip.json(&format!("{RESULTS}contact/{index:05}.json"), 0, &contact)?;
            }
        }
        Ok(())
    }

    /// Waits for an answer of the store; fails if the job was deleted meanwhile, which leaves no archive.
    fn read<T>(&self, question: impl Future<Output = Result<Option<T>, StoreError>>) -> io::Result<T> {
        let answer = self.runtime.block_on(question).map_err(io::Error::other)?;
        answer.ok_or_else(|| io::Error::other("a result is gone: the job was deleted"))
    }

    fn manifest<W: Write>(&self, zip: &Writer<W>) -> Manifest {
        let Job { head, revision, vectors, .. } = &self.job;
        Manifest {
            format: FORMAT,
            job: ArchivedJob {
                id: head.id.to_string(),
                kind: head.kind,
                posted_to: self.posted.to.clone(),
                model: self.model.clone(),
                created_at: head.created_at.clone(),
                finished_at: head.finished_at.clone(),
            },
            computed: Computed {
                revision: *revision,
                vectors: vectors.clone(),
                version: VERSION.to_owned(),
                commit: version::COMMIT.to_owned(),
                target: version::TARGET.to_owned(),
            },
            entries: zip.entries().to_vec(),
        }
    }
}
