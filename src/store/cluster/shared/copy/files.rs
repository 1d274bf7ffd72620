//! Files of a data folder, copied into an object store.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use sqlx::AnyConnection;

use super::error::{CopyError, Differences};
use super::tally::{Copied, CopyProgress};
use crate::store::error::StoreError;
use crate::store::folders::{entries, file_name, model_of, prefix};
use crate::store::objects::Objects;
use crate::store::packages::package_path;
use crate::store::{bases, checkpoints};

/// File to be copied.
struct Original {
    path: PathBuf,
    bytes: u64,
    /// Whether the file is a package, which cannot be computed again: its content is compared, not only its size.
    is_package: bool,
}

/// Copies the files that belong to the models of `source`, the database of the data folder `data`.
pub(super) async fn copy(
    data: &Path,
    source: &mut AnyConnection,
    objects: &Objects,
    copied: &mut Copied,
    differences: &mut Differences,
    progress: &mut impl FnMut(CopyProgress),
) -> Result<(), CopyError> {
    let originals = originals(data, source).await?;
    let total = originals.iter().map(|original| original.bytes).sum();
    let mut done = 0;
    for original in originals {
        progress(CopyProgress::Files(done, total));
        let mut same = is_there(objects, &original).await?;
        if same.is_none() {
            objects.publish(&original.path).await.map_err(StoreError::Objects)?;
            copied.new_files += 1;
            same = is_there(objects, &original).await?;
        }
        if same != Some(true) {
            let name = original.path.strip_prefix(data).unwrap_or(&original.path);
            differences.add(|| format!("object {}", name.display()));
        }
        copied.files += 1;
        done += original.bytes;
    }
    progress(CopyProgress::Files(done, total));
    Ok(())
}

/// Files to be copied: packages, and the bases, stress and checkpoints that this version of the program can read.
async fn originals(data: &Path, source: &mut AnyConnection) -> Result<Vec<Original>, StoreError> {
    let models: Vec<String> =
        sqlx::query_scalar("select id from models order by id").fetch_all(source).await?;
    let models: BTreeSet<String> = models.into_iter().collect();
    let mut originals = Vec::new();
    for model in &models {
        let path = package_path(data, model);
        let bytes = path.metadata().map_err(|error| {
            StoreError::Package(io::Error::new(error.kind(), format!("of model {model}: {error}")))
        })?;
        originals.push(Original { path, bytes: bytes.len(), is_package: true });
    }
    let places = [(bases::FOLDER, prefix(bases::LAYOUT)), (checkpoints::FOLDER, checkpoints::prefix())];
    for (root, prefix) in places {
        for folder in entries(&data.join(root)).await? {
            if !models.contains(model_of(file_name(&folder))) {
                continue;
            }
            for path in entries(&folder).await? {
                if file_name(&path).starts_with(&prefix) {
                    let bytes = path.metadata()?.len();
                    originals.push(Original { path, bytes, is_package: false });
                }
            }
        }
    }
    Ok(originals)
}

/// Whether the object of the same name is equal; none if there is no such object.
async fn is_there(objects: &Objects, original: &Original) -> Result<Option<bool>, StoreError> {
    let Some(bytes) = objects.size(&original.path).await.map_err(StoreError::Objects)? else {
        return Ok(None);
    };
    if bytes != original.bytes || !original.is_package {
        return Ok(Some(bytes == original.bytes));
    }
    let there = objects.sha256(&original.path).await.map_err(StoreError::Objects)?;
    let path = original.path.clone();
    let here = tokio::task::spawn_blocking(move || sha256(&path)).await.map_err(io::Error::other)??;
    Ok(Some(there == Some(here)))
}

fn sha256(path: &Path) -> io::Result<[u8; 32]> {
    let mut sum = Sha256::new();
    io::copy(&mut std::fs::File::open(path)?, &mut sum)?;
    Ok(sum.finalize().into())
}
