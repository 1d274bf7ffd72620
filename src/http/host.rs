//! Check of the host that a request is meant for.
//!
//! A web page that a user visits can make the name it came from mean 127.0.0.1 (DNS rebinding) and then use the service as if it
//! were the page's own; the only sign of it is that name in `Host`.

use axum::extract::{Request, State};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, Version, header};
use axum::middleware::Next;
use axum::response::Response;

use super::hosts::Hosts;
use super::problem::{Kind, Problem};
use super::state::AppState;

/// Longest name of a host (RFC 1035).
const LONGEST: usize = 253;

/// Middleware: refuses requests that do not name the host they are meant for, or name another.
pub(super) async fn check(state: State<AppState>, request: Request, next: Next) -> Result<Response, Problem> {
    // HTTP/1.0 knows no `Host`, and no browser speaks it.
    if let Some(authority) = named(request.headers(), request.version())? {
        refuse_others(&state.transport.hosts, &authority)?;
    }
    if let Some(authority) = request.uri().authority() {
        refuse_others(&state.transport.hosts, authority)?;
    }
    Ok(next.run(request).await)
}

/// Host and port in the `Host` header; exactly one header is needed since HTTP/1.1.
fn named(headers: &HeaderMap, version: Version) -> Result<Option<Authority>, Problem> {
    let mut values = headers.get_all(header::HOST).iter();
    let (first, second) = (values.next(), values.next());
    let wrong = |detail: &str| Err(Problem::new(Kind::BadRequest, detail));
    match (first, second) {
        (None, _) if version < Version::HTTP_11 => Ok(None),
        (None, _) => wrong("the request has no Host header, which HTTP/1.1 demands"),
        (Some(_), Some(_)) => wrong("the request has more than one Host header"),
        (Some(value), None) => match Authority::try_from(value.as_bytes()) {
            Ok(authority) if !authority.as_str().contains('@') => Ok(Some(authority)),
            _ => wrong("the Host header is no name or address with or without a port"),
        },
    }
}

fn refuse_others(hosts: &Hosts, authority: &Authority) -> Result<(), Problem> {
    let host = authority.host();
    if host.len() > LONGEST {
        return Err(Problem::new(
            Kind::BadRequest,
            format!("the name of a host has {LONGEST} characters at most"),
        ));
    }
    if hosts.include(host) {
        return Ok(());
    }
    let detail = format!(
        "this service does not answer for the host {host:?}; if it is reached under that name, start it with --host {host}"
    );
    Err(Problem::new(Kind::Misdirected, detail))
}
