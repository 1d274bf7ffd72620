//! Object store that cannot exist in this build.

use std::io;
use std::path::Path;

use super::address::Address;

/// Object store that cannot exist in this build.
#[derive(Debug)]
pub(in crate::store) enum Remote {}

impl Remote {
    pub(in crate::store) async fn open(address: &Address) -> io::Result<Self> {
        match *address {}
    }

    pub(in crate::store) async fn put(&self, _: &str, _: &Path) -> io::Result<()> {
        match *self {}
    }

    pub(in crate::store) async fn get(
        &self,
        _: &str,
        _: impl FnOnce(u64) -> io::Result<tokio::fs::File>,
    ) -> io::Result<bool> {
        match *self {}
    }

    pub(in crate::store) async fn has(&self, _: &str) -> io::Result<bool> {
        match *self {}
    }

    pub(in crate::store) async fn folders(&self, _: &str) -> io::Result<Vec<String>> {
        match *self {}
    }

    pub(in crate::store) async fn remove(&self, _: &str) -> io::Result<()> {
        match *self {}
    }

    pub(in crate::store) async fn remove_folder(&self, _: &str) -> io::Result<()> {
        match *self {}
    }
}
