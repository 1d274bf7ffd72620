//! Large answers: written on a thread of their own, in pieces, while they are sent.

use std::fs::File;
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use futures::{StreamExt, stream};
use serde::Serialize;
use serde::ser::Error;
use tokio::io::AsyncReadExt;
use tokio::runtime::Handle;
use tokio::sync::mpsc::error::SendTimeoutError;
use tokio::sync::mpsc::{Receiver, Sender, channel};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};

use super::problem::{Kind, Problem};
use crate::jobs::{Allowance, Jobs};

/// Media type of archives.
pub(super) const ZIP: &str = "application/zip";

/// Bytes of a piece.
const PIECE: usize = 1 << 16;

/// Pieces that wait for the client.
const WAITING: usize = 4;

/// Time for which an answer keeps its place for a client that is slower than it is made.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time for which each piece waits where there is no room for the rest on the disk.
const STALLED: Duration = Duration::from_secs(30);

/// Bytes of all answers that wait for slow clients in files.
const MOST_SPOOLED: u64 = 4 << 30;

/// Bounds how many large answers are made at once, the memory they take, and the room of those that wait for their clients.
#[derive(Debug, Clone)]
pub struct LargeAnswers {
    turns: Arc<Semaphore>,
    spool: Arc<Spool>,
}

/// Leave to make a large answer, for as long as it is made: it goes with what is read and drawn from thread to thread, whether or
/// not somebody still waits for the answer.
#[derive(Debug)]
pub(super) struct Leave {
    _turn: Option<OwnedSemaphorePermit>,
    _memory: Allowance,
    spool: Arc<Spool>,
}

impl LargeAnswers {
    /// No more than `most` at once; what waits for slow clients lies in `folder`.
    pub fn new(most: usize, folder: &Path) -> Self {
        let spool = Spool { folder: folder.to_owned(), bytes: AtomicU64::new(0) };
        Self { turns: Arc::new(Semaphore::new(most)), spool: Arc::new(spool) }
    }

    /// Bytes that wait for slow clients.
    pub(super) fn spooled_bytes(&self) -> u64 {
        self.spool.bytes.load(Ordering::Relaxed)
    }

    /// Waits until an answer may be made that takes `bytes` of memory meanwhile.
    pub(super) async fn leave(&self, jobs: &Jobs, bytes: u64) -> Leave {
        // Refused only once the semaphore is closed, which nobody does.
        let turn = Arc::clone(&self.turns).acquire_owned().await.ok();
        Leave { _turn: turn, _memory: jobs.answer_memory(bytes).await, spool: Arc::clone(&self.spool) }
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

/// An answer that `write` writes on a thread that may wait and compute. A client that takes it more slowly than it is made gets the rest from a
/// file, so that its place and memory are free for others. What fails once the answer has begun breaks it off, so that nobody takes it for whole.
pub(super) fn written(
    leave: Leave,
    content_type: &'static str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
) -> Response {
    let (sender, receiver) = channel(WAITING);
    let (end, rest) = oneshot::channel();
    tokio::task::spawn_blocking(move || {
        let spool = Arc::clone(&leave.spool);
        let mut pieces =
            Pieces { sender, piece: Vec::with_capacity(PIECE), patience: PATIENCE, spool, later: None };
        let made = write(&mut pieces).and_then(|()| pieces.flush());
        drop(leave);
        let end_of_it = match (made, pieces.later.take()) {
            (Ok(()), later) => later.map(Later::rewound).transpose(),
            (Err(error), _) => {
                if error.kind() != io::ErrorKind::BrokenPipe {
                    tracing::error!(%error, "an answer broke off");
                }
                Err(error)
            }
        };
        // Nobody waits for it any more, perhaps.
        let _ = end.send(end_of_it);
    });
    ([(header::CONTENT_TYPE, content_type)], Body::from_stream(sent(receiver, rest))).into_response()
}

/// How far an answer has been sent.
enum Sent {
    Pieces(Receiver<Bytes>, oneshot::Receiver<io::Result<Option<Later>>>),
    File(tokio::fs::File, Held),
    All,
}

/// First what was taken at once, then what waits in a file. After a panic it is not whole, and must not look so.
fn sent(
    receiver: Receiver<Bytes>,
    rest: oneshot::Receiver<io::Result<Option<Later>>>,
) -> impl stream::Stream<Item = io::Result<Bytes>> {
    let next = |at: Sent| async move {
        let mut at = at;
        loop {
            match at {
                Sent::Pieces(mut receiver, rest) => match receiver.recv().await {
                    Some(piece) => return Some((Ok(piece), Sent::Pieces(receiver, rest))),
                    None => match rest.await {
                        Ok(Ok(None)) => return None,
                        Ok(Ok(Some(Later { file, held }))) => {
                            at = Sent::File(tokio::fs::File::from_std(file), held);
                        }
                        Ok(Err(_)) | Err(_) => return Some((Err(broken_off()), Sent::All)),
                    },
                },
                Sent::File(mut file, held) => {
                    let mut piece = vec![0; PIECE];
                    return match file.read(&mut piece).await {
                        Ok(0) => None,
                        Ok(length) => {
                            piece.truncate(length);
                            Some((Ok(piece.into()), Sent::File(file, held)))
                        }
                        Err(error) => Some((Err(error), Sent::All)),
                    };
                }
                Sent::All => return None,
            }
        }
    };
    // Compression asks once more after the end.
    stream::unfold(Sent::Pieces(receiver, rest), next).fuse()
}

fn broken_off() -> io::Error {
    io::Error::other("the answer broke off")
}

/// Files in which answers wait for slow clients. They have no names: what is left of them goes with the process.
#[derive(Debug)]
struct Spool {
    folder: PathBuf,
    bytes: AtomicU64,
}

/// Part of an answer that waits for its client.
struct Later {
    file: File,
    held: Held,
}

/// Bytes of the spool, for as long as they lie there.
struct Held {
    spool: Arc<Spool>,
    bytes: u64,
}

impl Spool {
    fn begin(self: &Arc<Self>) -> io::Result<Later> {
        let file = tempfile::tempfile_in(&self.folder)?;
        Ok(Later { file, held: Held { spool: Arc::clone(self), bytes: 0 } })
    }
}

impl Later {
    fn add(&mut self, piece: &[u8]) -> io::Result<()> {
        let length = piece.len() as u64;
        let before = self.held.spool.bytes.fetch_add(length, Ordering::Relaxed);
        self.held.bytes += length;
        if before + length > MOST_SPOOLED {
            return Err(io::Error::other("answers that wait for slow clients take too much room"));
        }
        self.file.write_all(piece)
    }

    fn rewound(mut self) -> io::Result<Self> {
        self.file.rewind()?;
        Ok(self)
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.spool.bytes.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

/// Sends what is written, piece by piece, as long as the client takes them in time, and writes the rest to a file.
struct Pieces {
    sender: Sender<Bytes>,
    piece: Vec<u8>,
    /// Time for which the client will still be waited for.
    patience: Duration,
    spool: Arc<Spool>,
    later: Option<Later>,
}

impl Pieces {
    /// Sends a piece if the client takes it within `time`; otherwise gives it back.
    fn send(&mut self, piece: Bytes, time: Duration) -> io::Result<Option<Bytes>> {
        let begin = Instant::now();
        let sent = Handle::current().block_on(self.sender.send_timeout(piece, time));
        self.patience = self.patience.saturating_sub(begin.elapsed());
        match sent {
            Ok(()) => Ok(None),
            Err(SendTimeoutError::Timeout(piece)) => Ok(Some(piece)),
            Err(SendTimeoutError::Closed(_)) => Err(gone()),
        }
    }
}

fn gone() -> io::Error {
    io::Error::new(io::ErrorKind::BrokenPipe, "the client is gone")
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
        if let Some(later) = &mut self.later {
            return if self.sender.is_closed() { Err(gone()) } else { later.add(&piece) };
        }
        let Some(piece) = self.send(piece.into(), self.patience)? else { return Ok(()) };
        match self.spool.begin().and_then(|mut later| later.add(&piece).map(|()| later)) {
            Ok(later) => self.later = Some(later),
            // Without room there the client must take it, in its time.
            Err(error) => {
                tracing::warn!(%error, "an answer waits for its client in its place");
                if self.send(piece, STALLED)?.is_some() {
                    return Err(io::Error::new(io::ErrorKind::TimedOut, "the client does not take it"));
                }
            }
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    fn spool(folder: &Path) -> Arc<Spool> {
        Arc::new(Spool { folder: folder.to_owned(), bytes: AtomicU64::new(0) })
    }

    fn answer(spool: &Arc<Spool>, body: Vec<u8>) -> (Body, oneshot::Receiver<()>) {
        let (done, made) = oneshot::channel();
        let leave = Leave { _turn: None, _memory: Allowance::default(), spool: Arc::clone(spool) };
        let response = written(leave, ZIP, move |pieces| {
            pieces.write_all(&body)?;
            pieces.flush()?;
            drop(done);
            Ok(())
        });
        (response.into_body(), made)
    }

    fn bytes(pieces: usize) -> Vec<u8> {
        (0..pieces * PIECE + 17).map(|k| (k % 251) as u8).collect()
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn a_client_that_takes_nothing_keeps_no_place_and_gets_all() {
        let folder = tempfile::tempdir().unwrap();
        let spool = spool(folder.path());
        let (body, made) = answer(&spool, bytes(20));
        // Made although nobody reads.
        assert!(made.await.is_err());
        assert!(spool.bytes.load(Ordering::Relaxed) > 0);
        let whole = axum::body::to_bytes(body, usize::MAX).await.unwrap();
        assert!(whole == bytes(20));
        assert_eq!(spool.bytes.load(Ordering::Relaxed), 0, "given back");
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn what_is_taken_at_once_needs_no_file() {
        let spool = spool(Path::new("/nowhere"));
        let (body, _) = answer(&spool, bytes(20));
        assert!(axum::body::to_bytes(body, usize::MAX).await.unwrap() == bytes(20));
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn who_leaves_gives_the_room_back() {
        let folder = tempfile::tempdir().unwrap();
        let spool = spool(folder.path());
        let (body, made) = answer(&spool, bytes(20));
        assert!(made.await.is_err());
        drop(body);
        while spool.bytes.load(Ordering::Relaxed) > 0 {
            tokio::task::yield_now().await;
        }
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn what_breaks_off_is_not_taken_for_whole() {
        let folder = tempfile::tempdir().unwrap();
        let leave = Leave { _turn: None, _memory: Allowance::default(), spool: spool(folder.path()) };
        let response = written(leave, ZIP, |pieces| {
            pieces.write_all(&bytes(1))?;
            Err(io::Error::other("a defect"))
        });
        assert!(axum::body::to_bytes(response.into_body(), usize::MAX).await.is_err());
    }
}
