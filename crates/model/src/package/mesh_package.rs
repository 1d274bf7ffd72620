//! Package without matrices: a zip whose `sector.json` names a mesh file.

use std::collections::BTreeMap;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::archive::{Archive, inside};
use super::error::{MANIFEST_FILE, ManifestProblem, PackageError};
use super::limits::Limits;
use super::manifest;
use super::quote::quoted;
use super::zip_package::{manifest_text, missing};

/// Field of `sector.json` that names the mesh file.
const MESH_FILE: &str = "mesh_file";

/// Content of a package without matrices.
#[derive(Debug)]
pub struct MeshPackage<T> {
    /// Settings: `sector.json`.
    pub settings: T,
    /// Name of the mesh file.
    pub mesh: String,
    /// Content of all files but `sector.json`, which the mesh file may include, by their names.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Reads the package at `path`; none if its `sector.json` names no mesh file, so that it has matrices.
///
/// # Errors
/// Errors of the archive, settings that are not valid, and a mesh file that is not there.
pub fn read_mesh_package<T: DeserializeOwned>(
    path: &Path,
    limits: &Limits,
) -> Result<Option<MeshPackage<T>>, PackageError> {
    let archive = Archive::open(path, limits)?;
    let text = manifest_text(&archive, limits)?;
    let plain = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let stated = serde_json::from_slice::<Value>(plain).ok().and_then(|value| value.get(MESH_FILE).cloned());
    let Some(stated) = stated else { return Ok(None) };
    let settings = manifest::parse(&text)?;
    let field = format!("/{MESH_FILE}");
    let name = stated.as_str().unwrap_or_default();
    let Some(wanted) = inside(name).filter(|inside| !inside.is_empty()) else {
        return Err(PackageError::manifest(field, ManifestProblem::BadFileName { name: quoted(name) }));
    };
    let Some(mesh) = archive.stored_name(&wanted).map(ToOwned::to_owned) else {
        return Err(PackageError::manifest(field, missing(&archive, &wanted)));
    };
    let mut files = BTreeMap::new();
    for name in archive.names().filter(|name| *name != MANIFEST_FILE) {
        let read = archive.read(name, |source| {
            let mut bytes = Vec::new();
            source.read_to_end(&mut bytes).map_err(|error| archive.fault(name, error))?;
            Ok(bytes)
        })?;
        files.insert(name.to_owned(), read.value);
    }
    Ok(Some(MeshPackage { settings, mesh, files }))
}
