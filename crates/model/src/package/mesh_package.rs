//! Package without matrices: a zip whose `sector.json` names a mesh file.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::archive::{Archive, inside};
use super::error::{ManifestProblem, PackageError};
use super::limits::Limits;
use super::manifest;
use super::quote::quoted;
use super::zip_package::{manifest_text, missing};

/// Package without matrices.
#[derive(Debug)]
pub struct MeshPackage<T> {
    /// Settings: `sector.json`.
    pub settings: T,
    /// Name of the mesh file.
    pub mesh: String,
    archive: Archive,
}

/// Field of `sector.json` that tells packages without matrices from others.
#[derive(Deserialize)]
struct Stated {
    mesh_file: Option<Value>,
}

/// Opens the package at `path`; none if its `sector.json` names no mesh file, so that it has matrices.
///
/// # Errors
/// Errors of the archive, settings that are not valid, and a mesh file that is not there.
pub fn open_mesh_package<T: DeserializeOwned>(
    path: &Path,
    limits: &Limits,
) -> Result<Option<MeshPackage<T>>, PackageError> {
    let archive = Archive::open(path, limits)?;
    let text = manifest_text(&archive, limits)?;
    let plain = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let stated = serde_json::from_slice::<Stated>(plain).ok().and_then(|stated| stated.mesh_file);
    let Some(stated) = stated else { return Ok(None) };
    let settings = manifest::parse(&text)?;
    let field = "/mesh_file";
    let name = stated.as_str().unwrap_or_default();
    let Some(wanted) = inside(name).filter(|inside| !inside.is_empty()) else {
        return Err(PackageError::manifest(field, ManifestProblem::BadFileName { name: quoted(name) }));
    };
    let Some(mesh) = archive.stored_name(&wanted).map(ToOwned::to_owned) else {
        return Err(PackageError::manifest(field, missing(&archive, &wanted)));
    };
    Ok(Some(MeshPackage { settings, mesh, archive }))
}

impl<T> MeshPackage<T> {
    /// Content of a file of the package.
    ///
    /// # Errors
    /// Errors of the archive; [`ManifestProblem::FileMissing`] for a file that is not there.
    pub fn file(&self, name: &str) -> Result<Vec<u8>, PackageError> {
        let wanted = inside(name).unwrap_or_default();
        let Some(stored) = self.archive.stored_name(&wanted) else {
            return Err(PackageError::manifest("/mesh_file", missing(&self.archive, &wanted)));
        };
        let read = self.archive.read(stored, |source| {
            let mut bytes = Vec::new();
            source.read_to_end(&mut bytes).map_err(|error| self.archive.fault(stored, error))?;
            Ok(bytes)
        })?;
        Ok(read.value)
    }
}
