//! Why a data folder was not copied.

use std::path::PathBuf;

use crate::store::error::StoreError;

/// Why a data folder was not copied.
#[derive(Debug, thiserror::Error)]
pub enum CopyError {
    /// The folder, the database or the object store failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A service works on the folder.
    #[error("a service has the data folder {}: stop it, or copy a backup (`rubmap backup`)", .0.display())]
    InUse(PathBuf),
    /// Its tables are not those of this program.
    #[error(
        "its database has version {found}, this program knows {known}: start the service once to bring it up to date, or take the \
         program that wrote it"
    )]
    Version {
        /// What was found.
        found: i64,
        /// The last that this program knows.
        known: i64,
    },
    /// A column of a type that is not copied: a defect.
    #[error("column {column} of the table {table} is of the type {kind}, which is not copied")]
    Column {
        /// The table.
        table: String,
        /// Its column.
        column: String,
        /// What it is said to hold.
        kind: String,
    },
    /// What is there is not what the folder has.
    #[error(
        "what is there already is not what the data folder has; it was left as it is, and no row was copied: {0}"
    )]
    Differs(Differences),
}

/// Rows and objects that are not what a data folder has.
#[derive(Debug, Default)]
pub struct Differences {
    /// The first of them.
    named: Vec<String>,
    /// How many there are.
    count: usize,
}

impl Differences {
    /// How many are named.
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
