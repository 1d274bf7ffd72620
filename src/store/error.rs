//! Errors of the store.

use std::io::ErrorKind;
use std::path::PathBuf;

use sqlx::migrate::MigrateError;

use super::cluster::error::QueueError;
use super::refusal::{Refusal, is_no_text, refusal};

/// Failure of the database, the disk or stored data.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// Database that refused a statement or could not be reached.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// Migration of the tables that failed.
    #[error("migration: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// Malformed address of a database.
    #[error("the address of the database is none: expected one such as postgres://user@host/database")]
    NoAddress,
    /// Tables that this account may not bring up to date.
    #[error(
        "the tables of the database are missing, of an earlier version or closed to this account, which may not change them ({0}): run \
         `rubmap migrate --database postgres://OWNER@HOST/NAME` with the account that owns them; `rubmap migrate --help` says what an \
         account must be granted that serves or computes"
    )]
    NotUpToDate(#[source] sqlx::Error),
    /// Tables of a later program.
    #[error(
        "the tables of {part} have version {found}, which a later rubmap has made; this one knows no more than {known}: take the program \
         that made them, or a later one"
    )]
    NewerTables {
        /// Contents of these tables.
        part: &'static str,
        /// Version of these tables.
        found: i64,
        /// Latest version that this program knows.
        known: i64,
    },
    /// Tables of a program so old that this one does not bring them up to date.
    #[error(
        "the tables have version {found}; this rubmap begins at {least}: let a rubmap of November 2026 (commit 738a5ec1 or a little \
         before) open them once, which brings them there"
    )]
    OlderTables {
        /// Version of these tables.
        found: i64,
        /// Earliest version that this program brings up to date.
        least: i64,
    },
    /// Disk without room for the step that brings tables up to date.
    #[error(
        "bringing the tables up to date takes {needed} bytes for a while, and the disk has {free}: make room, or delete jobs with the \
         program that made the folder"
    )]
    NoRoomForTables {
        /// Bytes that the step takes.
        needed: u64,
        /// Bytes that the disk has.
        free: u64,
    },
    /// The tables of the queue that machines share refused.
    #[error("queue: {0}")]
    SharedQueue(#[from] QueueError),
    /// Packages of models without a database that knows them.
    #[error(
        "{} is missing or holds nothing of this program, and beside it lie packages of models ({packages}), which it \
         would not know and the service remove: put the database back (from a backup; a copy needs its -wal file, too), \
         or, to begin anew, move it and its folder `models` elsewhere and upload the packages again",
        database.display()
    )]
    LostDatabase {
        /// Path where the database should be.
        database: PathBuf,
        /// Number of packages found.
        packages: usize,
    },
    /// File beside the database that could not be written or read.
    #[error("data folder: {0}")]
    File(#[from] std::io::Error),
    /// Object that could not be put into the object store, or fetched from it.
    #[error("{0}")]
    Objects(#[source] std::io::Error),
    /// Package of a model that cannot be accessed.
    #[error("package: {0}")]
    Package(#[source] std::io::Error),
    /// Stored JSON document that does not read back.
    #[error("stored JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// Stored array that does not read back.
    #[error("stored numbers: {0}")]
    Numbers(#[from] postcard::Error),
    /// Packed spectra that are incomplete.
    #[error("stored spectra are damaged")]
    Spectra,
    /// Written data that other connections cannot read.
    #[error("the database took a row that its other connections do not see")]
    Unseen,
    /// Column that holds a value unknown to this program.
    #[error("column {column} holds {value:?}, which this version of the program does not know")]
    Unknown {
        /// Name of the column.
        column: &'static str,
        /// Value that was found.
        value: String,
    },
}

impl StoreError {
    /// Whether the operation failed for lack of disk space.
    pub fn is_disk_full(&self) -> bool {
        match self {
            Self::Database(error) => refusal(error) == Some(Refusal::DiskFull),
            Self::File(error) | Self::Objects(error) | Self::Package(error) => is_no_room(error),
            _ => false,
        }
    }

    /// Whether an operation on a file may succeed later, as [`Self::may_pass`].
    pub fn may_pass_of(error: &std::io::Error) -> bool {
        io_may_pass(error)
    }

    /// Whether a text of the request contains a character that the database cannot store: U+0000.
    pub fn is_no_text(&self) -> bool {
        matches!(self, Self::Database(error) if is_no_text(error))
    }

    /// Whether the package of a model is missing.
    pub fn is_missing_package(&self) -> bool {
        matches!(self, Self::Package(error) if error.kind() == ErrorKind::NotFound)
    }

    /// Whether the object store refuses this process's credentials.
    pub fn is_denied(&self) -> bool {
        matches!(self, Self::Objects(error) if error.kind() == ErrorKind::PermissionDenied)
    }

    /// Whether the same operation may succeed later without a change of the request: a full disk, a lock held by another process,
    /// descriptors or memory in use. Says nothing about the validity of the operation.
    pub fn may_pass(&self) -> bool {
        match self {
            Self::File(error) => io_may_pass(error),
            // Credentials expire and are renewed.
            Self::Objects(error) => io_may_pass(error) || self.is_denied(),
            // A missing package may be put back, or uploaded again.
            Self::Package(error) => io_may_pass(error) || self.is_missing_package(),
            // A lost connection is replaced, and a server that does not answer, or has no name yet, comes back.
            Self::Database(
                sqlx::Error::Io(_)
                | sqlx::Error::PoolTimedOut
                | sqlx::Error::PoolClosed
                | sqlx::Error::WorkerCrashed,
            )
            | Self::SharedQueue(_)
            | Self::Unseen => true,
            Self::Database(error)
            | Self::Migration(MigrateError::Execute(error) | MigrateError::ExecuteMigration(error, _)) => {
                refusal(error).is_some()
            }
            Self::Migration(_)
            | Self::NoAddress
            | Self::NotUpToDate(_)
            | Self::NewerTables { .. }
            | Self::OlderTables { .. }
            | Self::NoRoomForTables { .. }
            | Self::LostDatabase { .. }
            | Self::Json(_)
            | Self::Numbers(_)
            | Self::Spectra
            | Self::Unknown { .. } => false,
        }
    }
}

fn is_no_room(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
}

/// Whether an operation on a file may succeed later.
fn io_may_pass(error: &std::io::Error) -> bool {
    /// Error numbers without a kind of their own: `EIO`, `ENFILE` and `EMFILE`, the same on all Unixes.
    const NUMBERS: [i32; 3] = [5, 23, 24];
    is_no_room(error)
        || matches!(
            error.kind(),
            ErrorKind::WouldBlock
                | ErrorKind::Interrupted
                | ErrorKind::TimedOut
                | ErrorKind::OutOfMemory
                | ErrorKind::ResourceBusy
                | ErrorKind::ReadOnlyFilesystem
                // An object store that cannot be reached.
                | ErrorKind::HostUnreachable
        )
        || error.raw_os_error().is_some_and(|number| NUMBERS.contains(&number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_others_hold_passes_and_what_is_wrong_does_not() {
        let os = |number| StoreError::File(std::io::Error::from_raw_os_error(number));
        // EIO, EAGAIN, ENOMEM, EBUSY, ENFILE, EMFILE, ENOSPC, EROFS, EDQUOT.
        for number in [5, 11, 12, 16, 23, 24, 28, 30, 122] {
            assert!(os(number).may_pass(), "{}", os(number));
        }
        // ENOENT, EACCES, EISDIR.
        for number in [2, 13, 21] {
            assert!(!os(number).may_pass(), "{}", os(number));
        }
        assert!(os(28).is_disk_full() && os(122).is_disk_full() && !os(24).is_disk_full());
        assert!(StoreError::Database(sqlx::Error::PoolTimedOut).may_pass());
        // ENOENT, of a server's socket.
        assert!(StoreError::Database(sqlx::Error::Io(std::io::Error::from_raw_os_error(2))).may_pass());
        assert!(!StoreError::Database(sqlx::Error::RowNotFound).may_pass());
    }
}
