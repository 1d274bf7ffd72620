//! Room that is kept for deletions: on a full disk they, too, have to write something before they give anything back.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::sync::Mutex;

/// Name of the file that takes the room, in the data folder.
pub(super) const FILE: &str = "reserve";

/// Its size: what the write-ahead log grows to between two checkpoints.
pub(super) const BYTES: u64 = 4 << 20;

/// It is made only where so much is left beside it.
const BESIDE: u64 = 1 << 20;

/// Room that is left to what cannot be computed or fetched again.
const LEFT_FREE: u64 = 4 * BYTES;

/// A file that is removed when a deletion finds no room. From then on the disk is full for all else that is written, until there
/// is room for a new one: work that goes on would take it before the next deletion does.
#[derive(Debug, Clone)]
pub(super) struct Reserve {
    data: PathBuf,
    taken: Arc<AtomicBool>,
    /// Held while the file comes or goes.
    changing: Arc<Mutex<()>>,
}

impl Reserve {
    /// That of the data folder `data`.
    pub(super) fn of(data: &Path) -> Self {
        Self { data: data.to_owned(), taken: Arc::default(), changing: Arc::default() }
    }

    /// Whether a deletion has taken it.
    pub(super) fn is_taken(&self) -> bool {
        self.taken.load(Ordering::Relaxed)
    }

    /// Refuses to write while deletions have the last room.
    pub(super) async fn expect_room(&self) -> io::Result<()> {
        if self.is_taken() && !self.keep().await? { Err(ErrorKind::StorageFull.into()) } else { Ok(()) }
    }

    /// Refuses to write so many bytes that can be computed or fetched again, where they would leave too little room to what cannot.
    pub(super) fn expect_room_for(&self, bytes: u64) -> io::Result<()> {
        if let Ok(free) = free_bytes(&self.data)
            && (self.is_taken() || free < bytes.saturating_add(LEFT_FREE))
        {
            return Err(ErrorKind::StorageFull.into());
        }
        Ok(())
    }

    /// Keeps the file if it is not there and there is room for it. Returns whether it is there.
    pub(super) async fn keep(&self) -> io::Result<bool> {
        let _changing = self.changing.lock().await;
        let data = self.data.clone();
        let is_there = tokio::task::spawn_blocking(move || make(&data)).await.map_err(io::Error::other)??;
        if is_there {
            self.taken.store(false, Ordering::Relaxed);
        }
        Ok(is_there)
    }

    /// Gives the room to a deletion. Returns whether there was some, now or for an earlier one.
    pub(super) async fn take(&self) -> bool {
        let _changing = self.changing.lock().await;
        // First, so that nobody writes in between.
        let earlier = self.taken.swap(true, Ordering::Relaxed);
        let removed = tokio::fs::remove_file(self.data.join(FILE)).await.is_ok();
        if removed {
            tracing::warn!("the disk is full: a deletion takes the room that is kept for it");
        }
        self.taken.store(earlier || removed, Ordering::Relaxed);
        earlier || removed
    }
}

/// Whether the file is there in the end.
fn make(data: &Path) -> io::Result<bool> {
    let file = data.join(FILE);
    // A shorter one is of a start that was killed.
    if file.metadata().is_ok_and(|found| found.len() == BYTES) {
        return Ok(true);
    }
    if free_bytes(data)? <= BYTES + BESIDE {
        return Ok(false);
    }
    std::fs::write(&file, vec![0; BYTES as usize])?;
    Ok(true)
}

/// Room on the disk of the data folder `data` for this process, in bytes.
pub(super) fn free_bytes(data: &Path) -> io::Result<u64> {
    let disk = rustix::fs::statvfs(data)?;
    Ok(disk.f_bavail.saturating_mul(disk.f_frsize))
}
