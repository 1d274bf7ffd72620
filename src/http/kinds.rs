//! Requests for jobs of all kinds: one handler that accepts, one that plans, and their words in the contract.

use axum::extract::{Request, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodRouter, post};
use serde::Serialize;
use utoipa::ToSchema;
use utoipa::openapi::path::{
    HttpMethod, OperationBuilder, ParameterBuilder, ParameterIn, PathItem, PathsBuilder,
};
use utoipa::openapi::request_body::RequestBodyBuilder;
use utoipa::openapi::{
    Components, ContentBuilder, Object, Ref, RefOr, Response as Described, ResponseBuilder, Schema, Type,
};
use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouter};

use super::extract::{read_as, whole_body};
use super::idempotency::{self, IdempotencyKey};
use super::job_body::{Link, links};
use super::labels::{self, add_labels};
use super::problem::{MEDIA_TYPE, Problem};
use super::state::AppState;
use crate::analysis::kinds::kind::{Asked, Kind, Words};
use crate::analysis::kinds::list::KINDS;
use crate::jobs::SubmitError;
use crate::kinds::{self, JobKind};
use crate::store::idempotency::Answer;
use crate::store::jobs::{JobId, Posted};
use crate::store::labels::Labels;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Receipt of a job just accepted.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Receipt {
    /// Id of the job.
    #[schema(example = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10")]
    id: String,
    /// Kind of the job.
    kind: JobKind,
    /// Status of the job, always `accepted`.
    status: JobStatus,
    /// Links to the job, to follow it, and to its results.
    links: Vec<Link>,
}

/// Request for a job, read from a body.
pub(super) struct Asking {
    pub(super) asked: Box<dyn Asked>,
    pub(super) labels: Labels,
    /// Request as it came, which can be posted again.
    pub(super) posted: Option<Posted>,
    /// Digest of route and body, for the idempotency key.
    pub(super) fingerprint: String,
}

impl Asking {
    /// Reads the request for a job of this `kind`.
    pub(super) async fn read(
        state: &AppState,
        kind: &'static Kind,
        request: Request,
    ) -> Result<Self, Problem> {
        let path = request.uri().path().to_owned();
        let body = whole_body(request, state, &["application/json"]).await?;
        let fingerprint = idempotency::fingerprint(&path, &body);
        let name = (kind.request.name)();
        let (asked, labels, body) = read_as(&state.contract, &name, &body, |body| {
            let (request, given) = labels::apart(body)?;
            Ok(((kind.read)(&request)?, given, request))
        })?;
        let posted = Some(Posted { to: kind.route.to_owned(), body });
        Ok(Self { asked, labels: labels.labels()?, posted, fingerprint })
    }
}

/// Accepts a job with its labels, or repeats the answer given before under its key.
pub(super) async fn accept(
    state: &AppState,
    whose: &Principal,
    key: IdempotencyKey,
    asking: Asking,
) -> Result<Response, Problem> {
    let Asking { asked, labels, posted, fingerprint } = asking;
    if let Some(response) = key.replay(&state.store, whose, &fingerprint).await? {
        return Ok(response);
    }
    let checked = state.jobs.check(whose, asked).await?;
    let (id, job) = (JobId::new(), checked.job());
    let kind = JobKind(job.kind());
    let links = links(id, kind, job.models().first().copied(), job.records());
    let receipt = Receipt { id: id.to_string(), kind, status: JobStatus::Accepted, links };
    let answer = Answer {
        owner: whose.owner.clone(),
        key: String::new(),
        fingerprint: String::new(),
        status: StatusCode::ACCEPTED.as_u16(),
        location: format!("/v1/jobs/{id}"),
        body: serde_json::to_string(&receipt)?,
    };
    let kept = key.answer(&fingerprint, &answer);
    match state.jobs.submit(whose, id, checked, posted, labels, kept.as_ref()).await {
        Ok(()) => Ok(idempotency::respond(&answer)),
        Err(error @ SubmitError::KeyTaken) => {
            key.replay(&state.store, whose, &fingerprint).await?.ok_or_else(|| error.into())
        }
        Err(error) => Err(error.into()),
    }
}

async fn create(
    state: AppState,
    whose: Principal,
    key: IdempotencyKey,
    kind: &'static Kind,
    request: Request,
) -> Result<Response, Problem> {
    let asking = Asking::read(&state, kind, request).await?;
    accept(&state, &whose, key, asking).await
}

async fn plan(
    state: AppState,
    whose: Principal,
    kind: &'static Kind,
    request: Request,
) -> Result<Response, Problem> {
    let asking = Asking::read(&state, kind, request).await?;
    let plan = state.jobs.plan(&whose, asking.asked).await?;
    Ok(([(header::CONTENT_TYPE, "application/json")], plan).into_response())
}

/// Adds to `router` the routes at which jobs are asked for and planned. A model is asked for where packages are uploaded.
pub(super) fn routes(router: OpenApiRouter<AppState>) -> OpenApiRouter<AppState> {
    let router = KINDS.into_iter().fold(router, |router, kind| router.routes(creation(kind)));
    kinds::all().fold(router, |router, JobKind(kind)| router.routes(planning(kind)))
}

fn creation(kind: &'static Kind) -> UtoipaMethodRouter<AppState> {
    let key = ParameterBuilder::new()
        .name("Idempotency-Key")
        .parameter_in(ParameterIn::Header)
        .schema(Some(Object::with_type(Type::String)))
        .description(Some("Repeating the request with this key repeats its answer and starts nothing."));
    let operation = operation(kind, &kind.create, "create").parameter(key.build());
    let operation = match kind.create.refused {
        "" => operation,
        refused => operation.response("422", refusal(refused)),
    };
    let handler = post(
        move |State(state): State<AppState>, whose: Principal, key: IdempotencyKey, request: Request| {
            create(state, whose, key, kind, request)
        },
    );
    route(kind.route.to_owned(), operation, schemas(kind), handler)
}

fn planning(kind: &'static Kind) -> UtoipaMethodRouter<AppState> {
    let plan_of = ContentBuilder::new().schema(Some(Ref::from_schema_name((kind.planned.name)()))).build();
    let answer = ResponseBuilder::new().description("The plan.").content("application/json", plan_of);
    let operation = operation(kind, &kind.plan, "plan").response("200", answer.build());
    let handler = post(move |State(state): State<AppState>, whose: Principal, request: Request| {
        plan(state, whose, kind, request)
    });
    route(format!("{}/plan", kind.route), operation, schemas(kind), handler)
}

/// Operation of a kind: its words, and its body with the example.
fn operation(kind: &Kind, words: &Words, verb: &str) -> OperationBuilder {
    let example = if verb == "create" { serde_json::from_str(kind.example).ok() } else { None };
    let body =
        ContentBuilder::new().schema(Some(Ref::from_schema_name((kind.request.name)()))).example(example);
    let body = RequestBodyBuilder::new()
        .content("application/json", body.build())
        .required(Some(utoipa::openapi::Required::True));
    OperationBuilder::new()
        .tag("jobs")
        .operation_id(Some(format!("{verb}_{}", kind.operation)))
        .summary(Some(words.summary))
        .description(Some(words.description).filter(|words| !words.is_empty()))
        .request_body(Some(body.build()))
}

fn refusal(description: &str) -> Described {
    let content = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
    ResponseBuilder::new().description(description).content(MEDIA_TYPE, content).build()
}

fn schemas(kind: &Kind) -> Vec<(String, RefOr<Schema>)> {
    let mut schemas = Vec::new();
    for shape in [kind.request, kind.planned] {
        (shape.nested)(&mut schemas);
        schemas.push(((shape.name)().into_owned(), (shape.schema)()));
    }
    schemas
}

fn route(
    path: String,
    operation: OperationBuilder,
    schemas: Vec<(String, RefOr<Schema>)>,
    handler: MethodRouter<AppState>,
) -> UtoipaMethodRouter<AppState> {
    let paths = PathsBuilder::new().path(path, PathItem::new(HttpMethod::Post, operation.build())).build();
    (schemas, paths, handler)
}

/// Adds the fields of labels, which every request for a job may have, to the schemas of the requests.
pub(super) fn label_requests(components: &mut Components) {
    for kind in kinds::all() {
        if let Some(RefOr::T(Schema::Object(request))) = components.schemas.get_mut(&*(kind.request.name)()) {
            add_labels(request);
        }
    }
}
