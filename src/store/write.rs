//! Transactions: the only way to write.

use std::ops::{Deref, DerefMut};

use sqlx::pool::PoolConnection;
use sqlx::{Any, AnyConnection};

use super::changes::Changes;
use super::dialect::{Dialect, Guarded};
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;

/// Writing transaction. In `SQLite` it holds the lock for writing from its beginning.
///
/// Ended by [`Write::commit`] or [`Write::rollback`]. In every other case (an error, a request whose client is gone) the connection is
/// closed, and its transaction with it: after a full disk or an I/O error `SQLite` may have ended the transaction by itself or not, and a
/// connection that is wrong about that takes all later writes with it.
#[derive(Debug)]
pub(super) struct Write {
    connection: PoolConnection<Any>,
    dialect: Dialect,
    changes: Changes,
    ended: bool,
}

impl Store {
    /// Begins a transaction. While deletions have the last room, the disk counts as full for it.
    pub(super) async fn write(&self) -> Result<Write, StoreError> {
        self.reserve.expect_room().await?;
        self.write_removal().await
    }

    /// Begins a transaction that releases disk space, or ends work that takes it; it may use the reserve.
    pub(super) async fn write_removal(&self) -> Result<Write, StoreError> {
        let mut write = Write {
            connection: self.writer.acquire().await?,
            dialect: self.dialect,
            changes: self.changes.clone(),
            ended: false,
        };
        sqlx::query(self.dialect.begin()).execute(&mut *write).await?;
        Ok(write)
    }

    /// Runs `remove`, and on a full disk once more with the room of the reserve, if that disk has the database.
    pub(super) async fn with_reserve<T, F>(&self, remove: impl Fn() -> F) -> Result<T, StoreError>
    where
        F: Future<Output = Result<T, StoreError>>,
    {
        match remove().await {
            Err(error) if error.is_disk_full() && self.dialect == Dialect::Sqlite => {
                if self.reserve.take().await { remove().await } else { Err(error) }
            }
            outcome => outcome,
        }
    }
}

impl Write {
    /// Guards a subject: waits until no other transaction guards it, and makes others wait.
    pub(super) async fn guard(&mut self, what: Guarded<'_>) -> Result<(), StoreError> {
        self.dialect.guard(&mut self.connection, what).await
    }

    /// Commits what was written.
    pub(super) async fn commit(self) -> Result<(), StoreError> {
        self.end("commit").await
    }

    /// Commits a change of job `id`, and notifies its followers.
    pub(super) async fn commit_job(self, id: JobId) -> Result<(), StoreError> {
        let changes = self.changes.clone();
        self.end("commit").await?;
        changes.tell(id);
        Ok(())
    }

    /// Commits a change that may concern any job, and notifies all followers.
    pub(super) async fn commit_jobs(self) -> Result<(), StoreError> {
        let changes = self.changes.clone();
        self.end("commit").await?;
        changes.tell_all();
        Ok(())
    }

    /// Rolls back what was written.
    pub(super) async fn rollback(self) -> Result<(), StoreError> {
        self.end("rollback").await
    }

    async fn end(mut self, how: &'static str) -> Result<(), StoreError> {
        sqlx::query(how).execute(&mut *self).await?;
        self.ended = true;
        Ok(())
    }
}

impl Deref for Write {
    type Target = AnyConnection;

    fn deref(&self) -> &AnyConnection {
        &self.connection
    }
}

impl DerefMut for Write {
    fn deref_mut(&mut self) -> &mut AnyConnection {
        &mut self.connection
    }
}

impl Drop for Write {
    fn drop(&mut self) {
        if !self.ended {
            self.connection.close_on_drop();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::io::ErrorKind;

    use super::*;
    use crate::store::reserve::{BYTES, FILE};

    #[tokio::test]
    async fn a_deletion_has_the_reserve_and_nobody_else() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let file = folder.path().join(FILE);
        let attempts = Cell::new(0);
        let second = || {
            attempts.set(attempts.get() + 1);
            let full = StoreError::File(ErrorKind::StorageFull.into());
            let outcome = if attempts.get() == 2 { Ok(()) } else { Err(full) };
            async { outcome }
        };
        assert!(store.with_reserve(second).await.unwrap_err().is_disk_full());
        assert!(attempts.take() == 1 && !store.reserve.is_taken(), "there was none");

        // A partial file left by an interrupted start does not count.
        std::fs::write(&file, "short").unwrap();
        assert!(store.reserve.keep().await.unwrap());
        assert_eq!(file.metadata().unwrap().len(), BYTES);
        store.with_reserve(second).await.unwrap();
        assert!(store.reserve.is_taken() && !file.exists());
        // Another deletion has taken what is left of the reserve.
        attempts.set(0);
        store.with_reserve(second).await.unwrap();
        // The first write, now that there is room, makes a new reserve.
        store.probe().await.unwrap();
        assert!(!store.reserve.is_taken() && file.exists());
        // Other failures leave the reserve alone.
        assert!(store.with_reserve(|| async { Err::<(), _>(StoreError::Spectra) }).await.is_err());
        assert!(file.exists());
    }
}
