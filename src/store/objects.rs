//! Object storage that several processes share: the master copy of packages, bases, stress and checkpoints; the data folder of each process
//! is a cache of it. Without it the data folder is all there is.
//!
//! Objects have the names that files have in the data folder. A file is written whole and flushed here before it is uploaded, and fetched
//! into an unfinished file before it gets its name here: neither place ever shows a part of one.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tokio::runtime::Handle;

use super::cluster::address::Address;
use super::cluster::remote::Remote;
use super::folders::file_name;
use super::reserve::Reserve;
use super::unfinished::{UNFINISHED, unfinished_file};

/// Object store of a data folder, if it has one.
#[derive(Debug, Clone, Default)]
pub(super) struct Objects {
    shared: Option<Arc<Shared>>,
}

#[derive(Debug)]
struct Shared {
    data: PathBuf,
    reserve: Reserve,
    remote: Remote,
    /// Runtime for requests of computing threads.
    runtime: Handle,
}

impl Objects {
    /// Opens the object store at `address`, of which the data folder `data` is a cache.
    pub(super) async fn open(address: &Address, data: &Path, reserve: Reserve) -> io::Result<Self> {
        Ok(Self::over(Remote::open(address).await?, data, reserve))
    }

    pub(super) fn over(remote: Remote, data: &Path, reserve: Reserve) -> Self {
        let shared = Shared { data: data.to_owned(), reserve, remote, runtime: Handle::current() };
        Self { shared: Some(Arc::new(shared)) }
    }

    /// Whether there is an object store.
    pub(super) fn are_shared(&self) -> bool {
        self.shared.is_some()
    }

    /// Object store, and the name that a file of the data folder has there; none where there is no object store.
    pub(super) fn remote(&self, path: &Path) -> io::Result<Option<(&Remote, String)>> {
        self.shared.as_ref().map(|shared| Ok((&shared.remote, shared.name(path)?))).transpose()
    }

    /// Uploads a file of the data folder to the object store.
    pub(super) async fn publish(&self, path: &Path) -> io::Result<()> {
        let Some((remote, name)) = self.remote(path)? else { return Ok(()) };
        remote.put(&name, path).await
    }

    /// Uploads a file like [`Self::publish`], from a computing thread.
    pub(super) fn publish_blocking(&self, path: &Path) -> io::Result<()> {
        let Some(shared) = &self.shared else { return Ok(()) };
        shared.runtime.block_on(self.publish(path))
    }

    /// Fetches a file of the data folder from the object store, if `accept` takes its content. False if there is no such object.
    pub(super) async fn fetch(
        &self,
        path: &Path,
        accept: impl FnOnce(&Path) -> io::Result<()> + Send + 'static,
    ) -> io::Result<bool> {
        let Some(shared) = &self.shared else { return Ok(false) };
        let folder = path.parent().unwrap_or(&shared.data).to_owned();
        let mut unfinished = None;
        let make = |bytes| {
            shared.reserve.expect_room_for(bytes)?;
            std::fs::create_dir_all(&folder)?;
            let file = unfinished.insert(unfinished_file(&folder, UNFINISHED)?);
            Ok(tokio::fs::File::from_std(file.reopen()?))
        };
        if !shared.remote.get(&shared.name(path)?, make).await? {
            return Ok(false);
        }
        let Some(file) = unfinished else { return Ok(false) };
        let target = path.to_owned();
        let keep = move || {
            accept(file.path())?;
            file.as_file().sync_all()?;
            file.persist(&target).map_err(|error| error.error)?;
            std::fs::File::open(&folder)?.sync_all()
        };
        tokio::task::spawn_blocking(keep).await.map_err(io::Error::other)??;
        tracing::debug!(file = file_name(path), "fetched from the object store");
        Ok(true)
    }

    /// Runs `read` on files of the data folder, from a computing thread. Missing files are fetched before a second attempt, and all files
    /// where they are not what they should be: they may be of an earlier reduction, or damaged.
    pub(super) fn reading<T>(
        &self,
        paths: &[PathBuf],
        mut read: impl FnMut() -> io::Result<T>,
    ) -> io::Result<T> {
        let (shared, error) = match (&self.shared, read()) {
            (Some(shared), Err(error)) => (shared, error),
            (_, found) => return found,
        };
        let is_absent = error.kind() == ErrorKind::NotFound;
        if !is_absent && !matches!(error.kind(), ErrorKind::InvalidData | ErrorKind::UnexpectedEof) {
            return Err(error);
        }
        for path in paths.iter().filter(|path| !is_absent || !path.exists()) {
            if !shared.runtime.block_on(self.fetch(path, |_| Ok(())))? {
                return Err(error);
            }
        }
        read()
    }

    /// Whether a file of the data folder is in the object store.
    pub(super) async fn have(&self, path: &Path) -> io::Result<bool> {
        let Some((remote, name)) = self.remote(path)? else { return Ok(false) };
        remote.has(&name).await
    }

    /// Removes a file of the data folder from the object store.
    pub(super) async fn remove(&self, path: &Path) -> io::Result<()> {
        let Some((remote, name)) = self.remote(path)? else { return Ok(()) };
        remote.remove(&name).await
    }

    /// Removes a file like [`Self::remove`], from a computing thread.
    pub(super) fn remove_blocking(&self, path: &Path) -> io::Result<()> {
        let Some(shared) = &self.shared else { return Ok(()) };
        shared.runtime.block_on(self.remove(path))
    }

    /// Removes from the object store the folders in `root`, a folder of the data folder, whose names `which` selects.
    pub(super) async fn remove_folders(&self, root: &Path, which: impl Fn(&str) -> bool) -> io::Result<()> {
        let Some(shared) = &self.shared else { return Ok(()) };
        let root = shared.name(root)?;
        for folder in shared.remote.folders(&root).await?.iter().filter(|folder| which(folder)) {
            shared.remote.remove_folder(&format!("{root}/{folder}")).await?;
        }
        Ok(())
    }
}

impl Shared {
    /// Name of an object: the path of the file in the data folder.
    fn name(&self, path: &Path) -> io::Result<String> {
        let name = path.strip_prefix(&self.data).ok().and_then(Path::to_str);
        name.map(ToOwned::to_owned).ok_or_else(|| {
            io::Error::new(ErrorKind::InvalidInput, format!("{} is not in the data folder", path.display()))
        })
    }
}
