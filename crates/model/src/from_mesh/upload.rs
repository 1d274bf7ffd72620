//! Meshes as they are uploaded: bare, or in a package without matrices.

use std::path::Path;

use rubmap_mesh::{MeshFile, MeshFileError};

use super::error::FromMeshError;
use super::look::{MeshLook, look};
use super::sector::{Sector, sector};
use super::settings::MeshSettings;
use crate::package::{Limits, PackageError, open_mesh_package};

/// Sector of the package at `path`; none if the package has matrices.
///
/// # Errors
/// Errors of the archive and of `sector.json`; [`PackageError::Mesh`] for a mesh file that cannot be read or makes no model.
pub fn sector_of_package(path: &Path, limits: &Limits) -> Result<Option<Sector>, PackageError> {
    let Some(package) = open_mesh_package::<MeshSettings>(path, limits)? else { return Ok(None) };
    let bytes = package.file(&package.mesh)?;
    let include = |name: &str| package.file(name).map_err(|_| "the package has no such file".to_owned());
    let file = rubmap_mesh::read(&bytes, &include);
    let mut settings = package.settings.clone();
    let stem = Path::new(&package.mesh).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    settings.name = settings.name.or(stem);
    made(file, &settings, Some(&package.mesh), sector).map(Some)
}

/// Sector of a bare mesh, which includes no other file.
///
/// # Errors
/// [`PackageError::Mesh`] for a mesh that cannot be read or makes no model.
pub fn sector_of_mesh(bytes: &[u8], settings: &MeshSettings) -> Result<Sector, PackageError> {
    made(bare(bytes), settings, None, sector)
}

/// Look at a bare mesh, which includes no other file.
///
/// # Errors
/// [`PackageError::Mesh`] for a mesh that cannot be read, or settings that contradict each other.
pub fn look_at_mesh(bytes: &[u8], settings: &MeshSettings) -> Result<MeshLook, PackageError> {
    made(bare(bytes), settings, None, look)
}

fn bare(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let include = |_: &str| Err("put both files into one, or in a zip with sector.json".to_owned());
    rubmap_mesh::read(bytes, &include)
}

fn made<T>(
    file: Result<MeshFile, MeshFileError>,
    settings: &MeshSettings,
    name: Option<&str>,
    make: impl Fn(&MeshFile, &MeshSettings) -> Result<T, FromMeshError>,
) -> Result<T, PackageError> {
    let named = |line: u64, message: String| PackageError::Mesh {
        file: name.map(ToOwned::to_owned),
        line: (line > 0).then_some(line),
        message,
    };
    let file = file.map_err(|error| named(error.line, error.to_string()))?;
    make(&file, settings).map_err(|error| {
        let line = if let FromMeshError::Element { line, .. } = error { line } else { 0 };
        named(line, error.to_string())
    })
}
