//! Refusal of requests that a page of another site makes a browser send.
//!
//! A service without tokens knows no user, so that only the browser's own headers tell a page of another site from the service's
//! page. A `POST` without a body needs no preflight: it would be carried out, although that page cannot read the answer.

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, header};
use axum::middleware::Next;
use axum::response::Response;

use super::problem::{Kind, Problem};
use super::state::AppState;

/// Header in which browsers state how the requesting page is related to the service (Fetch Metadata).
const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// Middleware: refuses requests that may change something and come from a page of another origin, unless the service has tokens,
/// which no other page has, or names that origin with `--cors-origin`.
pub(super) async fn refuse(
    state: State<AppState>,
    request: Request,
    next: Next,
) -> Result<Response, Problem> {
    let reads = [Method::GET, Method::HEAD, Method::OPTIONS].contains(request.method());
    if reads || state.tokens.is_some() || comes_from_here(request.headers(), &state.transport.cors_origins) {
        return Ok(next.run(request).await);
    }
    let detail = "the request comes from a page of another site; if that page may use this service, start the service with \
                  --cors-origin and the page's scheme and host";
    Err(Problem::new(Kind::CrossSite, detail))
}

/// Whether a request comes from no page, from the service's own, or from one of `origins`.
fn comes_from_here(headers: &HeaderMap, origins: &[HeaderValue]) -> bool {
    let origin = headers.get(header::ORIGIN);
    if origin.is_some_and(|origin| origins.contains(origin)) {
        return true;
    }
    match headers.get(SITE) {
        Some(site) => site == "same-origin" || site == "none",
        // Browsers of before 2023: the origin is the scheme and what `Host` says.
        None => origin.is_none_or(|origin| {
            let host = origin.as_bytes().splitn(2, |byte| *byte == b'/').nth(1);
            let host = host.and_then(|host| host.strip_prefix(b"/"));
            host.is_some() && host == headers.get(header::HOST).map(HeaderValue::as_bytes)
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn here(headers: &[(&'static str, &'static str)]) -> bool {
        let pairs = headers
            .iter()
            .map(|&(name, value)| (HeaderName::from_static(name), HeaderValue::from_static(value)));
        comes_from_here(&pairs.collect(), &[HeaderValue::from_static("https://tools.example")])
    }

    #[test]
    fn the_browser_s_word_on_the_site_decides() {
        assert!(here(&[]));
        assert!(here(&[
            ("sec-fetch-site", "same-origin"),
            ("origin", "https://proxy.example"),
            ("host", "127.0.0.1:8080")
        ]));
        assert!(here(&[("sec-fetch-site", "none")]));
        assert!(!here(&[("sec-fetch-site", "cross-site"), ("origin", "https://evil.example")]));
        assert!(!here(&[("sec-fetch-site", "same-site")]));
        assert!(here(&[("sec-fetch-site", "cross-site"), ("origin", "https://tools.example")]));
    }

    #[test]
    fn without_it_the_origin_must_be_the_host() {
        assert!(here(&[("origin", "http://127.0.0.1:8080"), ("host", "127.0.0.1:8080")]));
        assert!(!here(&[("origin", "http://127.0.0.1:3000"), ("host", "127.0.0.1:8080")]));
        assert!(!here(&[("origin", "null"), ("host", "127.0.0.1:8080")]));
        assert!(!here(&[("origin", "https://evil.example")]));
        assert!(here(&[("origin", "https://tools.example"), ("host", "127.0.0.1:8080")]));
    }
}
