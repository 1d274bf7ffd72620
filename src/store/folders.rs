//! Folders of files that belong to one reduction each: `<model>-<modes_per_speed>`.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::analysis::run::VERSION;

/// Name of the folder of the reduction of `model` with this number of modes per speed.
pub(super) fn folder_name(model: &str, modes_per_speed: u32) -> String {
    format!("{model}-{modes_per_speed}")
}

/// Model whose reduction the folder `name` belongs to.
pub(super) fn model_of(name: &str) -> &str {
    name.rsplit_once('-').map_or(name, |(model, _)| model)
}

/// Prefix of the names of files in `layout` that this program can read.
pub(super) fn prefix(layout: i64) -> String {
    format!("{VERSION}-{layout}-")
}

/// Removes the folders in `root` whose names `which` selects.
pub(super) async fn remove_folders(root: &Path, which: impl Fn(&str) -> bool) -> std::io::Result<()> {
    for folder in entries(root).await? {
        if which(file_name(&folder)) {
            tokio::fs::remove_dir_all(folder).await?;
        }
    }
    Ok(())
}

/// Removes the files in the folders of `root` whose names do not begin with `prefix`.
pub(super) async fn remove_files_but(root: &Path, prefix: &str) -> std::io::Result<()> {
    for folder in entries(root).await? {
        for file in entries(&folder).await? {
            if !file_name(&file).starts_with(prefix) {
                tokio::fs::remove_file(file).await?;
            }
        }
    }
    Ok(())
}

/// Entries of a folder; nothing if there is no such folder.
pub(super) async fn entries(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    match tokio::fs::read_dir(folder).await {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(error),
        Ok(mut entries) => {
            while let Some(entry) = entries.next_entry().await? {
                found.push(entry.path());
            }
        }
    }
    Ok(found)
}

/// Last part of a path.
pub(super) fn file_name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}
