//! Problems (RFC 9457), which every error becomes: one table of kinds, and the translations from the layers below.

use axum::Json;
use axum::extract::Request;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;

use crate::analysis::error::Violation;
use crate::import::UploadError;
use crate::jobs::{Panicked, SubmitError};
use crate::package::PackageError;
use crate::store::StoreError;
use crate::store::jobs::{Failure, FailureCause};
use crate::store::limits::LimitReached;

/// Media type of problems.
pub const MEDIA_TYPE: &str = "application/problem+json";

/// `Retry-After` of a full disk, s: somebody has to make room.
const FULL_DISK_S: u32 = 60;

/// `Retry-After` of a limit of an owner, s: jobs have to end, or somebody has to delete something.
const LIMIT_S: u32 = 60;

/// `Retry-After` of too many requests being planned, s.
const PLANS_S: u32 = 1;

/// `Retry-After` of a locked store and a lack of descriptors, s, which pass by themselves.
const BUSY_S: u32 = 5;

/// Largest number of items in `errors`; if there are more, the last one says how many.
pub(super) const MOST_ITEMS: usize = 20;

/// Largest number of characters of a value that are shown.
pub(super) const EXCERPT: usize = 60;

/// Largest number of characters of a text in a problem, whoever wrote it.
const LONGEST_TEXT: usize = 2000;

/// Problem that a request met, for programs and people (RFC 9457).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Problem {
    /// Kind of problem: a URI that never changes, `urn:rubmap:problem:…`.
    #[schema(example = "urn:rubmap:problem:unknown-field")]
    pub r#type: &'static str,
    /// Kind of problem in words.
    pub title: &'static str,
    /// HTTP status.
    pub status: u16,
    /// Description of this occurrence, and what to do about it.
    pub detail: String,
    /// Path of the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
    /// Seconds after which the same request may succeed, as in the `Retry-After` header.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub retry_after_s: Option<u32>,
    /// Everything that is wrong, one by one; of more than twenty things the first, and how many more there are.
    #[schema(max_items = 20)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<ProblemItem>,
}

/// Item of a problem: one of the things that are wrong.
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
    /// Description of what is wrong and of what would be right.
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
    /// The request has no token, or one that is not known.
    Unauthorized = UNAUTHORIZED, "unauthorized", "The service wants a token";
    /// The token does not allow the request.
    Forbidden = FORBIDDEN, "forbidden", "The token does not allow this";
    /// A page of another site asks for a change.
    CrossSite = FORBIDDEN, "cross-site", "A page of another site may not change anything here";
    /// The route does not exist.
    NotFound = NOT_FOUND, "not-found", "There is nothing here";
    /// The model does not exist.
    ModelNotFound = NOT_FOUND, "model-not-found", "There is no such model";
    /// The job does not exist.
    JobNotFound = NOT_FOUND, "job-not-found", "There is no such job";
    /// The job has ended.
    JobEnded = CONFLICT, "job-ended", "The job has ended";
    /// The job has no such speed, or did not compute it.
    SpeedNotFound = NOT_FOUND, "speed-not-found", "There is no such speed";
    /// The model has no such reduction, or its basis is gone.
    NotReduced = CONFLICT, "not-reduced", "The model has no such reduction";
    /// No histories of that speed were recorded.
    HistoryNotRecorded = NOT_FOUND, "history-not-recorded", "There are no histories of this speed";
    /// No stress of that speed was recorded.
    StressNotRecorded = NOT_FOUND, "stress-not-recorded", "There is no stress";
    /// The route has other methods only.
    MethodNotAllowed = METHOD_NOT_ALLOWED, "method-not-allowed", "The method is not allowed here";
    /// The result does not have the form that was asked for.
    NotAcceptable = NOT_ACCEPTABLE, "not-acceptable", "The result does not come in this form";
    /// Unfinished jobs need the model.
    ModelInUse = CONFLICT, "model-in-use", "Unfinished jobs need the model";
    /// This kind of job has no such result.
    WrongJobKind = CONFLICT, "wrong-job-kind", "This kind of job has no such result";
    /// The result is still to come.
    ResultNotReady = CONFLICT, "result-not-ready", "The result is not ready yet";
    /// The result will never come.
    ResultUnavailable = CONFLICT, "result-unavailable", "The job ended without this result";
    /// The client stopped sending the body.
    UploadStalled = REQUEST_TIMEOUT, "upload-stalled", "The body stopped coming";
    /// The request is meant for another host.
    Misdirected = MISDIRECTED_REQUEST, "misdirected-request", "The request is meant for another host";
    /// The body is larger than allowed.
    PayloadTooLarge = PAYLOAD_TOO_LARGE, "payload-too-large", "The body is too large";
    /// The body is of the wrong type.
    UnsupportedMediaType = UNSUPPORTED_MEDIA_TYPE, "unsupported-media-type", "The body is of the wrong type";
    /// The request has a field that does not exist.
    UnknownField = UNPROCESSABLE_ENTITY, "unknown-field", "The request has a field that does not exist";
    /// The request does not make sense.
    InvalidRequest = UNPROCESSABLE_ENTITY, "invalid-request", "The request cannot be met";
    /// The package does not keep the format.
    InvalidPackage = UNPROCESSABLE_ENTITY, "invalid-package", "The model package is not valid";
    /// The table cannot be read.
    InvalidTable = UNPROCESSABLE_ENTITY, "invalid-table", "The table cannot be read";
    /// The model cannot be computed.
    InvalidModel = UNPROCESSABLE_ENTITY, "invalid-model", "The model cannot be computed";
    /// Every speed of the sweep diverged or failed.
    NothingCompleted = UNPROCESSABLE_ENTITY, "nothing-completed", "No speed of the sweep was completed";
    /// The job needs more memory than the service may take.
    OutOfMemory = INSUFFICIENT_STORAGE, "out-of-memory", "The job needs more memory than allowed";
    /// The owner has reached a limit.
    LimitReached = TOO_MANY_REQUESTS, "limit-reached", "A limit of yours is reached";
    /// The disk of the data folder is full.
    DiskFull = INSUFFICIENT_STORAGE, "disk-full", "There is no room for it on the disk";
    /// The idempotency key belongs to another request.
    KeyReused = UNPROCESSABLE_ENTITY, "idempotency-key-reused", "The idempotency key belongs to another request";
    /// A defect of the program.
    Internal = INTERNAL_SERVER_ERROR, "internal-error", "The service failed";
    /// The database cannot be reached.
    Unavailable = SERVICE_UNAVAILABLE, "unavailable", "The service is not ready";
}

impl Problem {
    /// Makes a problem of `kind`.
    pub fn new(kind: Kind, detail: impl Into<String>) -> Self {
        let (status, r#type, title) = kind.entry();
        Self {
            r#type,
            title,
            status: status.as_u16(),
            detail: cut(detail.into(), LONGEST_TEXT),
            instance: None,
            retry_after_s: None,
            errors: Vec::new(),
        }
    }

    /// Adds the one thing that is wrong.
    #[must_use]
    pub fn with(self, item: ProblemItem) -> Self {
        self.with_all(vec![item])
    }

    /// Adds everything that is wrong.
    #[must_use]
    pub fn with_all(self, items: Vec<ProblemItem>) -> Self {
        self.with_first_of(items.len(), items)
    }

    /// Adds the first `items` of `total` things that are wrong.
    fn with_first_of(mut self, total: usize, mut items: Vec<ProblemItem>) -> Self {
        if total > MOST_ITEMS {
            items.truncate(MOST_ITEMS - 1);
            let detail = format!("and {} more", total - items.len());
            items.push(ProblemItem { detail, ..ProblemItem::default() });
        }
        for item in &mut items {
            item.detail = cut(std::mem::take(&mut item.detail), LONGEST_TEXT);
        }
        self.errors = items;
        self
    }

    /// Adds the time after which the problem may be gone, s.
    #[must_use]
    pub fn retry_after(mut self, seconds: u32) -> Self {
        self.retry_after_s = Some(seconds);
        self
    }

    /// Problem of a parameter that cannot be used.
    pub fn parameter(name: &str, detail: impl Into<String>) -> Self {
        let detail = detail.into();
        Self::new(Kind::InvalidParameter, format!("{name}: {detail}")).with(ProblemItem {
            parameter: Some(name.to_owned()),
            detail,
            ..ProblemItem::default()
        })
    }

    /// Problem of a request with these violations.
    pub fn violations(kind: Kind, violations: Vec<Violation>) -> Self {
        Self::first_violations(kind, violations.len(), violations)
    }

    /// Problem of a request with `total` violations, of which `first` are the first.
    pub(super) fn first_violations(kind: Kind, total: usize, first: Vec<Violation>) -> Self {
        let items = first.into_iter().take(MOST_ITEMS).map(ProblemItem::from).collect();
        let problem = Self::new(kind, "").with_first_of(total, items);
        let texts = problem.errors.iter().map(|item| match item.pointer.as_deref() {
            Some(pointer) if !pointer.is_empty() => format!("{pointer}: {}", item.detail),
            _ => item.detail.clone(),
        });
        let detail = cut(texts.collect::<Vec<_>>().join("; "), LONGEST_TEXT);
        Self { detail, ..problem }
    }

    /// Problem for an error answer that has no body.
    pub(super) fn from_status(status: StatusCode) -> Self {
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

/// Excerpt of a value, for messages.
pub(super) fn excerpt(text: &str) -> String {
    cut(text.chars().take(EXCERPT + 1).collect(), EXCERPT)
}

/// Cuts a text to its first `most` characters.
fn cut(mut text: String, most: usize) -> String {
    if let Some((end, _)) = text.char_indices().nth(most) {
        text.truncate(end);
        text.push('…');
    }
    text
}

impl From<Violation> for ProblemItem {
    fn from(Violation { pointer, message }: Violation) -> Self {
        Self { pointer: Some(pointer), detail: message, ..Self::default() }
    }
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        if error.is_no_text() {
            return Self::new(
                Kind::InvalidRequest,
                "a text of the request has the character U+0000; leave it out",
            );
        }
        tracing::error!(%error, "store failed");
        if error.is_disk_full() {
            let detail = "the storage is full (the disk of the data folder, or that of a server in its place); nothing was kept of this request: send it again once there is room";
            return Self::new(Kind::DiskFull, detail).retry_after(FULL_DISK_S);
        }
        if error.may_pass() {
            let detail = "the storage cannot be used for the moment (a lock, no descriptors left, a server that is away); send the request again";
            return Self::new(Kind::Unavailable, detail).retry_after(BUSY_S);
        }
        Self::new(Kind::Internal, "the storage failed; the service's log says more")
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

impl From<UploadError> for Problem {
    fn from(error: UploadError) -> Self {
        match error {
            UploadError::BrokeOff(_) => Self::new(Kind::BadRequest, error.to_string()),
            UploadError::TooLarge(_) => Self::new(Kind::PayloadTooLarge, error.to_string()),
            UploadError::File(error) => error.into(),
        }
    }
}

impl From<Box<PackageError>> for Problem {
    fn from(error: Box<PackageError>) -> Self {
        if let PackageError::Io { source } = *error {
            // Says nothing about the package.
            return source.into();
        }
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
            SubmitError::UnknownModel { at, .. } => {
                let message = format!("{error}; upload it with POST /v1/models first");
                Self::violations(Kind::InvalidRequest, vec![Violation::new(at, message)])
            }
            SubmitError::Refused(violations) => Self::violations(Kind::InvalidRequest, violations),
            SubmitError::Limit(reached) => reached.into(),
            SubmitError::KeyTaken => Self::new(Kind::KeyReused, error.to_string()),
            SubmitError::Store(error) => error.into(),
            SubmitError::Defect(error) => error.into(),
        }
    }
}

impl From<LimitReached> for Problem {
    fn from(reached: LimitReached) -> Self {
        match reached {
            // No waiting helps.
            LimitReached::QueuedSpeeds { asked, limit, .. } if asked > limit => {
                let message = format!(
                    "{asked} speeds are more than the {limit} that one owner may have waiting: ask for fewer at a time"
                );
                Self::violations(Kind::InvalidRequest, vec![Violation::new("/speeds", message)])
            }
            LimitReached::Plans { .. } => {
                Self::new(Kind::LimitReached, reached.to_string()).retry_after(PLANS_S)
            }
            _ => Self::new(Kind::LimitReached, reached.to_string()).retry_after(LIMIT_S),
        }
    }
}

impl From<&Failure> for Problem {
    fn from(failure: &Failure) -> Self {
        let kind = match failure.cause {
            FailureCause::Refused => Kind::InvalidRequest,
            FailureCause::Model => Kind::InvalidModel,
            FailureCause::Memory => Kind::OutOfMemory,
            FailureCause::Limit => Kind::LimitReached,
            FailureCause::NothingCompleted => Kind::NothingCompleted,
            FailureCause::Package | FailureCause::Defect | FailureCause::Storage => Kind::Internal,
        };
        let first = failure.violations.iter().take(MOST_ITEMS).cloned().map(ProblemItem::from).collect();
        Self::new(kind, failure.message.clone()).with_first_of(failure.violations.len(), first)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = (status, Json(&self)).into_response();
        response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA_TYPE));
        if let Some(seconds) = self.retry_after_s {
            response.headers_mut().insert(header::RETRY_AFTER, seconds.into());
        }
        response.extensions_mut().insert(self);
        response
    }
}

/// Middleware around everything: gives a problem to errors without one, and adds the path of the request to every problem.
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

/// Answer when a handler panics.
pub(super) fn panicked(_: Box<dyn std::any::Any + Send>) -> Response {
    tracing::error!("a handler panicked");
    Problem::new(Kind::Internal, "a defect of the program; the service's log says more").into_response()
}
