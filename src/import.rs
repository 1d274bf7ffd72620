//! Import of model packages: receives or writes the file, reads and checks it, stores it as a model.
//!
//! Uploads and the generator share it; it needs no job.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind};
use std::path::Path;
use std::sync::Arc;

use futures::{Stream, StreamExt};
use tempfile::{NamedTempFile, TempPath};
use tokio::io::AsyncWriteExt;
use tokio_util::bytes::Bytes;

use crate::analysis::run::ModelFacts;
use crate::dynamics::nodes::SectorNode;
use crate::from_mesh::{self, FromMeshError, LookRefusal, LookStep, MeshLook, MeshSettings, Sector};
use crate::memory::Memory;
use crate::package::raw::RawPackage;
use crate::package::{self, Limits, PackageError};
use crate::pool::{CpuPool, Panicked};
use crate::store::labels::Labels;
use crate::store::limits::{self, LimitReached};
use crate::store::models::StoredModel;
use crate::store::{Store, StoreError};

/// Ratio of the memory that reading a package or a mesh takes to the size of its file.
const EXPANSION: u64 = 12;

/// Bytes of an upload that are written at once.
const PIECE: usize = 1 << 20;

/// Importer of model packages.
#[derive(Debug)]
pub struct Importer {
    store: Store,
    /// Threads of its own, so that uploads do not wait behind speeds.
    threads: CpuPool,
    memory: Arc<Memory>,
    /// Largest upload, in bytes as sent.
    upload_bytes: u64,
    /// Limits while an uploaded package is read.
    limits: Limits,
}

/// Package that passed every check, in a file beside the models.
#[derive(Debug)]
pub struct CheckedPackage {
    /// Facts of the model.
    pub facts: ModelFacts,
    /// Id of the model: the digest of the package's content.
    pub id: String,
    file: TempPath,
}

/// Reason why an upload was not received.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    /// Upload that broke off.
    #[error("the upload broke off: {0}")]
    BrokeOff(String),
    /// Upload that is larger than this service allows.
    #[error("a model package may have {0} bytes on this service")]
    TooLarge(u64),
    /// Failure to write the file.
    #[error(transparent)]
    File(#[from] io::Error),
}

impl CheckedPackage {
    /// Reads and checks the package in `file`.
    ///
    /// # Errors
    /// Errors of [`package::read`].
    pub fn read(file: TempPath, limits: &Limits) -> Result<Self, PackageError> {
        let read = package::read(&file, limits)?;
        let facts = ModelFacts::of_package(&read.sector, read.mesh.as_ref(), &read.findings);
        Ok(Self { facts, id: read.digest, file })
    }

    /// Assembles the matrices of a sector into `file`, beside the models, and reads and checks the package.
    fn assemble(sector: &Sector, file: NamedTempFile, limits: &Limits) -> Result<Self, PackageError> {
        let message =
            |error: FromMeshError| PackageError::Mesh { file: None, line: None, message: error.to_string() };
        let made = sector.package().map_err(message)?;
        let (handle, path) = file.into_parts();
        write_to(handle, &made)?;
        drop(made);
        let mut checked = Self::read(path, limits)?;
        checked.facts.found = sector.found.to_string().lines().map(ToOwned::to_owned).collect();
        Ok(checked)
    }
}

/// Upload before it is checked.
#[derive(Debug)]
pub enum Upload {
    /// Package, with matrices or with a mesh file.
    Package(TempPath),
    /// Bare mesh, with the settings of its model.
    Mesh(TempPath, Box<MeshSettings>),
}

/// Upload that was read.
enum Received {
    Checked(CheckedPackage),
    /// Sector whose matrices are not assembled yet.
    Sector(Sector),
}

impl Upload {
    fn file(&self) -> &TempPath {
        let (Self::Package(file) | Self::Mesh(file, _)) = self;
        file
    }

    fn read(self, limits: &Limits) -> Result<Received, PackageError> {
        match self {
            Self::Package(file) => match from_mesh::sector_of_package(&file, limits)? {
                Some(sector) => Ok(Received::Sector(sector)),
                None => CheckedPackage::read(file, limits).map(Received::Checked),
            },
            Self::Mesh(file, settings) => {
                from_mesh::sector_of_mesh(&std::fs::read(&file)?, &settings).map(Received::Sector)
            }
        }
    }
}

impl Importer {
    /// Creates an importer with threads of its own and the memory that it shares with jobs; the limits are for uploads.
    pub(crate) fn new(
        store: Store,
        threads: CpuPool,
        memory: Arc<Memory>,
        upload_bytes: u64,
        limits: Limits,
    ) -> Self {
        Self { store, threads, memory, upload_bytes, limits }
    }

    /// Refuses an upload that is declared larger than this service allows.
    ///
    /// # Errors
    /// [`UploadError::TooLarge`].
    pub fn check_size(&self, declared_bytes: Option<u64>) -> Result<(), UploadError> {
        match declared_bytes {
            Some(bytes) if bytes > self.upload_bytes => Err(UploadError::TooLarge(self.upload_bytes)),
            _ => Ok(()),
        }
    }

    /// Writes an upload to a file beside the models, piece by piece; `seen` is shown every piece.
    ///
    /// # Errors
    /// An upload that breaks off or is too large; those of the disk.
    pub async fn receive<E: std::fmt::Display>(
        &self,
        mut pieces: impl Stream<Item = Result<Bytes, E>> + Unpin,
        mut seen: impl FnMut(&Bytes),
    ) -> Result<TempPath, UploadError> {
        let (file, path) = self.store.new_upload().await?.into_parts();
        let mut file = tokio::io::BufWriter::with_capacity(PIECE, tokio::fs::File::from_std(file));
        let mut received = 0;
        while let Some(piece) = pieces.next().await {
            let piece = piece.map_err(|error| UploadError::BrokeOff(error.to_string()))?;
            received += piece.len() as u64;
            self.check_size(Some(received))?;
            seen(&piece);
            file.write_all(&piece).await?;
        }
        file.flush().await?;
        Ok(path)
    }

    /// Writes a package that was made here to a file beside the models; a failed attempt leaves none.
    pub(crate) async fn write(
        &self,
        package: Arc<RawPackage>,
    ) -> Result<Result<TempPath, Panicked>, StoreError> {
        let (file, path) = self.store.new_upload().await?.into_parts();
        match self.threads.run(move || write_to(file, &package)).await {
            Ok(written) => written.map(|()| Ok(path)).map_err(StoreError::File),
            Err(panicked) => Ok(Err(panicked)),
        }
    }

    /// Reads and checks an upload; assembles the matrices of a mesh.
    pub async fn check(&self, upload: Upload) -> Result<Result<CheckedPackage, Box<PackageError>>, Panicked> {
        // The expanded size is not known yet; texts of numbers shrink to a fifth or less.
        let bytes = upload.file().metadata().map_or(0, |file| file.len().saturating_mul(EXPANSION));
        let memory = self.memory.hold_up_to(bytes).await;
        let limits = self.limits.clone();
        let read = move || {
            let _memory = memory;
            upload.read(&limits).map_err(Box::new)
        };
        let sector = match self.threads.run_parallel(read).await? {
            Ok(Received::Sector(sector)) => sector,
            Ok(Received::Checked(checked)) => return Ok(Ok(checked)),
            Err(error) => return Ok(Err(error)),
        };
        let needed = sector.assembly_bytes();
        if let Some(message) = self.too_large(needed) {
            return Ok(Err(Box::new(PackageError::Mesh { file: None, line: None, message })));
        }
        let memory = self.memory.hold_up_to(needed).await;
        let file = match self.store.new_upload().await {
            Ok(file) => file,
            Err(source) => return Ok(Err(Box::new(source.into()))),
        };
        // Made here, the package may be larger than what may be uploaded.
        let limits = Limits::default();
        let assemble = move || {
            let _memory = memory;
            CheckedPackage::assemble(&sector, file, &limits).map_err(Box::new)
        };
        self.threads.run_parallel(assemble).await
    }

    /// Looks at a bare mesh, of which nothing is kept.
    pub(crate) async fn look(
        &self,
        file: TempPath,
        settings: MeshSettings,
    ) -> Result<Result<MeshLook, Box<PackageError>>, Panicked> {
        let bytes = file.metadata().map_or(0, |file| file.len().saturating_mul(EXPANSION));
        let memory = self.memory.hold_up_to(bytes).await;
        let read = move || {
            let _memory = memory;
            let bytes = std::fs::read(&file).map_err(PackageError::from)?;
            from_mesh::look_at_mesh(&bytes, &settings)
        };
        let look = self.threads.run_parallel(move || read().map_err(Box::new)).await?;
        Ok(look.map(|mut look| {
            let refusal = |detail| LookRefusal { step: LookStep::Memory, detail };
            look.refusals.extend(self.too_large(look.price.memory_bytes).map(refusal));
            look
        }))
    }

    /// Reason why a mesh whose assembly needs these bytes of memory is refused, if it is.
    fn too_large(&self, needed: u64) -> Option<String> {
        let most = self.memory.most().filter(|&most| needed > most)?;
        Some(format!(
            "assembling this mesh needs {needed} bytes of memory, and this service gives one computation {most}: make the package with \
             `rubmap import mesh` on a larger machine, or use a coarser mesh"
        ))
    }

    /// Stores a package as a model of `owner`; returns the model and whether it is new. May be repeated where the disk was full.
    pub async fn store(
        &self,
        owner: &str,
        limits: limits::Limits,
        labels: &Labels,
        package: &CheckedPackage,
    ) -> Result<Result<(StoredModel, bool), LimitReached>, StoreError> {
        let CheckedPackage { facts, id, file } = package;
        self.store.insert_model((owner, limits), id, facts, labels, file).await
    }

    /// Runs `act` with the nodes of a stored package, on a thread of the importer.
    pub(crate) async fn with_nodes<T: Send + 'static>(
        &self,
        model: &str,
        act: impl FnOnce(&[SectorNode]) -> T + Send + 'static,
    ) -> Result<Result<T, StoreError>, Panicked> {
        match self.store.package(model).await {
            Ok(path) => self.threads.run(move || read_nodes(&path).map(|nodes| act(&nodes))).await,
            Err(error) => Ok(Err(error)),
        }
    }
}

/// Nodes of a stored package.
fn read_nodes(path: &Path) -> Result<Vec<SectorNode>, StoreError> {
    package::read_nodes(path, &Limits::default()).map_err(|error| match error {
        PackageError::Io { source } => StoreError::Package(source),
        error => StoreError::Package(io::Error::new(ErrorKind::InvalidData, error.to_string())),
    })
}

/// Writes `package` to `file`. Nothing is wrong with the package yet: errors are those of the disk.
fn write_to(file: File, package: &RawPackage) -> io::Result<()> {
    package::write(package, BufWriter::new(file)).map_err(|error| match error {
        PackageError::Io { source } => source,
        error => io::Error::other(error),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impeller::{Preset, generate};

    #[test]
    fn a_package_that_finds_no_room_is_known_by_it() {
        let package = generate(&Preset::Small.parameters()).unwrap();
        let full = File::options().write(true).open("/dev/full").unwrap();
        let error = StoreError::from(write_to(full, &package).unwrap_err());
        assert!(error.is_disk_full(), "{error}");
    }
}
