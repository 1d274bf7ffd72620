//! Store: its database, opened and brought up to date, and the data folder.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sqlx::AnyPool;

use super::changes::Changes;
use super::cluster::address::Address;
use super::cluster::queue::SharedQueue;
use super::dialect::Dialect;
use super::error::StoreError;
use super::marks::Marks;
use super::objects::Objects;
use super::packages::packages_folder;
use super::reserve::Reserve;
use super::{postgres, sqlite};

/// Name of the file in a data folder that the process which uses the folder locks.
pub const LOCK: &str = "lock";

/// Store of the service: the database, and the data folder with the packages.
#[derive(Debug, Clone)]
pub struct Store {
    pub(super) folder: PathBuf,
    pub(super) dialect: Dialect,
    pub(super) readers: AnyPool,
    pub(super) writer: AnyPool,
    pub(super) marks: Marks,
    /// Lock held while a package file and its row are added or removed together.
    pub(super) packages: Arc<tokio::sync::Mutex<()>>,
    /// Disk space reserved for deletions.
    pub(super) reserve: Reserve,
    /// Notifier of changes of jobs.
    pub(super) changes: Changes,
    /// Object store with the files that other processes share.
    pub(super) objects: Objects,
    /// Queue of tasks that other processes share.
    tasks: Option<SharedQueue>,
}

impl Store {
    /// Opens the store in `folder`, which must exist, with its tables in a file there, and brings them up to date.
    ///
    /// # Errors
    /// Also packages of models beside a database that knows none: it would remove them as leftovers.
    pub async fn open(folder: &Path) -> Result<Self, StoreError> {
        std::fs::create_dir_all(packages_folder(folder))?;
        let (readers, writer) = sqlite::open(folder).await?;
        Self::with(folder, Dialect::Sqlite, readers, writer)
    }

    /// Opens the store whose tables are on the PostgreSQL server at `url`, with `folder`, which must exist, for the rest, and brings its
    /// tables up to date.
    ///
    /// # Errors
    /// Also a program built without the feature `cluster`.
    pub async fn connect(folder: &Path, url: &str) -> Result<Self, StoreError> {
        std::fs::create_dir_all(packages_folder(folder))?;
        let pool = postgres::open(url).await?;
        let store = Self::with(folder, Dialect::Postgres, pool.clone(), pool)?;
        Ok(Self { tasks: SharedQueue::open(url).await?, ..store })
    }

    /// Queue of the tasks that all processes with these tables share; none with a data folder.
    pub fn shared_queue(&self) -> Option<&SharedQueue> {
        self.tasks.as_ref()
    }

    fn with(folder: &Path, dialect: Dialect, readers: AnyPool, writer: AnyPool) -> Result<Self, StoreError> {
        let marks = Marks::new(folder)?;
        let (packages, reserve) = (Arc::default(), Reserve::of(folder));
        let (changes, objects) = (Changes::default(), Objects::default());
        Ok(Self {
            folder: folder.to_owned(),
            dialect,
            readers,
            writer,
            marks,
            packages,
            reserve,
            changes,
            objects,
            tasks: None,
        })
    }

    /// Moves the store to files in an object store, which must exist and admit this process; the data folder becomes a cache.
    pub async fn sharing(self, address: &Address) -> Result<Self, StoreError> {
        let objects = Objects::open(address, &self.folder, self.reserve.clone()).await;
        Ok(Self { objects: objects.map_err(StoreError::Objects)?, ..self })
    }

    /// Changes of jobs, to be followed and reported.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Closes all connections, which folds the write-ahead log into the file.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
        if let Some(tasks) = &self.tasks {
            tasks.close().await;
        }
    }
}
