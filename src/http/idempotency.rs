//! Idempotency by `Idempotency-Key`: a POST repeated with its key gets the first answer again, and nothing is done twice.

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use sha2::{Digest, Sha256};

use super::problem::{Kind, Problem};
use crate::store::Store;
use crate::store::idempotency::Answer;
use crate::tokens::Principal;

const HEADER: &str = "Idempotency-Key";

/// Idempotency key of a request, if the client sent one.
pub(super) struct IdempotencyKey(Option<String>);

impl<S: Send + Sync> FromRequestParts<S> for IdempotencyKey {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        let Some(value) = parts.headers.get(HEADER) else { return Ok(Self(None)) };
        match value.to_str() {
            Ok(key) if (1..=255).contains(&key.len()) => Ok(Self(Some(key.to_owned()))),
            _ => Err(Problem::parameter(HEADER, "a key has 1 to 255 printable ASCII characters")),
        }
    }
}

impl IdempotencyKey {
    /// Answer given before under this key; a problem if it was to another request.
    pub(super) async fn replay(
        &self,
        store: &Store,
        whose: &Principal,
        fingerprint: &str,
    ) -> Result<Option<Response>, Problem> {
        let Some(key) = &self.0 else { return Ok(None) };
        let Some(answer) = store.answer(&whose.owner, key).await? else { return Ok(None) };
        if answer.fingerprint != fingerprint {
            let detail = format!("{HEADER} {key:?} was used for another request; use a new key");
            return Err(Problem::new(Kind::KeyReused, detail));
        }
        Ok(Some(respond(&answer)))
    }

    /// Answer to store under this key.
    pub(super) fn answer(&self, fingerprint: &str, answer: &Answer) -> Option<Answer> {
        let key = self.0.clone()?;
        Some(Answer { key, fingerprint: fingerprint.to_owned(), ..answer.clone() })
    }
}

/// Digest of the route and the body of a request.
pub(super) fn fingerprint(path: &str, body: &[u8]) -> String {
    finish(start(path).chain_update(body))
}

/// Begins the digest of a body that comes in pieces.
pub(super) fn start(path: &str) -> Sha256 {
    Sha256::new().chain_update(path).chain_update([0])
}

/// Ends the digest of a body.
pub(super) fn finish(digest: Sha256) -> String {
    format!("{:x}", digest.finalize())
}

/// Makes a response of a stored answer.
pub(super) fn respond(answer: &Answer) -> Response {
    let status = StatusCode::from_u16(answer.status).unwrap_or(StatusCode::OK);
    let headers =
        [(header::LOCATION, answer.location.clone()), (header::CONTENT_TYPE, "application/json".into())];
    (status, headers, answer.body.clone()).into_response()
}
