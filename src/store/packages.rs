//! Where the packages of models lie in a data folder.

use std::io;
use std::path::{Path, PathBuf};

/// Name of their folder.
const FOLDER: &str = "models";

/// Their folder in a data folder.
pub(super) fn packages_folder(data: &Path) -> PathBuf {
    data.join(FOLDER)
}

/// Where the package of `model` lies.
pub(super) fn package_path(data: &Path, model: &str) -> PathBuf {
    packages_folder(data).join(format!("{model}.zip"))
}

/// The model whose package a file of this name is, if any.
pub(super) fn model_of(name: &str) -> Option<&str> {
    name.strip_suffix(".zip").filter(|id| id.len() == 64 && id.bytes().all(|byte| byte.is_ascii_hexdigit()))
}

/// How many packages there are.
pub(super) fn count_packages(data: &Path) -> io::Result<usize> {
    let mut packages = 0;
    for file in std::fs::read_dir(packages_folder(data))? {
        packages += usize::from(file?.file_name().to_str().and_then(model_of).is_some());
    }
    Ok(packages)
}
