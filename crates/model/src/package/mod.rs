//! Model package of docs/package.md: read, check, rotate to cylindrical components; and write.
//!
//! ```text
//! file ── importer ──▶ Content ── check ──▶ Layout ── frame, partition ──▶ SectorModel
//!         zip_package  (RawPackage,          (which row is what)
//!                       lines, digest)
//! ```
//!
//! The files of other programs become packages at the door: an importer is a function from them to a `RawPackage`
//! ([`calculix`]), and [`write()`] makes a file of it. Everything after it is shared.

mod archive;
pub(crate) mod by_place;
pub mod calculix;
pub(crate) mod check;
mod content;
mod coriolis;
mod digest;
pub mod error;
mod findings;
mod limits;
mod lines;
mod manifest;
mod matrix_market;
mod mesh;
mod mesh_package;
mod nodes;
mod npy;
mod npz;
mod partition;
mod places;
pub(crate) mod quote;
pub mod raw;
mod symmetric;
mod tables;
pub(crate) mod units;
mod writer;
mod zip_package;

use std::path::Path;

pub use coriolis::gyroscopic_of_mass;
pub use error::PackageError;
pub use limits::Limits;
pub use mesh::read_mesh;
pub use mesh_package::{MeshPackage, open_mesh_package};
pub use nodes::read_nodes;
pub use npz::NpzWriter;
pub use places::{Face, PlacedNode, SectorNodes, read_places};
pub use writer::write;

use content::{Content, SourceLines};
use raw::RawPackage;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::findings::Findings;
use rubmap_wheel::dynamics::sector::{SectorModel, SectorParts};

/// Package that passed every check.
#[derive(Debug, Clone)]
pub struct Imported {
    /// Sector in cylindrical components, high face eliminated.
    pub sector: SectorModel,
    /// Content address: 64 lowercase hexadecimal digits.
    ///
    /// SHA-256 over what `sector.json` states and the decompressed bytes of the other files; the same files zipped
    /// again, in other order or compression, with matrices gzipped or not, have the same address. The same matrices
    /// as Matrix Market and as `.npz` are different bytes, and have different ones.
    pub digest: String,
    /// Elements, if the package has them.
    pub mesh: Option<SectorMesh>,
    /// Findings: the size of the model, and what looks wrong in it.
    pub findings: Findings,
}

/// Reads, checks and converts the package at `path`.
///
/// ```
/// use rubmap_model::impeller::{CantileverParameters, cantilever};
/// use rubmap_model::package::{Limits, read, write};
///
/// let beam = cantilever(&CantileverParameters { elements: [4, 1, 1], ..CantileverParameters::default() })?;
/// let file = tempfile::NamedTempFile::new()?;
/// write(&beam, &file)?;
///
/// let imported = read(file.path(), &Limits::default())?;
/// assert_eq!(imported.digest.len(), 64);
/// // Three rows a node, but for those that are clamped at the root.
/// assert_eq!(imported.sector.own_dofs(), beam.dofs.len());
/// assert!(beam.dofs.len() < 3 * beam.nodes.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first problem found, in the order: archive, `sector.json`, tables, matrices, contradictions between them.
pub fn read(path: &Path, limits: &Limits) -> Result<Imported, PackageError> {
    let Content { package, lines, digest } = zip_package::load(path, limits)?;
    let (sector, mesh, findings) = convert(package, &lines)?;
    Ok(Imported { sector, digest, mesh, findings })
}

/// Digest of the package at `path`, as in [`Imported::digest`], without its matrices in memory where they are text.
///
/// # Errors
///
/// Errors of the archive, `sector.json` and the tables; the content of the matrices is not checked.
pub fn read_digest(path: &Path, limits: &Limits) -> Result<String, PackageError> {
    zip_package::load_digest(path, limits)
}

/// Reads the package at `path` as its files state it: the inverse of [`write()`]. Matrices come sorted by column, then
/// row.
///
/// # Errors
///
/// Errors of [`read`], except those found only on the package as a whole: cyclic symmetry, contact, mass, units.
pub fn read_raw(path: &Path, limits: &Limits) -> Result<RawPackage, PackageError> {
    zip_package::load(path, limits).map(|content| content.package)
}

/// Checks and converts a package that was made in memory, by the same rules as [`read`].
///
/// # Errors
///
/// The first problem found; table lines in it are those that [`write()`] would give.
pub fn to_sector(package: RawPackage) -> Result<SectorModel, PackageError> {
    convert(package, &SourceLines::default()).map(|(sector, ..)| sector)
}

/// Checks a package that was made in memory, by the same rules as [`read`], and returns the findings about it.
///
/// # Errors
///
/// Errors of [`to_sector`].
pub fn look_at(package: RawPackage) -> Result<Findings, PackageError> {
    convert(package, &SourceLines::default()).map(|(.., findings)| findings)
}

fn convert(
    mut package: RawPackage,
    lines: &SourceLines,
) -> Result<(SectorModel, Option<SectorMesh>, Findings), PackageError> {
    let mut layout = check::check(&mut package, lines)?;
    let mesh = layout.mesh.take();
    let mut findings = findings::of_matrices(&package, &layout)?;
    let names = package.manifest.clone();
    let row_names: Vec<u64> = layout.own_rows.iter().map(|&row| package.dofs[row as usize].node).collect();
    let sector = sound(partition::build(package, &layout));
    check::mass::check(&sector, &names.mass, &layout.own_rows, &row_names)?;
    if let Some(mesh) = &mesh {
        check::agreement::check(&sector, mesh, &layout, &names)?;
    }
    check::materials::check_solids(&names)?;
    findings.in_si = findings::in_si::of(&sector, mesh.as_ref(), &layout);
    let mut parts = sector.into_parts();
    units::count_time_in_seconds(&mut parts);
    Ok((sound(parts), mesh, findings))
}

/// Makes a sector of parts that were checked.
fn sound(parts: SectorParts) -> SectorModel {
    SectorModel::new(parts).unwrap_or_else(|unsound| unreachable!("the package was checked: {unsound}"))
}
