//! Parts of unfinished reductions, as files:
//! `checkpoints/<model>-<modes_per_speed>/<version>-<layout>-<part>`.
//!
//! Files, not rows: they are large, they may go at any time, and a full disk must not stop the reduction they belong to.

use std::collections::BTreeSet;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::slice;
use std::sync::{Arc, Mutex, PoisonError};

use sha2::{Digest, Sha256};

use super::bases::BasisFolder;
use super::error::StoreError;
use super::folders::{self, entries, file_name, folder_name, model_of, remove_files_but, remove_folders};
use super::handle::Store;
use super::objects::Objects;
use super::reductions;
use super::reserve::Reserve;
use super::unfinished::{UNFINISHED, unfinished_file};
use crate::dynamics::reduction::{BasisRows, Checkpoints};

/// Name of the folder of all checkpoints, in the data folder.
pub(super) const FOLDER: &str = "checkpoints";

/// Size in bytes of the header of a part: the number of bytes that follow (little-endian) and their SHA-256.
const HEADER: usize = 8 + 32;

/// Checkpoints of one reduction, and the basis that it produces.
#[derive(Debug, Clone)]
pub struct CheckpointFolder {
    folder: PathBuf,
    /// Basis of the reduction; none where it is left out.
    basis: Option<BasisFolder>,
    /// Reason why a part of the basis was not stored.
    lost: Arc<Mutex<Option<std::io::Error>>>,
    reserve: Reserve,
    objects: Objects,
}

impl Store {
    /// Checkpoints of the reduction of `model`.
    pub fn checkpoints(&self, model: &str, modes_per_speed: u32) -> CheckpointFolder {
        let folder = self.checkpoint_root().join(folder_name(model, modes_per_speed));
        let basis = Some(self.basis(model, modes_per_speed));
        let (reserve, objects) = (self.reserve.clone(), self.objects.clone());
        CheckpointFolder { folder, basis, lost: Arc::default(), reserve, objects }
    }

    /// Number of parts of all reductions of `model` that this program can read.
    pub(super) async fn parts_of_model(&self, model: &str) -> std::io::Result<u32> {
        let mut parts = 0;
        for folder in entries(&self.checkpoint_root()).await? {
            if model_of(file_name(&folder)) == model {
                parts += count_parts(&folder).await?;
            }
        }
        Ok(parts)
    }

    fn checkpoint_root(&self) -> PathBuf {
        self.folder.join(FOLDER)
    }

    /// Removes the checkpoints of one reduction, or of all reductions of a model.
    ///
    /// Unused checkpoints do no harm: files that cannot be removed are left to the next start.
    pub(super) async fn remove_checkpoints(&self, model: &str, modes_per_speed: Option<u32>) {
        let unused = |name: &str| match modes_per_speed {
            Some(modes_per_speed) => name == folder_name(model, modes_per_speed),
            None => model_of(name) == model,
        };
        let removed = async {
            remove_folders(&self.checkpoint_root(), unused).await?;
            self.objects.remove_folders(&self.checkpoint_root(), unused).await
        };
        if let Err(error) = removed.await {
            tracing::warn!(model.id = model, %error, "could not remove checkpoints");
        }
    }

    /// Removes checkpoints that will not be used: of deleted models, of stored reductions, of other versions of the program, and unfinished
    /// files.
    pub(super) async fn remove_stale_checkpoints(&self) -> Result<(), StoreError> {
        let models = sqlx::query_scalar("select id from models").fetch_all(&self.readers).await?;
        let models: BTreeSet<String> = models.into_iter().collect();
        let mut reduced = BTreeSet::new();
        for (model, modes_per_speed) in self.stored_reductions().await? {
            reduced.insert(folder_name(&model, modes_per_speed));
        }
        let root = self.checkpoint_root();
        let stale = |name: &str| !models.contains(model_of(name)) || reduced.contains(name);
        remove_folders(&root, stale).await?;
        remove_files_but(&root, &prefix()).await?;
        Ok(())
    }
}

/// Number of parts in a folder that this program can read.
async fn count_parts(folder: &Path) -> std::io::Result<u32> {
    let files = entries(folder).await?;
    Ok(files.iter().filter(|file| file_name(file).starts_with(&prefix())).count() as u32)
}

impl CheckpointFolder {
    /// Leaves out the basis.
    #[must_use]
    pub fn without_basis(self) -> Self {
        Self { basis: None, ..self }
    }

    /// Whether the basis of a finished reduction was stored beside it.
    ///
    /// # Errors
    /// The reason why the basis was not stored.
    pub fn kept_basis(&self) -> std::io::Result<bool> {
        let mut lost = self.lost.lock().unwrap_or_else(PoisonError::into_inner);
        lost.take().map_or(Ok(self.basis.is_some()), Err)
    }

    /// Number of parts that this program can read.
    pub(super) async fn parts(&self) -> std::io::Result<u32> {
        count_parts(&self.folder).await
    }

    fn path(&self, part: &str) -> PathBuf {
        self.folder.join(format!("{}{part}", prefix()))
    }

    fn write(&self, part: &str, bytes: &[u8]) -> std::io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        // The file is written whole and flushed before it gets its name: a name promises a part, even after a power cut.
        let mut file = unfinished_file(&self.folder, UNFINISHED)?;
        file.write_all(&(bytes.len() as u64).to_le_bytes())?;
        file.write_all(&Sha256::digest(bytes))?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        let path = self.path(part);
        file.persist(&path).map_err(|error| error.error)?;
        std::fs::File::open(&self.folder)?.sync_all()?;
        self.objects.publish_blocking(&path)
    }
}

impl Checkpoints for CheckpointFolder {
    fn load(&self, part: &str) -> Option<Vec<u8>> {
        let path = self.path(part);
        match self.objects.reading(slice::from_ref(&path), || read(&path)) {
            Ok(bytes) => {
                tracing::info!(part, folder = file_name(&self.folder), "continuing from a checkpoint");
                Some(bytes)
            }
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => {
                tracing::warn!(path = %path.display(), %error, "a checkpoint is unreadable; computing its part again");
                None
            }
        }
    }

    fn save(&self, part: &str, bytes: Vec<u8>) {
        if self.reserve.is_taken() {
            tracing::warn!(part, "no checkpoint: what room is left is for deletions");
            return;
        }
        match self.write(part, &bytes) {
            Ok(()) => tracing::info!(part, folder = file_name(&self.folder), "kept a checkpoint"),
            Err(error) => {
                tracing::warn!(part, folder = %self.folder.display(), %error, "could not keep a checkpoint; going on without");
            }
        }
    }

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        if let Some(Err(error)) = self.basis.as_ref().map(|basis| basis.keep(rows)) {
            *self.lost.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        }
    }
}

/// Prefix of the names of parts that this program can read.
pub(super) fn prefix() -> String {
    folders::prefix(reductions::LAYOUT)
}

/// Reads the bytes of a part, if they are those that were written.
fn read(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut file = std::fs::File::open(path)?;
    let mut header = [0; HEADER];
    file.read_exact(&mut header)?;
    let (length, checksum) = header.split_at(8);
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    if (bytes.len() as u64).to_le_bytes() != length {
        return Err(std::io::Error::new(ErrorKind::InvalidData, "its length is not the one it had"));
    }
    if *Sha256::digest(&bytes) != *checksum {
        return Err(std::io::Error::new(ErrorKind::InvalidData, "its bytes are not those that were written"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, CheckpointFolder) {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("checkpoints/model-20");
        let reserve = Reserve::of(root.path());
        let basis = BasisFolder::of(root.path(), "model-20", reserve.clone());
        (
            root,
            CheckpointFolder {
                folder,
                basis: Some(basis),
                lost: Arc::default(),
                reserve,
                objects: Objects::default(),
            },
        )
    }

    #[test]
    fn a_part_reads_back_and_a_later_one_replaces_it() {
        let (_root, checkpoints) = folder();
        assert_eq!(checkpoints.load("speed-0"), None);
        checkpoints.save("speed-0", vec![1, 2, 3]);
        checkpoints.save("speed-1", Vec::new());
        assert_eq!(checkpoints.load("speed-0"), Some(vec![1, 2, 3]));
        assert_eq!(checkpoints.load("speed-1"), Some(Vec::new()));
        checkpoints.save("speed-0", vec![4]);
        assert_eq!(checkpoints.load("speed-0"), Some(vec![4]));
        assert_eq!(std::fs::read_dir(&checkpoints.folder).unwrap().count(), 2, "nothing but the parts");
    }

    #[test]
    fn a_damaged_part_is_none() {
        let (_root, checkpoints) = folder();
        checkpoints.save("part", (0..100).collect());
        let path = checkpoints.path("part");
        let whole = std::fs::read(&path).unwrap();
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            assert_eq!(checkpoints.load("part"), None, "{length} of {} bytes", whole.len());
        }
        for at in 0..whole.len() {
            let mut spoilt = whole.clone();
            spoilt[at] ^= 4;
            std::fs::write(&path, spoilt).unwrap();
            assert_eq!(checkpoints.load("part"), None, "byte {at} is wrong");
        }
        std::fs::write(&path, [&whole[..], &[0]].concat()).unwrap();
        assert_eq!(checkpoints.load("part"), None, "one byte too many");
        std::fs::write(&path, whole).unwrap();
        assert_eq!(checkpoints.load("part"), Some((0..100).collect()));
    }

    #[test]
    fn what_cannot_be_written_is_only_not_kept() {
        let (root, checkpoints) = folder();
        // A file in place of the folder: no write succeeds.
        std::fs::write(root.path().join("checkpoints"), "").unwrap();
        checkpoints.save("part", vec![1]);
        assert_eq!(checkpoints.load("part"), None);
    }
}
