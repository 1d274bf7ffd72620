//! Settings of a program without the feature `cluster`: nothing is shared with other processes.

use std::path::Path;

use clap::Args;

use crate::store::{Store, StoreError};

/// Settings of what several processes share: none.
#[derive(Debug, Clone, Default, Args)]
pub struct SharedConfig {}

impl SharedConfig {
    /// Whether other processes may compute what clients ask of this one.
    pub fn is_shared(&self) -> bool {
        false
    }

    /// Opens the store in the data folder `data`.
    pub async fn open(&self, data: &Path) -> Result<Store, StoreError> {
        Store::open(data).await
    }
}
