//! Reading requests: what axum's extractors refuse becomes a problem like all others.

use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, QueryRejection};
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, StatusCode, header};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use serde_path_to_error::Segment;

use super::idempotency;
use super::problem::{Kind, Problem, ProblemItem};
use crate::analysis::error::Violation;
use crate::store::jobs::JobId;

/// A JSON body.
pub(super) struct JsonBody<T> {
    pub(super) value: T,
    /// Digest of route and body, for the idempotency key.
    pub(super) fingerprint: String,
}

impl<T: DeserializeOwned + Serialize, S: Send + Sync> FromRequest<S> for JsonBody<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self, Problem> {
        expect_media_type(request.headers(), &["application/json"])?;
        let path = request.uri().path().to_owned();
        let body = Bytes::from_request(request, state).await.map_err(|rejection| match rejection {
            BytesRejection::FailedToBufferBody(ref failure)
                if failure.status() == StatusCode::PAYLOAD_TOO_LARGE =>
            {
                Problem::new(Kind::PayloadTooLarge, "a request body may have 2 MB")
            }
            other => Problem::new(Kind::BadRequest, other.body_text()),
        })?;
        let value = read_json(&body)?;
        Ok(Self { value, fingerprint: idempotency::fingerprint(&path, &body) })
    }
}

/// A query string.
pub(super) struct Parameters<T>(pub(super) T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for Parameters<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        match Query::<T>::from_request_parts(parts, state).await {
            Ok(Query(value)) => Ok(Self(value)),
            Err(QueryRejection::FailedToDeserializeQueryString(error)) => {
                let text = std::error::Error::source(&error).map_or(error.body_text(), ToString::to_string);
                // "name: what is wrong", or only what is wrong where the name itself is not known.
                let (name, detail) = match text.split_once(": ") {
                    Some((name, detail)) => (name, detail),
                    None => (between_backquotes(&text).unwrap_or("query"), text.as_str()),
                };
                Err(Problem::parameter(name, detail))
            }
            Err(other) => Err(Problem::new(Kind::InvalidParameter, other.body_text())),
        }
    }
}

/// The id of a job in the path. What is no id is the id of no job.
pub(super) struct JobPath(pub(super) JobId);

impl<S: Send + Sync> FromRequestParts<S> for JobPath {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let Path(text) = Path::<String>::from_request_parts(parts, state)
            .await
            .map_err(|rejection| Problem::new(Kind::JobNotFound, rejection.body_text()))?;
        JobId::parse(&text).map(Self).ok_or_else(|| job_not_found(&text))
    }
}

/// The problem of a job that is not there.
pub(super) fn job_not_found(id: &impl std::fmt::Display) -> Problem {
    Problem::new(Kind::JobNotFound, format!("there is no job {id}"))
}

/// Refuses a body whose declared type is none of `accepted`.
pub(super) fn expect_media_type(headers: &HeaderMap, accepted: &[&str]) -> Result<(), Problem> {
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

/// The declared type of the body without its parameters.
fn media_type(headers: &HeaderMap) -> &str {
    let declared =
        headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    declared.split(';').next().unwrap_or_default().trim()
}

/// Reads one JSON document; says where it goes wrong: by line and column if it is not JSON, by pointer if it is.
fn read_json<T: DeserializeOwned + Serialize>(body: &[u8]) -> Result<T, Problem> {
    let mut deserializer = serde_json::Deserializer::from_slice(body);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let pointer = pointer_to(error.path());
        json_problem(error.inner(), pointer)
    })?;
    deserializer.end().map_err(|error| json_problem(&error, String::new()))?;
    match array_for_object(&serde_json::from_slice(body)?, &serde_json::to_value(&value)?) {
        None => Ok(value),
        Some(pointer) => {
            let violation = Violation::new(pointer, "expected an object with named fields, not an array");
            Err(Problem::violations(Kind::InvalidRequest, vec![violation]))
        }
    }
}

/// Pointer to the first array in `given` that was read as an object: serde takes fields by position too, the contract
/// does not.
fn array_for_object(given: &Value, read: &Value) -> Option<String> {
    match (given, read) {
        (Value::Array(_), Value::Object(_)) => Some(String::new()),
        (Value::Object(given), Value::Object(read)) => given.iter().find_map(|(key, given)| {
            let below = array_for_object(given, read.get(key)?)?;
            Some(format!("/{}{below}", escape(key)))
        }),
        (Value::Array(given), Value::Array(read)) => {
            given.iter().zip(read).enumerate().find_map(|(index, (given, read))| {
                Some(format!("/{index}{}", array_for_object(given, read)?))
            })
        }
        _ => None,
    }
}

fn json_problem(error: &serde_json::Error, mut pointer: String) -> Problem {
    let full = error.to_string();
    // serde_json appends " at line 1 column 2"; the item has these as numbers.
    let message = full.rsplit_once(" at line ").map_or(full.as_str(), |(message, _)| message).to_owned();
    let mut item = ProblemItem {
        line: Some(error.line() as u64),
        column: Some(error.column() as u64),
        detail: message.clone(),
        ..ProblemItem::default()
    };
    if !error.is_data() {
        let detail = format!("{message} (line {}, column {})", error.line(), error.column());
        return Problem::new(Kind::MalformedJson, detail).with(item);
    }
    let kind = if message.starts_with("unknown field") { Kind::UnknownField } else { Kind::InvalidRequest };
    // Of a field that is too much or missing, serde knows the parent and names the child in words.
    if (message.starts_with("unknown field") || message.starts_with("missing field"))
        && let Some(name) = between_backquotes(&message)
    {
        let child = format!("/{}", escape(name));
        if !pointer.ends_with(&child) {
            pointer.push_str(&child);
        }
    }
    let detail = if pointer.is_empty() { message } else { format!("{pointer}: {message}") };
    item.pointer = Some(pointer);
    Problem::new(kind, detail).with(item)
}

fn pointer_to(path: &serde_path_to_error::Path) -> String {
    path.iter()
        .filter_map(|segment| match segment {
            Segment::Seq { index } => Some(format!("/{index}")),
            Segment::Map { key } => Some(format!("/{}", escape(key))),
            // Names of variants are no part of the document.
            Segment::Enum { .. } | Segment::Unknown => None,
        })
        .collect()
}

/// RFC 6901.
fn escape(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

fn between_backquotes(text: &str) -> Option<&str> {
    text.split('`').nth(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::request::SweepRequest;

    fn refused(body: &str) -> Problem {
        read_json::<SweepRequest>(body.as_bytes()).unwrap_err()
    }

    fn pointer(problem: &Problem) -> &str {
        problem.errors[0].pointer.as_deref().unwrap()
    }

    #[test]
    fn an_unknown_field_is_pointed_at_wherever_it_is() {
        let problem = refused(r#"{"model": "a", "colour": "red"}"#);
        assert_eq!(problem.r#type, "urn:rubmap:problem:unknown-field");
        assert_eq!(pointer(&problem), "/colour");

        let problem = refused(
            r#"{"model": "a", "speeds": {"values": [1], "unit": "hz"},
                "scene": {"casing": {"clearance": {"leeding": 0.3}}}}"#,
        );
        assert_eq!(pointer(&problem), "/scene/casing/clearance/leeding");
    }

    #[test]
    fn fields_by_position_are_refused() {
        let problem = refused(r#"{"model": "a", "speeds": {"values": [1], "unit": "hz"}, "scene": []}"#);
        assert_eq!(pointer(&problem), "/scene");
        let problem = refused(r#"{"model": "a", "speeds": [null, null, null, [1], "hz"], "scene": {}}"#);
        assert_eq!(pointer(&problem), "/speeds/0");
        let problem = refused(r#"{"model": "a", "speeds": [[null, null, null, [1], "hz"]], "scene": {}}"#);
        assert_eq!(pointer(&problem), "/speeds/0");
    }

    #[test]
    fn a_missing_field_and_a_wrong_type_are_pointed_at() {
        let problem = refused(r#"{"model": "a", "speeds": {"values": [1]}, "scene": {}}"#);
        assert_eq!(pointer(&problem), "/speeds/unit");
        let problem = refused(r#"{"model": "a", "speeds": {"values": [1, "fast"], "unit": "hz"}}"#);
        assert_eq!(problem.r#type, "urn:rubmap:problem:invalid-request");
        assert_eq!(pointer(&problem), "/speeds/values/1");
        let problem = refused(r#"{"model": "a", "speeds": [{"values": [1, "fast"], "unit": "hz"}]}"#);
        assert_eq!(pointer(&problem), "/speeds/0/values/1");
        assert_eq!(pointer(&refused(r#"{"model": "a", "speeds": 7}"#)), "/speeds");
    }

    #[test]
    fn what_is_not_json_is_located_by_line_and_column() {
        let problem = refused("{\n  \"model\": oops\n}");
        assert_eq!(problem.status, 400);
        assert_eq!((problem.errors[0].line, problem.errors[0].column), (Some(2), Some(12)));
        assert_eq!(refused("").status, 400);
    }
}
