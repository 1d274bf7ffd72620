//! Settings of a program with the feature `cluster`: where the data is that several processes share.

mod database;

use std::path::Path;

use clap::Args;

pub use self::database::DatabaseUrl;
use crate::store::cluster::address::Address;
use crate::store::{Store, StoreError};

/// Settings of what several processes share.
#[derive(Debug, Clone, Default, Args)]
pub struct SharedConfig {
    /// PostgreSQL database for models, jobs, results and queue, which several processes share [default: a file in the data folder].
    #[arg(
        long,
        env = "RUBMAP_DATABASE",
        requires = "objects",
        hide_env_values = true,
        value_name = "postgres://USER@HOST/NAME"
    )]
    pub database: Option<DatabaseUrl>,

    /// Object storage for files of the data folder, which several processes share: s3://bucket/prefix, or a folder that all see [default: the data
    /// folder alone].
    #[arg(long, env = "RUBMAP_OBJECTS", requires = "database", value_name = "s3://BUCKET/PREFIX")]
    pub objects: Option<Address>,
}

impl SharedConfig {
    /// Whether other processes may compute what clients ask of this one.
    pub fn is_shared(&self) -> bool {
        self.database.is_some()
    }

    /// Opens the store: its tables in the database or in the data folder `data`, its files in the object storage or there.
    pub async fn open(&self, data: &Path) -> Result<Store, StoreError> {
        let store = match &self.database {
            Some(database) => Store::connect(data, database.expose()).await?,
            None => Store::open(data).await?,
        };
        match &self.objects {
            Some(address) => store.sharing(address).await,
            None => Ok(store),
        }
    }
}
