//! Principals of requests: found by the bearer token, where the service has tokens.

use axum::extract::{FromRequestParts, Request, State};
use axum::http::header::{AUTHORIZATION, WWW_AUTHENTICATE};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderValue, Method};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::problem::{Kind, Problem};
use super::web;
use crate::tokens::{Principal, Scope, Tokens};

/// Paths that disclose nothing about any user, for those who monitor the process. The page is as open.
const OPEN: [&str; 2] = ["/healthz", "/readyz"];

/// Middleware before every handler: finds out who sends a request, and refuses those who may not.
pub(super) async fn authenticate(
    tokens: State<Option<Tokens>>,
    mut request: Request,
    next: Next,
) -> Response {
    let principal = match tokens.0 {
        None => Principal::anybody(),
        Some(_) if is_open(request.uri().path()) => Principal::anybody(),
        Some(tokens) => match bearer(request.headers()).and_then(|token| tokens.principal(token)) {
            Some(principal) => principal,
            None => return unauthorized(),
        },
    };
    if principal.scope == Scope::Read && !only_reads(request.method(), request.uri().path()) {
        let detail = "this token may only read; ask for one with the scope write";
        return Problem::new(Kind::Forbidden, detail).into_response();
    }
    request.extensions_mut().insert(principal);
    next.run(request).await
}

/// Paths that answer from the body of a request and store nothing, beside plans.
const STORE_NOTHING: [&str; 2] = ["/v1/casing-tables", "/v1/meshes/look"];

/// Whether a request changes nothing that is stored.
fn only_reads(method: &Method, path: &str) -> bool {
    [Method::GET, Method::HEAD].contains(method)
        || (method == Method::POST && (path.ends_with("/plan") || STORE_NOTHING.contains(&path)))
}

fn is_open(path: &str) -> bool {
    OPEN.contains(&path) || web::is_of_page(path)
}

/// Bearer token of a request.
pub(super) fn bearer(headers: &HeaderMap) -> Option<&str> {
    let mut said = headers.get_all(AUTHORIZATION).iter();
    // Of two, a gateway may have looked at the other one.
    let (Some(said), None) = (said.next(), said.next()) else { return None };
    let (scheme, token) = said.to_str().ok()?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then(|| token.trim())
}

fn unauthorized() -> Response {
    let detail = "this service wants a token: send it as \"Authorization: Bearer …\"";
    let mut response = Problem::new(Kind::Unauthorized, detail).into_response();
    response.headers_mut().insert(WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
    response
}

impl<S: Send + Sync> FromRequestParts<S> for Principal {
    type Rejection = Response;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Response> {
        parts.extensions.get::<Self>().cloned().ok_or_else(unauthorized)
    }
}
