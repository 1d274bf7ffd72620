//! The host that a request is meant for.
//!
//! A web page that a user visits can make the name it came from mean 127.0.0.1 (DNS rebinding) and then talk to the service as if it
//! were its own; the only sign is that name in `Host`.

use std::net::IpAddr;

use axum::extract::{Request, State};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, Version, header};
use axum::middleware::Next;
use axum::response::Response;

use super::AppState;
use super::problem::{Kind, Problem};

/// Longest name of a host (RFC 1035).
const LONGEST: usize = 253;

/// For which hosts the service answers.
#[derive(Debug)]
pub(super) struct Hosts {
    bound: IpAddr,
    names: Vec<String>,
}

impl Hosts {
    pub(super) fn new(bound: IpAddr, names: Vec<String>) -> Self {
        Self { bound, names }
    }

    /// Whether requests for `host` are answered: for all of them if the service can be reached from elsewhere and nobody said under
    /// which names.
    fn include(&self, host: &str) -> bool {
        if self.names.is_empty() && !self.bound.is_loopback() {
            return true;
        }
        let address = host.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        address.is_ok_and(|address| address.is_loopback() || address == self.bound)
            || host.eq_ignore_ascii_case("localhost")
            || self.names.iter().any(|name| name.eq_ignore_ascii_case(host))
    }
}

/// Middleware: refuses requests that do not say which host they are meant for, or name another.
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

/// What `Host` says; exactly one is needed since HTTP/1.1.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn hosts(bound: &str, names: &[&str]) -> Hosts {
        Hosts::new(bound.parse().unwrap(), names.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn a_loopback_service_answers_for_this_machine_only() {
        let local = hosts("127.0.0.1", &[]);
        for host in ["localhost", "LocalHost", "127.0.0.1", "127.1.2.3", "[::1]"] {
            assert!(local.include(host), "{host}");
        }
        for host in ["evil.example", "localhost.evil.example", "10.0.0.5", "127.0.0.1.evil.example", ""] {
            assert!(!local.include(host), "{host}");
        }
    }

    #[test]
    fn names_are_added_to_this_machine_s() {
        let named = hosts("127.0.0.1", &["Rubmap.example"]);
        assert!(named.include("rubmap.example") && named.include("localhost"));
        assert!(!named.include("evil.example"));
    }

    #[test]
    fn a_service_for_others_answers_for_any_host_unless_told() {
        assert!(hosts("0.0.0.0", &[]).include("anything.example"));
        let told = hosts("10.0.0.5", &["rubmap.example"]);
        assert!(told.include("rubmap.example") && told.include("10.0.0.5") && told.include("127.0.0.1"));
        assert!(!told.include("anything.example") && !told.include("10.0.0.6"));
    }
}
