//! Following of requests: each has an id, a line in the log when it has ended, and its share of the metrics.

use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Instant;

use axum::body::{Body, Bytes};
use axum::extract::{ConnectInfo, MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode};
use axum::middleware::Next;
use axum::response::Response;
use hyper::body::{Body as _, Frame, SizeHint};
use tracing::{Instrument, Span};

use super::state::AppState;
use super::transport::Transport;

/// Header with the id of a request, in the request and in its answer.
pub(super) const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// Longest id taken from a client.
const LONGEST_ID: usize = 64;

/// Longest part of a path that is logged, in characters.
const LONGEST_PATH: usize = 200;

/// Methods that are counted by name.
const METHODS: [&str; 7] = ["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"];

/// Middleware around everything: gives the request an id and follows it until its answer has gone.
pub(super) async fn follow(state: State<AppState>, request: Request, next: Next) -> Response {
    let id = id_of(request.headers());
    let span = tracing::info_span!("request", request.id = %id.to_str().unwrap_or_default());
    let mut followed = Followed::new(&state.transport, &request, span.clone());
    let mut response = next.run(request).instrument(span).await;
    response.headers_mut().insert(REQUEST_ID, id);
    followed.status = Some(response.status());
    response.map(|body| {
        // Bodies that are empty, or not sent for a HEAD, are not asked for.
        followed.whole = body.is_end_stream() || followed.method == "HEAD";
        Body::new(FollowedBody { body, followed })
    })
}

/// Id of a request: the client's, if it sent one that fits into a log; otherwise a new one.
fn id_of(headers: &HeaderMap) -> HeaderValue {
    let fits = |id: &&HeaderValue| {
        (1..=LONGEST_ID).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
    };
    headers.get(REQUEST_ID).filter(fits).cloned().unwrap_or_else(|| {
        let id = uuid::Uuid::now_v7().to_string();
        HeaderValue::try_from(id).unwrap_or_else(|_| HeaderValue::from_static("none"))
    })
}

/// Request that is followed until its answer has been sent or its client is gone; then it is logged and counted.
struct Followed {
    transport: Arc<Transport>,
    span: Span,
    begin: Instant,
    method: &'static str,
    /// Template of the route.
    route: Option<MatchedPath>,
    path: String,
    peer: Option<SocketAddr>,
    status: Option<StatusCode>,
    /// Bytes of the answer's body that were sent.
    bytes: u64,
    /// Whether all of the body was sent.
    whole: bool,
}

impl Followed {
    fn new(transport: &Arc<Transport>, request: &Request, span: Span) -> Self {
        let peer = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|peer| peer.0);
        Self {
            transport: Arc::clone(transport),
            span,
            begin: Instant::now(),
            method: known(request.method()),
            route: request.extensions().get::<MatchedPath>().cloned(),
            path: request.uri().path().chars().take(LONGEST_PATH).collect(),
            peer,
            status: None,
            bytes: 0,
            whole: false,
        }
    }
}

impl Drop for Followed {
    fn drop(&mut self) {
        let route = self.route.as_ref().map_or("none", MatchedPath::as_str);
        let took = self.begin.elapsed();
        let status = self.status.map(|status| status.as_u16());
        self.transport.metrics.request(self.method, route, status, took);
        self.span.in_scope(|| {
            tracing::info!(
                method = self.method,
                path = self.path,
                status,
                duration_ms = took.as_micros() as f64 / 1e3,
                bytes = self.bytes,
                whole = self.whole,
                peer = self.peer.map(tracing::field::display),
                "answered"
            );
        });
    }
}

/// Label of a method in the metrics; one for all methods that clients may invent.
fn known(method: &Method) -> &'static str {
    METHODS.into_iter().find(|known| *known == method.as_str()).unwrap_or("other")
}

/// Body of an answer that counts its bytes while they are sent.
struct FollowedBody {
    body: Body,
    followed: Followed,
}

impl hyper::body::Body for FollowedBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(context);
        match &frame {
            Poll::Ready(Some(Ok(frame))) => {
                self.followed.bytes += frame.data_ref().map_or(0, Bytes::len) as u64;
                self.followed.whole = self.body.is_end_stream();
            }
            Poll::Ready(None) => self.followed.whole = true,
            Poll::Ready(Some(Err(_))) | Poll::Pending => {}
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(id: &'static [u8]) -> bool {
        let headers = HeaderMap::from_iter([(REQUEST_ID, HeaderValue::from_bytes(id).unwrap())]);
        id_of(&headers).as_bytes() == id
    }

    #[test]
    fn ids_of_clients_are_kept_if_they_fit_into_a_log() {
        assert!(kept(b"a") && kept(&[b'a'; 64]) && kept(b"0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10"));
        assert!(!kept(b"") && !kept(&[b'a'; 65]) && !kept(b"two words") && !kept(b"\xc3\xa9"));
        assert_ne!(id_of(&HeaderMap::new()), id_of(&HeaderMap::new()));
    }

    #[test]
    fn invented_methods_are_one() {
        assert_eq!(known(&Method::DELETE), "DELETE");
        assert_eq!(known(&Method::from_bytes(b"BREW").unwrap()), "other");
    }
}
