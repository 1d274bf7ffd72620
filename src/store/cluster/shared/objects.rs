//! Facts of objects that copies compare.

use std::io;
use std::path::Path;

use crate::store::objects::Objects;

impl Objects {
    /// Length of a file of the data folder in the object store, bytes.
    pub(super) async fn size(&self, path: &Path) -> io::Result<Option<u64>> {
        let Some((remote, name)) = self.remote(path)? else { return Ok(None) };
        remote.size(&name).await
    }

    /// SHA-256 of a file of the data folder in the object store, as it is read back.
    pub(super) async fn sha256(&self, path: &Path) -> io::Result<Option<[u8; 32]>> {
        let Some((remote, name)) = self.remote(path)? else { return Ok(None) };
        remote.sha256(&name).await
    }
}
