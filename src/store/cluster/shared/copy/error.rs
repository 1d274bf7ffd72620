//! Errors of copying a data folder.

use std::path::PathBuf;

use crate::store::error::StoreError;

/// Error of copying a data folder.
#[derive(Debug, thiserror::Error)]
pub enum CopyError {
    /// Failure of the folder, the database or the object store.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Folder that a service works on.
    #[error("a service has the data folder {}: stop it, or copy a backup (`rubmap backup`)", .0.display())]
    InUse(PathBuf),
    /// Tables that are not those of this program.
    #[error(
        "its database has version {found}, this program knows {known}: start the service once to bring it up to date, or take the \
         program that wrote it"
    )]
    Version {
        /// Version that was found.
        found: i64,
        /// Latest version that this program knows.
        known: i64,
    },
    /// Column of a type that is not copied: a defect.
    #[error("column {column} of the table {table} is of the type {kind}, which is not copied")]
    Column {
        /// Name of the table.
        table: String,
        /// Name of the column.
        column: String,
        /// Declared type of the column.
        kind: String,
    },
    /// Existing rows or objects that differ from those of the folder.
    #[error(
        "what is there already is not what the data folder has; it was left as it is, and no row was copied: {0}"
    )]
    Differs(Differences),
}

/// Rows and objects that differ from those of a data folder.
#[derive(Debug, Default)]
pub struct Differences {
    /// Names of the first differences.
    named: Vec<String>,
    /// Number of differences.
    count: usize,
}

impl Differences {
    /// Largest number of differences that are named.
    const NAMED: usize = 20;

    pub(super) fn add(&mut self, name: impl FnOnce() -> String) {
        self.count += 1;
        if self.named.len() < Self::NAMED {
            self.named.push(name());
        }
    }

    pub(super) fn expect_none(self) -> Result<(), CopyError> {
        if self.count == 0 { Ok(()) } else { Err(CopyError::Differs(self)) }
    }
}

impl std::fmt::Display for Differences {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.named.join("; "))?;
        match self.count - self.named.len() {
            0 => Ok(()),
            more => write!(f, "; and {more} more"),
        }
    }
}
