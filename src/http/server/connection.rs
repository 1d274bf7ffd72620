//! Service of one connection: its requests one after the other, from the first byte to the last.

use std::convert::Infallible;
use std::net::SocketAddr;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::{ConnectInfo, Request};
use axum::response::Response;
use hyper::body::{Frame, Incoming, SizeHint};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::TokioIo;
use tokio::net::TcpStream;
use tokio_util::sync::CancellationToken;
use tower::ServiceExt;

use super::activity::Activity;
use super::stream::ClientStream;

/// Largest head of a request in bytes: far more than any client of this service needs.
const HEAD_BYTES: usize = 64 << 10;

/// Extension of answers that report changes as they come, for as long as there may be any.
#[derive(Debug, Clone, Copy)]
pub(in crate::http) struct Lasting;

/// Serves a connection until it ends or, once `stop` is cancelled, until the request under way has ended.
pub(super) async fn serve(
    stream: TcpStream,
    peer: SocketAddr,
    router: Router,
    activity: Arc<Activity>,
    stop: CancellationToken,
) {
    // An answer whose last piece is small shall not wait for the client to acknowledge the piece before.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%peer, %error, "could not make a connection quick");
    }
    let io = TokioIo::new(ClientStream::new(stream, Arc::clone(&activity)));
    let service = service_fn(move |request| answer(router.clone(), request, peer, Arc::clone(&activity)));
    let mut connection = pin!(
        http1::Builder::new()
            // Whoever has said all it has to say may shut its side down and wait for the answer.
            .half_close(true)
            .max_header_size(HEAD_BYTES)
            // `Activity` looks after time.
            .header_read_timeout(None)
            .serve_connection(io, service)
    );
    let served = tokio::select! {
        served = connection.as_mut() => served,
        () = stop.cancelled() => {
            connection.as_mut().graceful_shutdown();
            connection.await
        }
    };
    if let Err(error) = served {
        tracing::debug!(%peer, %error, "a connection broke off");
    }
}

async fn answer(
    router: Router,
    request: hyper::Request<Incoming>,
    peer: SocketAddr,
    activity: Arc<Activity>,
) -> Result<hyper::Response<Outgoing>, Infallible> {
    activity.request();
    let awaited = Arc::clone(&activity);
    let mut request: Request = request.map(|body| Body::new(Awaited { body, activity: awaited }));
    request.extensions_mut().insert(ConnectInfo(peer));
    let response: Response = router.oneshot(request).await?;
    if response.extensions().get::<Lasting>().is_some() {
        activity.lasts();
    }
    Ok(response.map(|body| Outgoing { body, activity }))
}

/// Body of a request that reports when the service waits for it.
struct Awaited {
    body: Incoming,
    activity: Arc<Activity>,
}

impl hyper::body::Body for Awaited {
    type Data = Bytes;
    type Error = hyper::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, hyper::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(context);
        match &frame {
            Poll::Pending => self.activity.body_expected(),
            Poll::Ready(frame) => {
                let bytes = frame.iter().flatten().filter_map(Frame::data_ref).map(Bytes::len).sum::<usize>();
                self.activity.body_came(bytes as u64);
            }
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

/// Body of an answer that reports when all of it is on its way.
struct Outgoing {
    body: Body,
    activity: Arc<Activity>,
}

impl hyper::body::Body for Outgoing {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for Outgoing {
    fn drop(&mut self) {
        self.activity.answered();
    }
}
