//! Large answers: written on a thread of their own, in pieces, while they are sent.

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
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
use super::spool::{Held, Later, Spool};
use crate::jobs::{Allowance, Jobs};

/// Media type of archives.
pub(super) const ZIP: &str = "application/zip";

/// Bytes of a piece of an answer.
const PIECE: usize = 1 << 16;

/// Number of pieces of an answer that wait for the client in memory.
const WAITING: usize = 4;

/// Time for which an answer keeps its place for a client that takes it more slowly than it is made.
const PATIENCE: Duration = Duration::from_secs(1);

/// Longest wait of each piece for its client where files have no room, or for room in the file.
const STALLED: Duration = Duration::from_secs(30);

/// Largest number of bytes of all answers that wait for slow clients in files.
const MOST_SPOOLED: u64 = 4 << 30;

/// Bounds on large answers: how many are made at once, the memory they take, and the room of those that wait for their clients.
#[derive(Debug, Clone)]
pub struct LargeAnswers {
    turns: Arc<Semaphore>,
    /// Answers that wait for a turn.
    waiting: Arc<AtomicUsize>,
    spool: Arc<Spool>,
}

/// Permission to make a large answer, for as long as it is made: it goes with what is read and drawn from thread to thread, whether
/// or not anybody still waits for the answer.
#[derive(Debug)]
pub(super) struct Leave {
    _turn: Option<OwnedSemaphorePermit>,
    _memory: Allowance,
    waiting: Arc<AtomicUsize>,
    spool: Arc<Spool>,
}

impl LargeAnswers {
    /// Allows `most` answers at once; those that wait for slow clients lie in `folder`.
    pub fn new(most: usize, folder: &Path) -> Self {
        let spool = Arc::new(Spool::new(folder, MOST_SPOOLED));
        Self { turns: Arc::new(Semaphore::new(most)), waiting: Arc::default(), spool }
    }

    /// Bytes of answers that wait for slow clients.
    pub(super) fn spooled_bytes(&self) -> u64 {
        self.spool.bytes()
    }

    /// Waits until an answer may be made that takes `bytes` of memory meanwhile.
    pub(super) async fn leave(&self, jobs: &Jobs, bytes: u64) -> Leave {
        let waits = Waits::among(&self.waiting);
        // Refused only once the semaphore is closed, which nobody does.
        let turn = Arc::clone(&self.turns).acquire_owned().await.ok();
        drop(waits);
        Leave {
            _turn: turn,
            _memory: jobs.answer_memory(bytes).await,
            waiting: Arc::clone(&self.waiting),
            spool: Arc::clone(&self.spool),
        }
    }
}

/// One of those that wait for a turn, counted until it is dropped: also where the client has gone.
struct Waits<'a>(&'a AtomicUsize);

impl<'a> Waits<'a> {
    fn among(waiting: &'a AtomicUsize) -> Self {
        waiting.fetch_add(1, Ordering::Relaxed);
        Self(waiting)
    }
}

impl Drop for Waits<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Runs `read` on a thread that may wait and compute.
pub(super) async fn blocking<T, F>(read: F) -> Result<T, Problem>
where
    T: Send + 'static,
    F: FnOnce() -> T + Send + 'static,
{
    tokio::task::spawn_blocking(read)
        .await
        .map_err(|_| Problem::new(Kind::Internal, "a defect of the program; the service's log says more"))
}

/// Answers with a body that is there as a whole.
pub(super) fn whole(
    leave: Leave,
    content_type: &'static str,
    body: impl AsRef<[u8]> + Send + 'static,
) -> Response {
    written(leave, content_type, move |pieces| pieces.write_all(body.as_ref()))
}

/// Answers with a zip archive of this name, which `write` writes on a thread that may wait and compute.
pub(super) fn zip(
    leave: Leave,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
) -> Response {
    let disposition = (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\""));
    ([disposition], written(leave, ZIP, write)).into_response()
}

/// Answers with a body that `write` writes on a thread that may wait and compute. A client that takes it more slowly than it is
/// made gets the rest from a file, so that its place and memory are free for others. An error after the answer has begun breaks it
/// off, so that nobody takes it for whole.
pub(super) fn written(
    leave: Leave,
    content_type: &'static str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
) -> Response {
    let (sender, receiver) = channel(WAITING);
    let (end, rest) = oneshot::channel();
    tokio::task::spawn_blocking(move || {
        let spool = Some(Arc::clone(&leave.spool));
        let waiting = Arc::clone(&leave.waiting);
        let piece = Vec::with_capacity(PIECE);
        let mut pieces = Pieces { sender, piece, patience: PATIENCE, waiting, spool, later: None };
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

/// Progress of sending an answer.
enum Sent {
    Pieces(Receiver<Bytes>, oneshot::Receiver<io::Result<Option<Later>>>),
    File(tokio::fs::File, Held),
    All,
}

/// Body of an answer: first the pieces that were taken at once, then those that wait in a file. After a panic it is not whole, and must not look so.
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

/// Writer of an answer: sends it piece by piece, as long as the client takes them in time, and writes the rest to a file.
struct Pieces {
    sender: Sender<Bytes>,
    piece: Vec<u8>,
    /// Time for which the client is still waited for before the rest goes to a file.
    patience: Duration,
    /// Answers that wait for a turn: while there are any, no client is waited for.
    waiting: Arc<AtomicUsize>,
    /// None once a file could not be made.
    spool: Option<Arc<Spool>>,
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

    /// Writes a piece to the file of the answer; waits for room while the client is there, at most [`STALLED`].
    fn keep(sender: &Sender<Bytes>, later: &mut Later, piece: &[u8]) -> io::Result<()> {
        let begin = Instant::now();
        loop {
            if sender.is_closed() {
                return Err(gone());
            }
            if later.add(piece)? {
                return Ok(());
            }
            if begin.elapsed() > STALLED {
                return Err(stalled("answers that wait for slow clients take all room there is for them"));
            }
            std::thread::sleep(FOR_ROOM);
        }
    }
}

/// Time between two checks for room.
const FOR_ROOM: Duration = Duration::from_millis(50);

fn stalled(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::TimedOut, reason)
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
            return Self::keep(&self.sender, later, &piece);
        }
        let mut piece = Bytes::from(piece);
        if let Some(spool) = self.spool.clone() {
            let others_wait = self.waiting.load(Ordering::Relaxed) > 0;
            let patience = if others_wait { Duration::ZERO } else { self.patience };
            let Some(refused) = self.send(piece, patience)? else { return Ok(()) };
            match spool.begin().and_then(|mut later| Ok(later.add(&refused)?.then_some(later))) {
                Ok(Some(later)) => {
                    self.later = Some(later);
                    return Ok(());
                }
                Ok(None) => {}
                Err(error) => {
                    tracing::warn!(%error, "an answer waits for its client in its place");
                    self.spool = None;
                }
            }
            piece = refused;
        }
        // Without room in a file the client must take it, in its time.
        self.send(piece, STALLED)?.map_or(Ok(()), |_| Err(stalled("the client does not take it")))
    }
}

/// Sequence whose items are read as they are written.
pub(super) struct Read<F> {
    /// Number of items.
    pub(super) items: u32,
    /// Reader of the item of an index.
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
        Arc::new(Spool::new(folder, MOST_SPOOLED))
    }

    fn answer(spool: &Arc<Spool>, body: Vec<u8>) -> (Body, oneshot::Receiver<()>) {
        let (done, made) = oneshot::channel();
        let leave = Leave {
            _turn: None,
            _memory: Allowance::default(),
            waiting: Arc::default(),
            spool: Arc::clone(spool),
        };
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
        assert!(spool.bytes() > 0);
        let whole = axum::body::to_bytes(body, usize::MAX).await.unwrap();
        assert!(whole == bytes(20));
        assert_eq!(spool.bytes(), 0, "given back");
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
        while spool.bytes() > 0 {
            tokio::task::yield_now().await;
        }
    }

    /// Checks two answers of which one fits: the other goes on once its client or the first one's reads.
    #[tokio::test(flavor = "multi_thread")]
    async fn a_full_spool_delays_answers_and_cuts_none_off() {
        let folder = tempfile::tempdir().unwrap();
        let most = 24 * PIECE as u64;
        let spool = Arc::new(Spool::new(folder.path(), most));
        let (first, first_made) = answer(&spool, bytes(20));
        assert!(first_made.await.is_err());
        let (second, _second_made) = answer(&spool, bytes(20));
        while spool.bytes() + (PIECE as u64) < most {
            tokio::time::sleep(FOR_ROOM).await;
        }
        for body in [first, second] {
            assert!(axum::body::to_bytes(body, usize::MAX).await.unwrap() == bytes(20));
        }
        assert_eq!(spool.bytes(), 0, "given back");
    }

    /// A client that may be waited for an hour is not waited for at all.
    #[tokio::test(flavor = "multi_thread")]
    async fn while_others_wait_no_client_is_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let (sender, receiver) = channel(WAITING);
        let mut pieces = Pieces {
            sender,
            piece: Vec::with_capacity(PIECE),
            patience: Duration::from_secs(3600),
            waiting: Arc::new(AtomicUsize::new(1)),
            spool: Some(spool(folder.path())),
            later: None,
        };
        let written = tokio::task::spawn_blocking(move || pieces.write_all(&bytes(20)).map(|()| pieces));
        let pieces = written.await.unwrap().unwrap();
        assert!(pieces.later.is_some());
        drop(receiver);
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn what_breaks_off_is_not_taken_for_whole() {
        let folder = tempfile::tempdir().unwrap();
        let spool = spool(folder.path());
        let leave = Leave { _turn: None, _memory: Allowance::default(), waiting: Arc::default(), spool };
        let response = written(leave, ZIP, |pieces| {
            pieces.write_all(&bytes(1))?;
            Err(io::Error::other("a defect"))
        });
        assert!(axum::body::to_bytes(response.into_body(), usize::MAX).await.is_err());
    }
}
