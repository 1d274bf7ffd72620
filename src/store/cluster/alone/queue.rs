//! Queue that machines share, which cannot exist in this build.

use sqlx::migrate::Migrator;

use super::claims::Claim;
use crate::analysis::kinds::plan::Capacity;
use crate::store::error::StoreError;

/// Queue of the tasks of all machines, which cannot exist in this build.
#[derive(Debug, Clone, Copy)]
pub enum SharedQueue {}

impl SharedQueue {
    /// Opens no queue: a database on a server is used without one.
    pub(in crate::store) async fn open(_: &str) -> Result<Option<Self>, StoreError> {
        Ok(None)
    }

    pub(in crate::store) async fn close(&self) {
        match *self {}
    }

    /// Claims a task for this process.
    pub async fn claim(&self, _: &str) -> Result<Option<Claim>, StoreError> {
        match *self {}
    }

    /// Capacity of all machines that share the work.
    pub async fn capacity(&self) -> Result<Option<Capacity>, StoreError> {
        match *self {}
    }
}

/// Migrations that make the tables of the queue: none.
pub(in crate::store) fn migrations() -> Option<Migrator> {
    None
}
