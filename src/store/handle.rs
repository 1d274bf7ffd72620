//! The store itself: its database, opened and brought up to date, and the data folder.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sqlx::AnyPool;

use super::changes::Changes;
use super::dialect::Dialect;
use super::error::StoreError;
use super::marks::Marks;
use super::objects::{Address, Objects};
use super::packages::packages_folder;
use super::reserve::Reserve;
#[cfg(feature = "cluster")]
use super::shared_queue::SharedQueue;
use super::{postgres, sqlite};

/// Name of the file in a data folder that is locked by the process which has the folder.
pub const LOCK: &str = "lock";

/// The database and the data folder, which has the packages.
#[derive(Debug, Clone)]
pub struct Store {
    pub(super) folder: PathBuf,
    pub(super) dialect: Dialect,
    pub(super) readers: AnyPool,
    pub(super) writer: AnyPool,
    pub(super) marks: Marks,
    /// Held while a package file and its row come or go together.
    pub(super) packages: Arc<tokio::sync::Mutex<()>>,
    /// Room that is kept for deletions.
    pub(super) reserve: Reserve,
    /// Tells who follows a job that it has changed.
    pub(super) changes: Changes,
    /// Files that other processes share.
    pub(super) objects: Objects,
    /// Tasks that other processes share.
    #[cfg(feature = "cluster")]
    tasks: Option<SharedQueue>,
}

impl Store {
    /// Opens the store in `folder`, which must exist, with its tables in a file there, and brings them up to date.
    ///
    /// # Errors
    /// Also where packages of models lie beside a database that knows none: it would make leftovers of them.
    pub async fn open(folder: &Path) -> Result<Self, StoreError> {
        std::fs::create_dir_all(packages_folder(folder))?;
        let (readers, writer) = sqlite::open(folder).await?;
        Self::with(folder, Dialect::Sqlite, readers, writer)
    }

    /// Opens the store whose tables are on the PostgreSQL server at `url`, with `folder`, which must exist, for the rest, and brings its
    /// tables up to date.
    ///
    /// # Errors
    /// Also where the program was built without the feature `cluster`.
    pub async fn connect(folder: &Path, url: &str) -> Result<Self, StoreError> {
        std::fs::create_dir_all(packages_folder(folder))?;
        let pool = postgres::open(url).await?;
        let store = Self::with(folder, Dialect::Postgres, pool.clone(), pool)?;
        #[cfg(feature = "cluster")]
        let store = Self { tasks: Some(SharedQueue::open(url).await?), ..store };
        Ok(store)
    }

    /// The tasks that processes share which have the tables in common; none of a data folder.
    #[cfg(feature = "cluster")]
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
            #[cfg(feature = "cluster")]
            tasks: None,
        })
    }

    /// The same with the files of the data folder in an object store; it must be there and let us in.
    pub async fn sharing(self, address: &Address) -> Result<Self, StoreError> {
        let objects = Objects::open(address, &self.folder, self.reserve.clone()).await;
        Ok(Self { objects: objects.map_err(StoreError::Objects)?, ..self })
    }

    /// Changes of jobs, to be followed and told.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Closes all connections, which folds the write-ahead log into the file.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
        #[cfg(feature = "cluster")]
        if let Some(tasks) = &self.tasks {
            tasks.close().await;
        }
    }
}
