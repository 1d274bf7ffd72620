//! Stub of the object store: the program was built without the feature `cluster`. Nothing here can be called.

use std::io;
use std::path::Path;

use super::address::Address;

/// Object store that cannot exist in this build.
#[derive(Debug)]
pub(super) enum Remote {}

impl Remote {
    pub(super) async fn open(address: &Address) -> io::Result<Self> {
        Err(io::Error::new(io::ErrorKind::Unsupported, format!("{address}: built without object storage")))
    }

    pub(super) async fn put(&self, _: &str, _: &Path) -> io::Result<()> {
        match *self {}
    }

    pub(super) async fn get(
        &self,
        _: &str,
        _: impl FnOnce(u64) -> io::Result<tokio::fs::File>,
    ) -> io::Result<bool> {
        match *self {}
    }

    pub(super) async fn has(&self, _: &str) -> io::Result<bool> {
        match *self {}
    }

    pub(super) async fn folders(&self, _: &str) -> io::Result<Vec<String>> {
        match *self {}
    }

    pub(super) async fn remove(&self, _: &str) -> io::Result<()> {
        match *self {}
    }

    pub(super) async fn remove_folder(&self, _: &str) -> io::Result<()> {
        match *self {}
    }
}
