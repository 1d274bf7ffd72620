//! Large answers: written on a thread of their own, in pieces, while they are sent.

use std::io::{self, Write};
use std::sync::Arc;

use axum::body::{Body, Bytes};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use futures::{StreamExt, stream};
use serde::Serialize;
use serde::ser::Error;
use tokio::sync::mpsc::{Receiver, Sender, channel};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::problem::{Kind, Problem};
use crate::jobs::{Allowance, Jobs};

/// Media type of archives.
pub(super) const ZIP: &str = "application/zip";

/// Bytes of a piece.
const PIECE: usize = 1 << 16;

/// Pieces that wait for the client.
const WAITING: usize = 4;

/// Bounds how many large answers are made at once, and the memory they take.
#[derive(Debug, Clone)]
pub struct LargeAnswers {
    turns: Arc<Semaphore>,
}

/// Leave to make a large answer, for as long as it is made: it goes with what is read and drawn from thread to thread, whether or
/// not somebody still waits for the answer.
#[derive(Debug)]
pub(super) struct Leave {
    _turn: Option<OwnedSemaphorePermit>,
    _memory: Allowance,
}

impl LargeAnswers {
    /// No more than `most` at once.
    pub fn new(most: usize) -> Self {
        Self { turns: Arc::new(Semaphore::new(most)) }
    }

    /// Waits until an answer may be made that takes `bytes` of memory meanwhile.
    pub(super) async fn leave(&self, jobs: &Jobs, bytes: u64) -> Leave {
        // Refused only once the semaphore is closed, which nobody does.
        let turn = Arc::clone(&self.turns).acquire_owned().await.ok();
        Leave { _turn: turn, _memory: jobs.answer_memory(bytes).await }
    }
}

/// What `read` gives, read on a thread that may wait and compute.
pub(super) async fn blocking<T, F>(read: F) -> Result<T, Problem>
where
    T: Send + 'static,
    F: FnOnce() -> T + Send + 'static,
{
    tokio::task::spawn_blocking(read)
        .await
        .map_err(|_| Problem::new(Kind::Internal, "a defect of the program; the service's log says more"))
}

/// An answer that is there as a whole.
pub(super) fn whole(
    leave: Leave,
    content_type: &'static str,
    body: impl AsRef<[u8]> + Send + 'static,
) -> Response {
    written(leave, content_type, move |pieces| pieces.write_all(body.as_ref()))
}

/// A zip archive of this name, which `write` writes on a thread that may wait and compute.
pub(super) fn zip(
    leave: Leave,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
) -> Response {
    let disposition = (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\""));
    ([disposition], written(leave, ZIP, write)).into_response()
}

/// An answer that `write` writes on a thread that may wait and compute. What fails once the answer has begun breaks it
/// off, so that nobody takes it for whole.
pub(super) fn written(
    leave: Leave,
    content_type: &'static str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
) -> Response {
    let (sender, receiver) = channel(WAITING);
    tokio::task::spawn_blocking(move || {
        let _leave = leave;
        let mut pieces = Pieces { sender, piece: Vec::with_capacity(PIECE), whole: false };
        match write(&mut pieces).and_then(|()| pieces.flush()) {
            Ok(()) => pieces.whole = true,
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {}
            Err(error) => tracing::error!(%error, "an answer broke off"),
        }
    });
    ([(header::CONTENT_TYPE, content_type)], Body::from_stream(pieces_of(receiver))).into_response()
}

fn pieces_of(receiver: Receiver<io::Result<Bytes>>) -> impl stream::Stream<Item = io::Result<Bytes>> {
    // Compression asks once more after the end.
    stream::unfold(receiver, |mut receiver| async move { Some((receiver.recv().await?, receiver)) }).fuse()
}

/// Sends what is written, piece by piece, and waits for the client to take them.
struct Pieces {
    sender: Sender<io::Result<Bytes>>,
    piece: Vec<u8>,
    /// Whether all of it was sent.
    whole: bool,
}

impl Drop for Pieces {
    /// What is not whole, after an error or a panic, must not look so.
    fn drop(&mut self) {
        if !self.whole {
            // Nobody waits for it any more, perhaps.
            let _ = self.sender.blocking_send(Err(io::Error::other("the answer broke off")));
        }
    }
}

impl Write for Pieces {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(PIECE - self.piece.len());
        self.piece.extend_from_slice(&bytes[..taken]);
        if self.piece.len() == PIECE {
            self.flush()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.piece.is_empty() {
            return Ok(());
        }
        let piece = std::mem::replace(&mut self.piece, Vec::with_capacity(PIECE));
        let gone = |_| io::Error::new(io::ErrorKind::BrokenPipe, "the client is gone");
        self.sender.blocking_send(Ok(piece.into())).map_err(gone)
    }
}

/// A sequence whose items are read as they are written.
pub(super) struct Read<F> {
    /// Number of items.
    pub(super) items: u32,
    /// Reads the item of this index.
    pub(super) item: F,
}

impl<T: Serialize, E: std::fmt::Display, F: Fn(u32) -> Result<T, E>> Serialize for Read<F> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeSeq;

        let mut sequence = serializer.serialize_seq(Some(self.items as usize))?;
        for index in 0..self.items {
            sequence.serialize_element(&(self.item)(index).map_err(S::Error::custom)?)?;
        }
        sequence.end()
    }
}
