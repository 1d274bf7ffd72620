//! What can go wrong with remembering.

use std::io::ErrorKind;
use std::path::PathBuf;

use sqlx::migrate::MigrateError;

use super::refusal::{Refusal, is_no_text, refusal};

/// A failure of the database, the disk or of something stored there.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused or could not be reached.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The tables could not be brought up to date.
    #[error("migration: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// The address of a database that is none.
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
        /// What is in them.
        part: &'static str,
        /// Their version.
        found: i64,
        /// The last that this program knows.
        known: i64,
    },
    /// The tables of the queue that machines share refused.
    #[cfg(feature = "cluster")]
    #[error("queue: {0}")]
    SharedQueue(#[from] apalis_postgres::Error),
    /// Packages of models, and nothing that knows them.
    #[error(
        "{} is missing or holds nothing of this program, and beside it lie packages of models ({packages}), which it \
         would not know and the service remove: put the database back (from a backup; a copy needs its -wal file, too), \
         or, to begin anew, move it and its folder `models` elsewhere and upload the packages again",
        database.display()
    )]
    LostDatabase {
        /// Where it should be.
        database: PathBuf,
        /// Packages that are there.
        packages: usize,
    },
    /// A file beside the database could not be written or read.
    #[error("data folder: {0}")]
    File(#[from] std::io::Error),
    /// An object could not be put into the object store, or fetched from there.
    #[error("{0}")]
    Objects(#[source] std::io::Error),
    /// The package of a model cannot be accessed.
    #[error("package: {0}")]
    Package(#[source] std::io::Error),
    /// A stored JSON document does not read back.
    #[error("stored JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// A stored array does not read back.
    #[error("stored numbers: {0}")]
    Numbers(#[from] postcard::Error),
    /// Packed spectra that are not whole.
    #[error("stored spectra are damaged")]
    Spectra,
    /// What was just written cannot be read by others.
    #[error("the database took a row that its other connections do not see")]
    Unseen,
    /// A column holds a value this program does not know.
    #[error("column {column} holds {value:?}, which this version of the program does not know")]
    Unknown {
        /// The column.
        column: &'static str,
        /// Its value.
        value: String,
    },
}

impl StoreError {
    /// Whether it was refused for want of room on the disk.
    pub fn is_disk_full(&self) -> bool {
        match self {
            Self::Database(error) => refusal(error) == Some(Refusal::DiskFull),
            Self::File(error) | Self::Objects(error) | Self::Package(error) => is_no_room(error),
            _ => false,
        }
    }

    /// [`Self::may_pass`] of a file.
    pub fn may_pass_of(error: &std::io::Error) -> bool {
        io_may_pass(error)
    }

    /// Whether a text of the request has a character in it that the database cannot keep: U+0000.
    pub fn is_no_text(&self) -> bool {
        matches!(self, Self::Database(error) if is_no_text(error))
    }

    /// Whether the package of a model is not where it was put.
    pub fn is_missing_package(&self) -> bool {
        matches!(self, Self::Package(error) if error.kind() == ErrorKind::NotFound)
    }

    /// Whether the object store refuses this process's credentials.
    pub fn is_denied(&self) -> bool {
        matches!(self, Self::Objects(error) if error.kind() == ErrorKind::PermissionDenied)
    }

    /// Whether the same may succeed later without anybody changing a word of it: a full disk, a lock that somebody holds,
    /// descriptors or memory that others have taken. No verdict on what was to be done.
    pub fn may_pass(&self) -> bool {
        match self {
            Self::File(error) => io_may_pass(error),
            // Credentials run out and are renewed.
            Self::Objects(error) => io_may_pass(error) || self.is_denied(),
            // One that is not there may be put back, or uploaded again.
            Self::Package(error) => io_may_pass(error) || self.is_missing_package(),
            // A connection that was lost is replaced, and a server that does not answer, or has no name yet, comes back.
            Self::Database(
                sqlx::Error::Io(_)
                | sqlx::Error::PoolTimedOut
                | sqlx::Error::PoolClosed
                | sqlx::Error::WorkerCrashed,
            )
            | Self::Unseen => true,
            #[cfg(feature = "cluster")]
            Self::SharedQueue(_) => true,
            Self::Database(error)
            | Self::Migration(MigrateError::Execute(error) | MigrateError::ExecuteMigration(error, _)) => {
                refusal(error).is_some()
            }
            Self::Migration(_)
            | Self::NoAddress
            | Self::NotUpToDate(_)
            | Self::NewerTables { .. }
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
    /// Those without a kind of their own: `EIO`, `ENFILE` and `EMFILE`, the same on all Unixes.
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
                // An object store that is away.
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
