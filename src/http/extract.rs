//! Extractors of requests: rejections of axum's extractors become problems like all others.

use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, StatusCode, header};
use serde::de::DeserializeOwned;
use utoipa::ToSchema;

use super::contract::{Contract, Findings, check};
use super::idempotency;
use super::problem::{Kind, Problem, ProblemItem, excerpt};
use super::state::AppState;
use crate::store::jobs::JobId;

/// Largest body that is read as a whole, bytes.
pub(super) const WHOLE_BYTES: usize = 2 << 20;

/// JSON body of a request.
pub(super) struct JsonBody<T> {
    pub(super) value: T,
    /// Digest of route and body, for the idempotency key.
    pub(super) fingerprint: String,
}

impl<T: DeserializeOwned + ToSchema> FromRequest<AppState> for JsonBody<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, Problem> {
        Self::read(request, state, &["application/json"]).await
    }
}

/// Merge patch in the body of a request (RFC 7396).
pub(super) struct MergePatch<T>(pub(super) T);

impl<T: DeserializeOwned + ToSchema> FromRequest<AppState> for MergePatch<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, Problem> {
        let accepted = ["application/merge-patch+json", "application/json"];
        Ok(Self(JsonBody::read(request, state, &accepted).await?.value))
    }
}

impl<T: DeserializeOwned + ToSchema> JsonBody<T> {
    /// Reads a body whose declared type is one of `accepted`.
    async fn read(request: Request, state: &AppState, accepted: &[&str]) -> Result<Self, Problem> {
        let path = request.uri().path().to_owned();
        let body = whole_body(request, state, accepted).await?;
        let value = read_json(&state.contract, &body)?;
        Ok(Self { value, fingerprint: idempotency::fingerprint(&path, &body) })
    }
}

/// Reads the body of a request, whose declared type is one of `accepted`.
pub(super) async fn whole_body(
    request: Request,
    state: &AppState,
    accepted: &[&str],
) -> Result<Bytes, Problem> {
    expect_media_type(request.headers(), accepted)?;
    if declared_bytes(request.headers()) > Some(WHOLE_BYTES as u64) {
        return Err(too_large());
    }
    Bytes::from_request(request, state).await.map_err(|rejection| match rejection {
        BytesRejection::FailedToBufferBody(ref failure)
            if failure.status() == StatusCode::PAYLOAD_TOO_LARGE =>
        {
            too_large()
        }
        other => Problem::new(Kind::BadRequest, other.body_text()),
    })
}

fn too_large() -> Problem {
    Problem::new(Kind::PayloadTooLarge, format!("the body of this request may have {WHOLE_BYTES} bytes"))
}

/// Length of the body as its header declares it, bytes.
pub(super) fn declared_bytes(headers: &HeaderMap) -> Option<u64> {
    headers.get(header::CONTENT_LENGTH)?.to_str().ok()?.parse().ok()
}

/// Query string of a request.
pub(super) struct Parameters<T>(pub(super) T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for Parameters<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        // What the contract does not admit does not come so far.
        let query = Query::from_request_parts(parts, state).await;
        let Query(value) = query.map_err(|error| Problem::new(Kind::InvalidParameter, error.body_text()))?;
        Ok(Self(value))
    }
}

/// Id of a model in the path.
pub(super) struct ModelPath(pub(super) String);

impl<S: Send + Sync> FromRequestParts<S> for ModelPath {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let Path(id) = Path::from_request_parts(parts, state)
            .await
            .map_err(|rejection| Problem::new(Kind::ModelNotFound, rejection.body_text()))?;
        Ok(Self(id))
    }
}

/// Id of a job in the path. Text that cannot be an id is the id of no job.
pub(super) struct JobPath(pub(super) JobId);

impl<S: Send + Sync> FromRequestParts<S> for JobPath {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let Path(id) = Path::<String>::from_request_parts(parts, state)
            .await
            .map_err(|rejection| Problem::new(Kind::JobNotFound, rejection.body_text()))?;
        Ok(Self(parse_job_id(&id)?))
    }
}

/// Id of a job and index of a speed in the path. Text that cannot be an index is the index of no speed.
pub(super) struct SpeedPath(pub(super) JobId, pub(super) Option<u32>);

impl<S: Send + Sync> FromRequestParts<S> for SpeedPath {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let path = Path::<(String, String)>::from_request_parts(parts, state).await;
        let Path((id, index)) = path.map_err(|rejection| {
            let text = rejection.body_text();
            Problem::new(if text.contains("index") { Kind::SpeedNotFound } else { Kind::JobNotFound }, text)
        })?;
        Ok(Self(parse_job_id(&id)?, parse_index(&index)))
    }
}

/// Reads an index, which has one spelling only, so that a result has one path.
fn parse_index(text: &str) -> Option<u32> {
    text.parse().ok().filter(|index: &u32| index.to_string() == text)
}

pub(super) fn parse_job_id(text: &str) -> Result<JobId, Problem> {
    JobId::parse(text).ok_or_else(|| job_not_found(&excerpt(text)))
}

/// Problem of a job that does not exist.
pub(super) fn job_not_found(id: &impl std::fmt::Display) -> Problem {
    Problem::new(Kind::JobNotFound, format!("there is no job {id}"))
}

/// Refuses a body that is encoded, or whose declared type is none of `accepted`.
pub(super) fn expect_media_type(headers: &HeaderMap, accepted: &[&str]) -> Result<(), Problem> {
    if let Some(encoding) = headers.get(header::CONTENT_ENCODING)
        && !encoding.as_bytes().eq_ignore_ascii_case(b"identity")
    {
        let detail = "bodies are taken as they are: send it without Content-Encoding";
        return Err(Problem::new(Kind::UnsupportedMediaType, detail).with(ProblemItem {
            parameter: Some("Content-Encoding".to_owned()),
            detail: detail.to_owned(),
            ..ProblemItem::default()
        }));
    }
    if accepted.iter().any(|accepted| is_media_type(headers, accepted)) {
        return Ok(());
    }
    let essence = media_type(headers);
    let found = if essence.is_empty() { "no Content-Type".to_owned() } else { format!("{essence:?}") };
    let detail = format!("this path takes {}, the request has {found}", accepted.join(" or "));
    Err(Problem::new(Kind::UnsupportedMediaType, detail).with(ProblemItem {
        parameter: Some("Content-Type".to_owned()),
        detail: format!("use {}", accepted.join(" or ")),
        ..ProblemItem::default()
    }))
}

/// Whether the body is declared to be of type `wanted`.
pub(super) fn is_media_type(headers: &HeaderMap, wanted: &str) -> bool {
    media_type(headers).eq_ignore_ascii_case(wanted)
}

/// Declared type of the body without its parameters.
fn media_type(headers: &HeaderMap) -> &str {
    let declared =
        headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    declared.split(';').next().unwrap_or_default().trim()
}

/// Reads one JSON document and reports what is wrong with it: by line and column if it is not JSON, by pointer if it is.
fn read_json<T: DeserializeOwned + ToSchema>(contract: &Contract, body: &[u8]) -> Result<T, Problem> {
    read_as(contract, &T::name(), body, |body| serde_json::from_slice(body))
}

/// Checks a body against the schema `name` of the contract, and reads it.
pub(super) fn read_as<T>(
    contract: &Contract,
    name: &str,
    body: &[u8],
    read: impl FnOnce(&[u8]) -> serde_json::Result<T>,
) -> Result<T, Problem> {
    let shape = contract.body(name).ok_or_else(|| {
        tracing::error!(body = name, "the contract does not have this body");
        Problem::new(Kind::Internal, "a defect of the program; the service's log says more")
    })?;
    let Findings { first, total, unknown_fields } = check(shape, body).map_err(|error| malformed(&error))?;
    if total > 0 {
        let kind = if unknown_fields == total { Kind::UnknownField } else { Kind::InvalidRequest };
        return Err(Problem::first_violations(kind, total, first));
    }
    // Allowed by the contract but not by the type. The place in the text is left out: labels were taken out of it before.
    read(body).map_err(|error| Problem::new(Kind::InvalidRequest, without_place(&error)))
}

fn malformed(error: &serde_json::Error) -> Problem {
    let (line, column, message) = (error.line(), error.column(), without_place(error));
    Problem::new(Kind::MalformedJson, format!("{message} (line {line}, column {column})")).with(ProblemItem {
        line: Some(line as u64),
        column: Some(column as u64),
        detail: message,
        ..ProblemItem::default()
    })
}

/// Message of an error, to which serde_json appends " at line 1 column 2".
fn without_place(error: &serde_json::Error) -> String {
    let full = error.to_string();
    full.rsplit_once(" at line ").map_or(full.as_str(), |(message, _)| message).to_owned()
}
