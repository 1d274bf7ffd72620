//! Empty stores for tests, on every database that the program was built for.

use std::ops::Deref;

use super::Store;
use super::cluster::testing::database;

/// Store with a data folder of its own.
pub(super) struct TestStore {
    store: Store,
    /// Address of the database on the server, if the store is on one.
    pub(super) url: Option<String>,
    /// Data folder, removed with the store.
    pub(super) folder: tempfile::TempDir,
}

impl Deref for TestStore {
    type Target = Store;

    fn deref(&self) -> &Store {
        &self.store
    }
}

impl TestStore {
    /// Opens the same store for `count` processes; on a data folder that is one.
    pub(super) async fn processes(&self, count: usize) -> Vec<Store> {
        let mut processes = Vec::with_capacity(count);
        for _ in 0..count {
            processes.push(match &self.url {
                Some(url) => Store::connect(self.folder.path(), url).await.unwrap(),
                None => self.store.clone(),
            });
        }
        processes
    }
}

/// Creates a store on `SQLite`, and one on PostgreSQL where it is installed.
pub(super) async fn stores() -> Vec<TestStore> {
    let folder = tempfile::tempdir().unwrap();
    let mut stores = vec![TestStore { store: Store::open(folder.path()).await.unwrap(), url: None, folder }];
    if let Some(url) = database().await {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::connect(folder.path(), &url).await.unwrap();
        stores.push(TestStore { store, url: Some(url), folder });
    }
    stores
}
