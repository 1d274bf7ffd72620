//! The store itself: the database of one data folder, opened and brought up to date.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sqlx::AnyPool;

use super::changes::Changes;
use super::error::StoreError;
use super::marks::Marks;
use super::packages::packages_folder;
use super::reserve::Reserve;
use super::sqlite;

/// The database of one data folder and the packages beside it.
#[derive(Debug, Clone)]
pub struct Store {
    pub(super) folder: PathBuf,
    pub(super) readers: AnyPool,
    pub(super) writer: AnyPool,
    pub(super) marks: Marks,
    /// Held while a package file and its row come or go together.
    pub(super) packages: Arc<tokio::sync::Mutex<()>>,
    /// Room that is kept for deletions.
    pub(super) reserve: Reserve,
    /// Tells who follows a job that it has changed.
    pub(super) changes: Changes,
}

impl Store {
    /// Opens the store in `folder`, which must exist, and brings its tables up to date.
    ///
    /// # Errors
    /// Also where packages of models lie beside a database that knows none: it would make leftovers of them.
    pub async fn open(folder: &Path) -> Result<Self, StoreError> {
        std::fs::create_dir_all(packages_folder(folder))?;
        let (readers, writer) = sqlite::open(folder).await?;
        let marks = Marks::new(folder)?;
        let (packages, reserve) = (Arc::default(), Reserve::of(folder));
        let changes = Changes::default();
        Ok(Self { folder: folder.to_owned(), readers, writer, marks, packages, reserve, changes })
    }

    /// Changes of jobs, to be followed and told.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Closes all connections, which folds the write-ahead log into the database.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
    }
}
