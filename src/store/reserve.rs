//! Disk space reserved for deletions: on a full disk they, too, have to write something before they release any.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::sync::Mutex;

/// Name of the file that occupies the reserved space, in the data folder.
pub(super) const FILE: &str = "reserve";

/// Size of the reserve in bytes: that of the write-ahead log between two checkpoints.
pub(super) const BYTES: u64 = 4 << 20;

/// Free space in bytes that must be left beside a new reserve.
const BESIDE: u64 = 1 << 20;

/// Free space in bytes that is left to data that cannot be computed or fetched again.
const LEFT_FREE: u64 = 4 * BYTES;

/// Reserve of disk space: a file that is removed when a deletion finds no room. From then on the disk counts as full for all other writes,
/// until there is room for a new reserve: running work would take the room before the next deletion does.
#[derive(Debug, Clone)]
pub(super) struct Reserve {
    data: PathBuf,
    taken: Arc<AtomicBool>,
    /// Lock held while the file is made or removed.
    changing: Arc<Mutex<()>>,
}

impl Reserve {
    /// Reserve of the data folder `data`.
    pub(super) fn of(data: &Path) -> Self {
        Self { data: data.to_owned(), taken: Arc::default(), changing: Arc::default() }
    }

    /// Whether a deletion has taken the reserve.
    pub(super) fn is_taken(&self) -> bool {
        self.taken.load(Ordering::Relaxed)
    }

    /// Refuses to write while deletions have the last room.
    pub(super) async fn expect_room(&self) -> io::Result<()> {
        if self.is_taken() && !self.keep().await? { Err(ErrorKind::StorageFull.into()) } else { Ok(()) }
    }

    /// Refuses to write so many bytes of data that can be computed or fetched again, where that would leave too little room for other data.
    pub(super) fn expect_room_for(&self, bytes: u64) -> io::Result<()> {
        if let Ok(free) = free_bytes(&self.data)
            && (self.is_taken() || free < bytes.saturating_add(LEFT_FREE))
        {
            return Err(ErrorKind::StorageFull.into());
        }
        Ok(())
    }

    /// Makes the reserve if it is missing and there is room for it. Returns whether it is there.
    pub(super) async fn keep(&self) -> io::Result<bool> {
        let _changing = self.changing.lock().await;
        let data = self.data.clone();
        let is_there = tokio::task::spawn_blocking(move || make(&data)).await.map_err(io::Error::other)??;
        if is_there {
            self.taken.store(false, Ordering::Relaxed);
        }
        Ok(is_there)
    }

    /// Gives the reserve to a deletion. Returns whether there was one, now or for an earlier deletion.
    pub(super) async fn take(&self) -> bool {
        let _changing = self.changing.lock().await;
        // The flag comes first, so that nobody writes in between.
        let earlier = self.taken.swap(true, Ordering::Relaxed);
        let removed = tokio::fs::remove_file(self.data.join(FILE)).await.is_ok();
        if removed {
            tracing::warn!("the disk is full: a deletion takes the room that is kept for it");
        }
        self.taken.store(earlier || removed, Ordering::Relaxed);
        earlier || removed
    }
}

/// Makes the file of the reserve if there is room. Returns whether it is there.
fn make(data: &Path) -> io::Result<bool> {
    let file = data.join(FILE);
    // A shorter file is left from an interrupted start.
    if file.metadata().is_ok_and(|found| found.len() == BYTES) {
        return Ok(true);
    }
    if free_bytes(data)? <= BYTES + BESIDE {
        return Ok(false);
    }
    std::fs::write(&file, vec![0; BYTES as usize])?;
    Ok(true)
}

/// Free space on the disk of the data folder `data` for this process, bytes.
pub(super) fn free_bytes(data: &Path) -> io::Result<u64> {
    let disk = rustix::fs::statvfs(data)?;
    Ok(disk.f_bavail.saturating_mul(disk.f_frsize))
}
