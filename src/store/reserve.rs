//! Room that is kept for deletions: on a full disk they, too, have to write something before they give anything back.

use std::io::{self, ErrorKind};
use std::path::Path;
use std::sync::atomic::Ordering;

use super::error::StoreError;
use super::handle::Store;

/// Name of the file that takes the room, in the data folder.
const RESERVE: &str = "reserve";

/// Its size: what the write-ahead log grows to between two checkpoints.
const BYTES: u64 = 4 << 20;

/// It is made only where so much is left beside it.
const BESIDE: u64 = 1 << 20;

impl Store {
    /// Runs `remove`, and on a full disk once more with the room of the reserve. From then on the disk is full for all else that is
    /// written, until there is room for a new one: work that goes on would take it before the next deletion does.
    pub(super) async fn with_reserve<T, F>(&self, remove: impl Fn() -> F) -> Result<T, StoreError>
    where
        F: Future<Output = Result<T, StoreError>>,
    {
        match remove().await {
            Err(error) if error.is_disk_full() => {
                self.reserve_taken.store(true, Ordering::Relaxed);
                if tokio::fs::remove_file(self.folder.join(RESERVE)).await.is_err() {
                    return Err(error);
                }
                tracing::warn!("the disk is full: a deletion takes the room that is kept for it");
                remove().await
            }
            outcome => outcome,
        }
    }

    /// Refuses to write while deletions have the last room.
    pub(super) async fn expect_room(&self) -> io::Result<()> {
        let refused = self.reserve_taken.load(Ordering::Relaxed) && !self.keep_reserve().await;
        if refused { Err(ErrorKind::StorageFull.into()) } else { Ok(()) }
    }

    /// Keeps the reserve if it is not there and there is room for it. Returns whether it is there.
    pub(super) async fn keep_reserve(&self) -> bool {
        let reserve = self.folder.join(RESERVE);
        let is_there = reserve.exists() || {
            let fits = self.free_bytes().is_ok_and(|free| free > BYTES + BESIDE);
            fits && matches!(tokio::task::spawn_blocking(move || make(&reserve)).await, Ok(Ok(())))
        };
        if is_there {
            self.reserve_taken.store(false, Ordering::Relaxed);
        }
        is_there
    }
}

fn make(reserve: &Path) -> io::Result<()> {
    let made = std::fs::write(reserve, vec![0; BYTES as usize]);
    if made.is_err() {
        match std::fs::remove_file(reserve) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[tokio::test]
    async fn a_deletion_has_the_reserve_once() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let full = || StoreError::File(ErrorKind::StorageFull.into());
        let attempts = Cell::new(0);
        let second = || {
            attempts.set(attempts.get() + 1);
            let outcome = if attempts.get() == 2 { Ok(attempts.get()) } else { Err(full()) };
            async { outcome }
        };
        assert!(store.with_reserve(second).await.unwrap_err().is_disk_full());
        assert_eq!(attempts.take(), 1, "there was no reserve");

        assert!(store.keep_reserve().await);
        assert_eq!(folder.path().join(RESERVE).metadata().unwrap().len(), BYTES);
        assert_eq!(store.with_reserve(second).await.unwrap(), 2);
        assert!(!folder.path().join(RESERVE).exists());
        // The first that writes, now that there is room, keeps a new one.
        assert!(store.reserve_taken.load(Ordering::Relaxed));
        store.probe().await.unwrap();
        assert!(folder.path().join(RESERVE).exists() && !store.reserve_taken.load(Ordering::Relaxed));
        // Other failures leave it alone.
        assert!(store.with_reserve(|| async { Err::<(), _>(StoreError::Spectra) }).await.is_err());
        assert!(folder.path().join(RESERVE).exists());
    }
}
