//! Every error as an RFC 9457 problem: one table of kinds, and the translations from the layers below.

use axum::Json;
use axum::extract::Request;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;

use crate::analysis::error::Violation;
use crate::jobs::{Panicked, SubmitError};
use crate::package::PackageError;
use crate::store::StoreError;
use crate::store::jobs::{Failure, FailureCause};

/// Media type of problems.
pub const MEDIA_TYPE: &str = "application/problem+json";

/// What went wrong, for programs and people (RFC 9457).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Problem {
    /// Kind of problem: a URI that never changes, `urn:rubmap:problem:…`.
    #[schema(example = "urn:rubmap:problem:unknown-field")]
    pub r#type: &'static str,
    /// The kind in words.
    pub title: &'static str,
    /// HTTP status.
    pub status: u16,
    /// What happened this time, and what to do about it.
    pub detail: String,
    /// Path of the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
    /// Everything that is wrong, one by one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<ProblemItem>,
}

/// One of the things that are wrong.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct ProblemItem {
    /// RFC 6901 pointer into the request body, or into `file` if that is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pointer: Option<String>,
    /// Name of the offending query parameter or header.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<String>,
    /// File within an uploaded package.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line within `file` or within the request body, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
    /// Column within the line, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<u64>,
    /// What is wrong and what would be right.
    pub detail: String,
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident = $status:ident, $slug:literal, $title:literal;)*) => {
        /// Kinds of problem.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Kind { $($(#[$doc])* $kind),* }

        impl Kind {
            fn entry(self) -> (StatusCode, &'static str, &'static str) {
                match self { $(Self::$kind => (StatusCode::$status, concat!("urn:rubmap:problem:", $slug), $title)),* }
            }
        }
    };
}

kinds! {
    /// The body is not JSON.
    MalformedJson = BAD_REQUEST, "malformed-json", "The body is not well-formed JSON";
    /// A parameter in query or header cannot be read.
    InvalidParameter = BAD_REQUEST, "invalid-parameter", "A parameter is not valid";
    /// The request cannot be read for another reason.
    BadRequest = BAD_REQUEST, "bad-request", "The request cannot be read";
    /// No such route.
    NotFound = NOT_FOUND, "not-found", "There is nothing here";
    /// No such model.
    ModelNotFound = NOT_FOUND, "model-not-found", "There is no such model";
    /// No such job.
    JobNotFound = NOT_FOUND, "job-not-found", "There is no such job";
    /// No such speed in the job, or none computed.
    SpeedNotFound = NOT_FOUND, "speed-not-found", "There is no such speed";
    /// The route knows other methods.
    MethodNotAllowed = METHOD_NOT_ALLOWED, "method-not-allowed", "The method is not allowed here";
    /// Unfinished jobs need the model.
    ModelInUse = CONFLICT, "model-in-use", "Unfinished jobs need the model";
    /// The job has ended already.
    JobFinished = CONFLICT, "job-finished", "The job has ended already";
    /// This kind of job has no such result.
    WrongJobKind = CONFLICT, "wrong-job-kind", "This kind of job has no such result";
    /// The result is still to come.
    ResultNotReady = CONFLICT, "result-not-ready", "The result is not ready yet";
    /// The result will never come.
    ResultUnavailable = CONFLICT, "result-unavailable", "The job ended without this result";
    /// The client stopped sending.
    UploadStalled = REQUEST_TIMEOUT, "upload-stalled", "The body stopped coming";
    /// The request is meant for another host.
    Misdirected = MISDIRECTED_REQUEST, "misdirected-request", "The request is meant for another host";
    /// The body is larger than allowed.
    PayloadTooLarge = PAYLOAD_TOO_LARGE, "payload-too-large", "The body is too large";
    /// The body is of the wrong type.
    UnsupportedMediaType = UNSUPPORTED_MEDIA_TYPE, "unsupported-media-type", "The body is of the wrong type";
    /// A field that does not exist.
    UnknownField = UNPROCESSABLE_ENTITY, "unknown-field", "The request has a field that does not exist";
    /// The request does not make sense.
    InvalidRequest = UNPROCESSABLE_ENTITY, "invalid-request", "The request cannot be met";
    /// The package does not keep the format.
    InvalidPackage = UNPROCESSABLE_ENTITY, "invalid-package", "The model package is not valid";
    /// The model cannot be computed.
    InvalidModel = UNPROCESSABLE_ENTITY, "invalid-model", "The model cannot be computed";
    /// The job needs more memory than the service may take.
    OutOfMemory = INSUFFICIENT_STORAGE, "out-of-memory", "The job needs more memory than allowed";
    /// The idempotency key belongs to another request.
    KeyReused = UNPROCESSABLE_ENTITY, "idempotency-key-reused", "The idempotency key belongs to another request";
    /// A defect of the program.
    Internal = INTERNAL_SERVER_ERROR, "internal-error", "The service failed";
    /// The database cannot be reached.
    Unavailable = SERVICE_UNAVAILABLE, "unavailable", "The service is not ready";
}

impl Problem {
    /// A problem of `kind`.
    pub fn new(kind: Kind, detail: impl Into<String>) -> Self {
        let (status, r#type, title) = kind.entry();
        Self {
            r#type,
            title,
            status: status.as_u16(),
            detail: detail.into(),
            instance: None,
            errors: Vec::new(),
        }
    }

    /// With one more thing that is wrong.
    #[must_use]
    pub fn with(mut self, item: ProblemItem) -> Self {
        self.errors.push(item);
        self
    }

    /// A parameter that cannot be used.
    pub fn parameter(name: &str, detail: impl Into<String>) -> Self {
        let detail = detail.into();
        Self::new(Kind::InvalidParameter, format!("{name}: {detail}")).with(ProblemItem {
            parameter: Some(name.to_owned()),
            detail,
            ..ProblemItem::default()
        })
    }

    /// A request with these violations.
    pub fn violations(kind: Kind, violations: Vec<Violation>) -> Self {
        let detail = violations.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        let mut problem = Self::new(kind, detail);
        problem.errors = violations.into_iter().map(ProblemItem::from).collect();
        problem
    }

    /// The problem that an error answer without a body stands for.
    fn from_status(status: StatusCode) -> Self {
        let (kind, detail) = match status {
            StatusCode::NOT_FOUND => (Kind::NotFound, "no route matches this path; see /openapi.json"),
            StatusCode::METHOD_NOT_ALLOWED => {
                (Kind::MethodNotAllowed, "the Allow header lists the methods of this path")
            }
            StatusCode::PAYLOAD_TOO_LARGE => (Kind::PayloadTooLarge, "the body is larger than allowed here"),
            StatusCode::UNSUPPORTED_MEDIA_TYPE => {
                (Kind::UnsupportedMediaType, "see /openapi.json for what this path takes")
            }
            status if status.is_client_error() => (Kind::BadRequest, "the request cannot be read"),
            _ => (Kind::Internal, "the service failed; its log says more"),
        };
        Self { status: status.as_u16(), ..Self::new(kind, detail) }
    }
}

impl From<Violation> for ProblemItem {
    fn from(Violation { pointer, message }: Violation) -> Self {
        Self { pointer: Some(pointer), detail: message, ..Self::default() }
    }
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        tracing::error!(%error, "store failed");
        Self::new(Kind::Internal, "the data folder failed; the service's log says more")
    }
}

impl From<std::io::Error> for Problem {
    fn from(error: std::io::Error) -> Self {
        StoreError::from(error).into()
    }
}

impl From<serde_json::Error> for Problem {
    fn from(error: serde_json::Error) -> Self {
        StoreError::from(error).into()
    }
}

impl From<Panicked> for Problem {
    fn from(error: Panicked) -> Self {
        tracing::error!(%error, "computation panicked");
        Self::new(Kind::Internal, "a defect of the program; the service's log says more")
    }
}

impl From<Box<PackageError>> for Problem {
    fn from(error: Box<PackageError>) -> Self {
        let item = ProblemItem {
            file: error.file().map(ToOwned::to_owned),
            line: error.line(),
            pointer: error.field().map(ToOwned::to_owned),
            detail: error.to_string(),
            ..ProblemItem::default()
        };
        Self::new(Kind::InvalidPackage, error.to_string()).with(item)
    }
}

impl From<SubmitError> for Problem {
    fn from(error: SubmitError) -> Self {
        match error {
            SubmitError::UnknownModel(_) => {
                let message = format!("{error}; upload it with POST /v1/models first");
                Self::violations(Kind::InvalidRequest, vec![Violation::new("/model", message)])
            }
            SubmitError::Refused(violations) => Self::violations(Kind::InvalidRequest, violations),
            SubmitError::KeyTaken => Self::new(Kind::KeyReused, error.to_string()),
            SubmitError::Store(error) => error.into(),
            SubmitError::Defect(error) => error.into(),
        }
    }
}

impl From<&Failure> for Problem {
    fn from(failure: &Failure) -> Self {
        let kind = match failure.cause {
            FailureCause::Refused => Kind::InvalidRequest,
            FailureCause::Model => Kind::InvalidModel,
            FailureCause::Memory => Kind::OutOfMemory,
            FailureCause::Package | FailureCause::Defect | FailureCause::Storage => Kind::Internal,
        };
        let mut problem = Self::new(kind, failure.message.clone());
        problem.errors = failure.violations.iter().cloned().map(ProblemItem::from).collect();
        problem
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = (status, Json(&self)).into_response();
        response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA_TYPE));
        response.extensions_mut().insert(self);
        response
    }
}

/// Middleware around everything: errors without a problem get one, and problems learn the path of their request.
pub(super) async fn complete(request: Request, next: Next) -> Response {
    let path = request.uri().path().to_owned();
    let mut response = next.run(request).await;
    let status = response.status();
    if !status.is_client_error() && !status.is_server_error() {
        return response;
    }
    let problem =
        response.extensions_mut().remove::<Problem>().unwrap_or_else(|| Problem::from_status(status));
    let mut completed = Problem { instance: Some(path), ..problem }.into_response();
    for (name, value) in response.headers() {
        if name != header::CONTENT_TYPE && name != header::CONTENT_LENGTH {
            completed.headers_mut().insert(name, value.clone());
        }
    }
    completed
}

/// The answer when a handler panics.
pub(super) fn panicked(_: Box<dyn std::any::Any + Send>) -> Response {
    tracing::error!("a handler panicked");
    Problem::new(Kind::Internal, "a defect of the program; the service's log says more").into_response()
}
