//! Models: upload, list, read, delete.

use axum::Json;
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::uri::PathAndQuery;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use sha2::Digest;
use utoipa::{IntoParams, ToSchema};

use super::extract::{MergePatch, ModelPath, Parameters, declared_bytes, expect_media_type, is_media_type};
use super::idempotency::{self, IdempotencyKey};
use super::kinds::{self, Receipt, ReceivedRequest};
use super::labels::{LabelPatch, LabelQuery};
use super::page;
use super::problem::{Kind, Problem, excerpt};
use super::state::AppState;
use crate::analysis::result::ReductionReport;
use crate::analysis::run::ModelFacts;
use crate::from_mesh::MeshSettings;
use crate::impeller::ImpellerRequest;
use crate::import::{CheckedPackage, Upload};
use crate::kinds::generation::MODEL_GENERATION;
use crate::store::idempotency::Answer;
use crate::store::labels::Labels;
use crate::store::models::{Deletion, ModelFilter, StoredModel};
use crate::tokens::Principal;

const JSON: &str = "application/json";
/// Media type of a bare mesh.
pub(super) const MESH: &str = "application/octet-stream";

/// Model with its facts and labels.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ModelBody {
    /// Digest of the package's content: the same content is the same model, however it was zipped.
    #[schema(example = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08")]
    id: String,
    /// Facts of the model; its `name` is that of the package, unless its owner gave it another.
    #[serde(flatten)]
    facts: ModelFacts,
    /// Words to group the model by.
    tags: Vec<String>,
    /// Notes of the owner.
    #[serde(skip_serializing_if = "Option::is_none")]
    notes: Option<String>,
    /// Size of the zip as uploaded, bytes.
    size_bytes: u64,
    /// Time at which the model was first uploaded (RFC 3339).
    created_at: String,
}

/// Model with the reports of its reductions.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ModelDetail {
    #[serde(flatten)]
    model: ModelBody,
    /// Reports of the reductions made so far: residuals, sizes, and how far K(Ω) can be trusted between the given speeds.
    reductions: Vec<ReductionReport>,
}

/// Filters of a list of models, and its page.
#[derive(Debug, Serialize, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct ModelQuery {
    /// Text in the names of the models to list; letters a to z may be capitals or not.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Tag of the models to list.
    #[serde(skip_serializing_if = "Option::is_none")]
    tag: Option<String>,
    /// Models per page, 1 to 500; default 50.
    #[param(minimum = 1, maximum = 500)]
    limit: Option<u32>,
    /// Cursor at which the page begins: from `next` of the page before.
    cursor: Option<String>,
}

/// Page of a list of models.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ModelList {
    /// Models of the page, newest first.
    models: Vec<ModelBody>,
    /// Path of the next page; absent on the last.
    #[serde(skip_serializing_if = "Option::is_none")]
    next: Option<String>,
}

/// Package of a model: a zip file as docs/package.md describes it.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "describes the body in the OpenAPI document only")]
pub(super) struct PackageZip(Vec<u8>);

/// Mesh of one sector: CalculiX or Abaqus (.inp), Gmsh (.msh), Nastran (.bdf), Ansys (.cdb) or VTK (.vtu).
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "describes the body in the OpenAPI document only")]
pub(super) struct MeshBytes(Vec<u8>);

impl From<StoredModel> for ModelBody {
    fn from(model: StoredModel) -> Self {
        let StoredModel { id, facts, labels, size_bytes, created_at, .. } = model;
        let Labels { name, tags, notes } = labels;
        let facts = ModelFacts { name: name.unwrap_or(facts.name.clone()), ..facts };
        Self { id, facts, tags, notes, size_bytes, created_at }
    }
}

/// Upload a model package, or start a job that generates an impeller from parameters.
///
/// A package (`application/zip`) is checked completely before it is stored. A package whose content is known already, whatever its
/// name and compression, is not stored twice.
///
/// A mesh of one sector becomes a model, too: in a package whose `sector.json` has `mesh_file` and the other fields of `MeshSettings` instead
/// of matrices, or bare (`application/octet-stream`) with the settings in the query. Its matrices are assembled here; `found` of the model lists
/// what was found in the mesh.
///
/// Parameters of the generator (`application/json`; the preset supplies those that are left out) become a job of kind
/// `model_generation`. When it is successful its `model` is the id of the model, which is that of an uploaded package with the same
/// content.
///
/// Labels of the model are given in the query of a package, and beside the parameters of the generator, where they are also those
/// of the job. A model that is known keeps its labels; `PATCH` changes them.
#[utoipa::path(post, path = "/v1/models", operation_id = "create_model", tag = "models",
    params(LabelQuery, ("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer.")),
    request_body(description = "The model package, one impeller sector; its bare mesh; or parameters of the generator.", content(
        (PackageZip = "application/zip"),
        (MeshBytes = "application/octet-stream"),
        (ImpellerRequest = "application/json"),
    )),
    responses(
        (status = 201, description = "The model is new.", body = ModelBody,
            headers(("Location" = String, description = "Path of the model."))),
        (status = 200, description = "The model is known.", body = ModelBody,
            headers(("Location" = String, description = "Path of the model."))),
        (status = 202, description = "The generation is accepted.", body = Receipt,
            headers(("Location" = String, description = "Path of the job."))),
        (status = 400, description = "The body is not JSON, or the upload broke off.", body = Problem,
            content_type = "application/problem+json"),
        (status = 408, description = "The upload stopped coming.", body = Problem,
            content_type = "application/problem+json"),
        (status = 413, description = "The upload is larger than the service allows.", body = Problem,
            content_type = "application/problem+json"),
        (status = 415, description = "The body is declared as none of application/zip, \
            application/octet-stream and application/json.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "The package is not valid, `errors` names file and line or field; or a parameter \
            is not, `errors` points at it. Or the idempotency key belongs to another request.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn create_model(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    Parameters(query): Parameters<LabelQuery>,
    request: Request,
) -> Result<Response, Problem> {
    expect_media_type(request.headers(), &["application/zip", "application/x-zip-compressed", MESH, JSON])?;
    if is_media_type(request.headers(), JSON) {
        if !query.is_empty() {
            let detail = "beside parameters of the generator name, tags and notes are fields of the body";
            return Err(Problem::new(Kind::InvalidParameter, detail));
        }
        let received = ReceivedRequest::read(&state, &MODEL_GENERATION, request).await?;
        return kinds::accept(&state, &whose, key, received).await;
    }
    let importer = &state.importer;
    importer.check_size(declared_bytes(request.headers()))?;
    let settings = mesh_settings(&query, is_media_type(request.headers(), MESH))?;
    let labels = query.labels()?;
    let path = request.uri().path_and_query().map_or("", PathAndQuery::as_str);
    let mut digest = idempotency::start(path);
    let pieces = request.into_body().into_data_stream();
    let upload = importer.receive(pieces, |piece| digest.update(piece)).await?;
    let fingerprint = idempotency::finish(digest);
    if let Some(response) = key.replay(&state.store, &whose, &fingerprint).await? {
        return Ok(response);
    }
    let upload = match settings {
        Some(settings) => Upload::Mesh(upload, Box::new(settings)),
        None => Upload::Package(upload),
    };
    let package = importer.check(upload).await??;
    let (model, new) = importer.store(&whose.owner, state.limits, &labels, &package).await??;
    let CheckedPackage { facts, id, .. } = &package;
    tracing::info!(model.id = id, name = facts.name, new, "received a model");
    let answer = Answer {
        owner: whose.owner.clone(),
        key: String::new(),
        fingerprint: String::new(),
        status: if new { StatusCode::CREATED } else { StatusCode::OK }.as_u16(),
        location: format!("/v1/models/{id}"),
        body: serde_json::to_string(&ModelBody::from(model))?,
    };
    if let Some(kept) = key.answer(&fingerprint, &answer) {
        state.store.insert_answer(&kept).await?;
    }
    Ok(idempotency::respond(&answer))
}

/// Settings of a bare mesh, which its upload needs and no other has.
fn mesh_settings(query: &LabelQuery, is_mesh: bool) -> Result<Option<MeshSettings>, Problem> {
    let wrong = |message: String| Problem::parameter("settings", message);
    match (&query.settings, is_mesh) {
        (None, false) => Ok(None),
        (Some(_), false) => Err(wrong(format!(
            "settings are those of a bare mesh, which is sent as {MESH}; a package has them in sector.json"
        ))),
        (None, true) => {
            let least = r#"{"top_speed_rad_s": 5000}"#;
            Err(wrong(format!("a bare mesh needs the settings of its model, {least} at least")))
        }
        (Some(text), true) => {
            let mut settings: MeshSettings =
                serde_json::from_str(text).map_err(|error| wrong(error.to_string()))?;
            settings.name = settings.name.or_else(|| query.name().map(ToOwned::to_owned));
            Ok(Some(settings))
        }
    }
}

/// List models.
#[utoipa::path(get, path = "/v1/models", operation_id = "list_models", tag = "models", params(ModelQuery),
    responses(
        (status = 200, description = "A page of models, newest first.", body = ModelList),
    ))]
pub(super) async fn list_models(
    state: State<AppState>,
    whose: Principal,
    Parameters(query): Parameters<ModelQuery>,
) -> Result<Json<ModelList>, Problem> {
    let limit = page::limit(query.limit)?;
    let before = page::cursor(query.cursor.as_deref(), |cursor| cursor.parse().ok())?;
    // One more than asked for tells whether there is another page.
    let filter = ModelFilter {
        owner: whose.only().map(ToOwned::to_owned),
        name: query.name.clone(),
        tag: query.tag.clone(),
        before,
    };
    let mut models = state.store.models(filter, limit + 1).await?;
    let next = page::cut(&mut models, limit).map(|last| {
        let cursor = Some(last.number.to_string());
        page::path("/v1/models", &ModelQuery { limit: Some(limit), cursor, ..query })
    });
    let next = next.transpose()?;
    Ok(Json(ModelList { models: models.into_iter().map(ModelBody::from).collect(), next }))
}

/// Read the facts of a model and the reports of its reductions.
#[utoipa::path(get, path = "/v1/models/{id}", operation_id = "get_model", tag = "models",
    params(("id" = String, Path, description = "Id of the model.")),
    responses(
        (status = 200, description = "The model.", body = ModelDetail),
    ))]
pub(super) async fn get_model(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
) -> Result<Json<ModelDetail>, Problem> {
    let model = state.store.model(&id, whose.only()).await?.ok_or_else(|| model_not_found(&id))?;
    let reductions = state.store.reduction_reports(&id).await?;
    Ok(Json(ModelDetail { model: model.into(), reductions }))
}

/// Change the labels of a model.
///
/// Takes a merge patch (RFC 7396): a label that is left out stays, null removes it; a model whose name is removed has that of its
/// package. If several owners have the same model, each owner changes only their own labels.
#[utoipa::path(patch, path = "/v1/models/{id}", operation_id = "label_model", tag = "models",
    params(("id" = String, Path, description = "Id of the model.")),
    request_body(content((LabelPatch = "application/merge-patch+json"), (LabelPatch = "application/json"))),
    responses(
        (status = 200, description = "The model as it is called now.", body = ModelDetail),
        (status = 415, description = "The body is not declared as JSON.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "A field is unknown or impossible: `errors` points at it.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn label_model(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
    MergePatch(patch): MergePatch<LabelPatch>,
) -> Result<Json<ModelDetail>, Problem> {
    if !state.store.label_model(&id, whose.only(), patch.changes()?).await? {
        return Err(model_not_found(&id));
    }
    get_model(state, whose, ModelPath(id)).await
}

/// Delete a model with its package and reductions.
///
/// Finished jobs keep their results. A model that unfinished jobs need is not deleted: cancel them first.
#[utoipa::path(delete, path = "/v1/models/{id}", operation_id = "delete_model", tag = "models",
    params(("id" = String, Path, description = "Id of the model.")),
    responses(
        (status = 204, description = "The model is gone."),
        (status = 409, description = "Unfinished jobs need the model.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn delete_model(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
) -> Result<StatusCode, Problem> {
    match state.store.delete_model(&id, whose.only()).await? {
        Deletion::Deleted => {
            tracing::info!(model.id = id, "deleted a model");
            Ok(StatusCode::NO_CONTENT)
        }
        Deletion::Unknown => Err(model_not_found(&id)),
        Deletion::InUse(jobs) => {
            let detail = format!("{jobs} unfinished jobs need this model; cancel them or let them finish");
            Err(Problem::new(Kind::ModelInUse, detail))
        }
    }
}

pub(super) fn model_not_found(id: &str) -> Problem {
    Problem::new(Kind::ModelNotFound, format!("there is no model {:?}", excerpt(id)))
}
