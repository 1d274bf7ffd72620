//! Limit on the time for which bodies of requests may stall.

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::{Request, State};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use hyper::body::{Frame, SizeHint};
use tokio::time::{Instant, Sleep, sleep_until};

use super::pace::{PIECE, Pace};
use super::problem::{Kind, Problem};
use super::state::AppState;

/// Middleware: gives up a body whose next 64 KiB keep the service waiting for too long.
pub(super) async fn keep_coming(state: State<AppState>, request: Request, next: Next) -> Response {
    let patience = state.transport.limits.stall;
    let stalled = Arc::new(AtomicBool::new(false));
    let told = Arc::clone(&stalled);
    let response = next.run(request.map(|body| Body::new(Patient::new(body, patience, told)))).await;
    if !stalled.load(Ordering::Relaxed) {
        return response;
    }
    // Whatever the handler made of a body that broke off.
    let detail = format!(
        "the next {} KiB of the body, or its end, did not come within {} s; send the request again",
        PIECE >> 10,
        patience.as_secs()
    );
    Problem::new(Kind::UploadStalled, detail).into_response()
}

/// Body of a request with a limit on the wait for its next piece. Time in which nobody reads the body does not count.
struct Patient {
    body: Body,
    patience: Duration,
    pace: Pace,
    /// Begin of the present wait for the body, and the timer that ends it.
    waiting: Option<(Instant, Pin<Box<Sleep>>)>,
    stalled: Arc<AtomicBool>,
}

impl Patient {
    fn new(body: Body, patience: Duration, stalled: Arc<AtomicBool>) -> Self {
        Self { body, patience, pace: Pace::default(), waiting: None, stalled }
    }

    fn comes(&mut self, bytes: usize) {
        let waited = self.waiting.take().map_or(Duration::ZERO, |(since, _)| since.elapsed());
        self.pace.moves(bytes as u64, waited);
    }
}

impl hyper::body::Body for Patient {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(context);
        if let Poll::Ready(frame) = frame {
            if let Some(Ok(frame)) = &frame {
                self.comes(frame.data_ref().map_or(0, Bytes::len));
            }
            return Poll::Ready(frame);
        }
        let left = self.patience.saturating_sub(self.pace.waited());
        let (_, end) = self.waiting.get_or_insert_with(|| {
            let now = Instant::now();
            (now, Box::pin(sleep_until(now + left)))
        });
        if end.as_mut().poll(context).is_pending() {
            return Poll::Pending;
        }
        self.stalled.store(true, Ordering::Relaxed);
        Poll::Ready(Some(Err(axum::Error::new(std::io::Error::from(std::io::ErrorKind::TimedOut)))))
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
