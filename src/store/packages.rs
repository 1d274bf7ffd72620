//! Paths of the packages of models in a data folder.

use std::io;
use std::path::{Path, PathBuf};

/// Name of the folder of packages.
const FOLDER: &str = "models";

/// Path of the folder of packages in a data folder.
pub(super) fn packages_folder(data: &Path) -> PathBuf {
    data.join(FOLDER)
}

/// Path of the package of `model`.
pub(super) fn package_path(data: &Path, model: &str) -> PathBuf {
    packages_folder(data).join(format!("{model}.zip"))
}

/// Model whose package has this file name, if any.
pub(super) fn model_of(name: &str) -> Option<&str> {
    name.strip_suffix(".zip").filter(|id| id.len() == 64 && id.bytes().all(|byte| byte.is_ascii_hexdigit()))
}

/// Number of packages in a data folder.
pub(super) fn count_packages(data: &Path) -> io::Result<usize> {
    let mut packages = 0;
    for file in std::fs::read_dir(packages_folder(data))? {
        packages += usize::from(file?.file_name().to_str().and_then(model_of).is_some());
    }
    Ok(packages)
}
