//! What can go wrong with remembering.

/// A failure of the database, the disk or of something stored there.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused or could not be reached.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The tables could not be brought up to date.
    #[error("migration: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// The queue's tables refused.
    #[error("queue: {0}")]
    Queue(#[from] apalis_sqlite::Error),
    /// A file beside the database could not be written or read.
    #[error("data folder: {0}")]
    File(#[from] std::io::Error),
    /// A stored JSON document does not read back.
    #[error("stored JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// A stored array does not read back.
    #[error("stored numbers: {0}")]
    Numbers(#[from] postcard::Error),
    /// What one connection wrote, another does not see.
    #[error("what was written is not there for other connections")]
    NotSeen,
    /// A column holds a value this program does not know.
    #[error("column {column} holds {value:?}, which this version of the program does not know")]
    Unknown {
        /// The column.
        column: &'static str,
        /// Its value.
        value: String,
    },
}

/// Primary result code of `SQLite` for a write that found no room.
const SQLITE_FULL: &str = "13";

impl StoreError {
    /// Whether it was refused for want of room on the disk, and may succeed later.
    pub fn is_disk_full(&self) -> bool {
        match self {
            Self::Database(sqlx::Error::Database(error)) => {
                error.code().is_some_and(|code| code == SQLITE_FULL)
            }
            Self::File(error) => error.kind() == std::io::ErrorKind::StorageFull,
            _ => false,
        }
    }
}
