//! Objects of a bucket or of a shared folder.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use futures::{StreamExt, TryStreamExt};
use object_store::aws::{AmazonS3Builder, AmazonS3ConfigKey};
use object_store::local::LocalFileSystem;
use object_store::path::Path as Name;
use object_store::prefix::PrefixStore;
use object_store::{
    ClientConfigKey, Error, ObjectStore, ObjectStoreExt, PutPayload, RetryConfig, WriteMultipart,
};
use sha2::{Digest, Sha256};
use tokio::io::{AsyncReadExt, AsyncWriteExt};

use super::address::Address;
use super::failure::Failure;

/// Size of an upload at once, bytes. Larger files go in parts of this size, or of a [`MOST_PARTS`]th of their length.
const PART: u64 = 8 << 20;

/// Largest number of parts of an upload; S3 takes 10,000.
const MOST_PARTS: u64 = 9_000;

/// Number of parts of one file that are uploaded at once.
const PARTS_AT_ONCE: usize = 2;

/// Time limit for a part to be taken, or for the next bytes to come.
const SILENCE: &str = "30 seconds";

/// Number of attempts after the first; callers have timeouts of their own.
const RETRIES: usize = 2;

/// Time after which nothing is tried again: two silences and the pauses between them.
const RETRYING: Duration = Duration::from_secs(90);

/// Connection to an object store. Its settings and keys come from the environment (`AWS_…`).
pub(in crate::store) struct Remote {
    address: Address,
    store: Arc<dyn ObjectStore>,
}

/// Debug output without the store, which contains the keys.
impl std::fmt::Debug for Remote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Remote").field("address", &self.address).finish_non_exhaustive()
    }
}

impl Remote {
    /// Opens the store at `address` and checks that it answers.
    pub(in crate::store) async fn open(address: &Address) -> io::Result<Self> {
        let store = connect(address).map_err(|failure| failure.of(address, None))?;
        Self::over(address, store).await
    }

    pub(in crate::store) async fn over(address: &Address, store: Arc<dyn ObjectStore>) -> io::Result<Self> {
        let remote = Self { address: address.clone(), store };
        // One page of names proves that keys and bucket are right.
        let first = remote.store.list(None).next().await;
        first.transpose().map_err(|error| failure(error).of(address, None))?;
        Ok(remote)
    }

    /// Uploads the file at `path`, whole or not at all.
    pub(in crate::store) async fn put(&self, name: &str, path: &Path) -> io::Result<()> {
        let mut file = tokio::fs::File::open(path).await?;
        let length = file.metadata().await?.len();
        if length <= PART {
            let mut bytes = Vec::with_capacity(length as usize);
            file.read_to_end(&mut bytes).await?;
            self.store
                .put(&Name::from(name), PutPayload::from(bytes))
                .await
                .map_err(|e| self.error(name, e))?;
            return Ok(());
        }
        let upload = self.store.put_multipart(&Name::from(name)).await.map_err(|e| self.error(name, e))?;
        let part = PART.max(length.div_ceil(MOST_PARTS)) as usize;
        let mut upload = WriteMultipart::new_with_chunk_size(upload, part);
        match self.send(name, file, &mut upload).await {
            Ok(()) => upload.finish().await.map(drop).map_err(|e| self.error(name, e)),
            Err(error) => {
                // Parts of an aborted upload would be stored and paid for. A failure to drop them adds nothing to `error`.
                let _ = upload.abort().await;
                Err(error)
            }
        }
    }

    async fn send(
        &self,
        name: &str,
        mut file: tokio::fs::File,
        upload: &mut WriteMultipart,
    ) -> io::Result<()> {
        let mut block = vec![0; 1 << 20];
        loop {
            let read = file.read(&mut block).await?;
            if read == 0 {
                return Ok(());
            }
            upload.wait_for_capacity(PARTS_AT_ONCE).await.map_err(|e| self.error(name, e))?;
            upload.write(&block[..read]);
        }
    }

    /// Downloads an object into the file that `make` opens once it knows the length. False if there is no such object.
    pub(in crate::store) async fn get(
        &self,
        name: &str,
        make: impl FnOnce(u64) -> io::Result<tokio::fs::File>,
    ) -> io::Result<bool> {
        let found = match self.store.get(&Name::from(name)).await {
            Err(Error::NotFound { .. }) => return Ok(false),
            found => found.map_err(|error| self.error(name, error))?,
        };
        let expected = found.meta.size;
        let mut file = make(expected)?;
        let mut written = 0;
        let mut blocks = found.into_stream();
        while let Some(block) = blocks.try_next().await.map_err(|error| self.error(name, error))? {
            file.write_all(&block).await?;
            written += block.len() as u64;
        }
        file.flush().await?;
        if written != expected {
            return Err(Failure::Cut { found: written, expected }.of(&self.address, Some(name)));
        }
        Ok(true)
    }

    pub(in crate::store) async fn has(&self, name: &str) -> io::Result<bool> {
        Ok(self.size(name).await?.is_some())
    }

    /// Length of an object in bytes, if it is there.
    pub(in crate::store) async fn size(&self, name: &str) -> io::Result<Option<u64>> {
        match self.store.head(&Name::from(name)).await {
            Ok(object) => Ok(Some(object.size)),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.error(name, error)),
        }
    }

    /// SHA-256 of an object, if it is there.
    pub(in crate::store) async fn sha256(&self, name: &str) -> io::Result<Option<[u8; 32]>> {
        let found = match self.store.get(&Name::from(name)).await {
            Err(Error::NotFound { .. }) => return Ok(None),
            found => found.map_err(|error| self.error(name, error))?,
        };
        let mut sum = Sha256::new();
        let mut blocks = found.into_stream();
        while let Some(block) = blocks.try_next().await.map_err(|error| self.error(name, error))? {
            sum.update(&block);
        }
        Ok(Some(sum.finalize().into()))
    }

    /// Lists the names of the folders in a folder.
    pub(in crate::store) async fn folders(&self, folder: &str) -> io::Result<Vec<String>> {
        let found = self.store.list_with_delimiter(Some(&Name::from(folder))).await;
        let found = found.map_err(|error| self.error(folder, error))?;
        Ok(found.common_prefixes.iter().filter_map(|name| Some(name.filename()?.to_owned())).collect())
    }

    /// Removes an object, if it is there.
    pub(in crate::store) async fn remove(&self, name: &str) -> io::Result<()> {
        match self.store.delete(&Name::from(name)).await {
            Ok(()) | Err(Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(self.error(name, error)),
        }
    }

    /// Removes all objects in a folder.
    pub(in crate::store) async fn remove_folder(&self, folder: &str) -> io::Result<()> {
        let names = self.store.list(Some(&Name::from(folder))).map_ok(|object| object.location).boxed();
        let mut removed = self.store.delete_stream(names);
        while let Some(removed) = removed.next().await {
            match removed {
                // Another process removed it first.
                Ok(_) | Err(Error::NotFound { .. }) => {}
                Err(error) => return Err(self.error(folder, error)),
            }
        }
        Ok(())
    }

    fn error(&self, name: &str, error: Error) -> io::Error {
        failure(error).of(&self.address, Some(name))
    }
}

fn connect(address: &Address) -> Result<Arc<dyn ObjectStore>, Failure> {
    match address {
        Address::Folder(folder) => {
            if !folder.is_dir() {
                let absent = "there is no such folder: mount it, or make it";
                return Err(Failure::Settings(absent.to_owned()));
            }
            let store = LocalFileSystem::new_with_prefix(folder).map_err(failure)?;
            Ok(Arc::new(store.with_fsync(true).with_automatic_cleanup(true)))
        }
        Address::Bucket { bucket, prefix } => connect_bucket(AmazonS3Builder::from_env(), bucket, prefix),
    }
}

/// Connects to a bucket, with `settings` for everything else.
pub(super) fn connect_bucket(
    settings: AmazonS3Builder,
    bucket: &str,
    prefix: &str,
) -> Result<Arc<dyn ObjectStore>, Failure> {
    // The library would report a refused plain-text address at each request, as if the store were down.
    let set = |key| settings.get_config_value(&key).unwrap_or_default();
    let endpoints = [AmazonS3ConfigKey::Endpoint, AmazonS3ConfigKey::S3Endpoint].map(set);
    let may_be_plain = set(AmazonS3ConfigKey::Client(ClientConfigKey::AllowHttp)) == "true";
    if !may_be_plain && endpoints.iter().any(|endpoint| endpoint.starts_with("http://")) {
        let plain = "its address begins with http://, so that keys and objects could be read on the way: give it https://, or set AWS_ALLOW_HTTP=true";
        return Err(Failure::Settings(plain.to_owned()));
    }
    // The HTTP client needs a TLS provider to be chosen; a second call changes nothing.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let retry = RetryConfig { max_retries: RETRIES, retry_timeout: RETRYING, ..RetryConfig::default() };
    let store = settings
        .with_bucket_name(bucket)
        // A large object may take long, as long as bytes keep coming.
        .with_config(AmazonS3ConfigKey::Client(ClientConfigKey::Timeout), "1 day")
        .with_config(AmazonS3ConfigKey::Client(ClientConfigKey::ReadTimeout), SILENCE)
        .with_retry(retry)
        .build()
        .map_err(|error| Failure::Settings(format!("the settings AWS_… do not fit: {error}")))?;
    if prefix.is_empty() {
        return Ok(Arc::new(store));
    }
    Ok(Arc::new(PrefixStore::new(store, prefix)))
}

/// Interprets an error of the library.
fn failure(error: Error) -> Failure {
    match error {
        Error::NotFound { .. } => Failure::Absent,
        Error::PermissionDenied { .. } | Error::Unauthenticated { .. } => Failure::Denied,
        error => match of_file(&error) {
            Some(io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded) => {
                Failure::Full(error.to_string())
            }
            Some(io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem) => Failure::Denied,
            _ => of_answer(error.to_string()),
        },
    }
}

/// Interprets the answer to a listing, whose refusals the library reports in words only.
fn of_answer(said: String) -> Failure {
    if said.contains("<Code>NoSuchBucket</Code>") {
        Failure::NoBucket
    } else if ["401", "403"].iter().any(|code| said.contains(&format!("status code: {code} "))) {
        Failure::Denied
    } else {
        Failure::Away(said)
    }
}

/// Finds the error of the operating system in an error of a shared folder.
fn of_file(error: &Error) -> Option<io::ErrorKind> {
    let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(error);
    while let Some(error) = cause {
        if let Some(error) = error.downcast_ref::<io::Error>() {
            return Some(error.kind());
        }
        cause = error.source();
    }
    None
}
