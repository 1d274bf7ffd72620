//! Mesh files of other programs: nodes, elements, sets, materials and supports, as the file states them.
//!
//! ```text
//! bytes ── plain (gzip, UTF-16) ── format (recognised by content) ── reader of that format ──▶ MeshFile
//! ```
//!
//! A reader carries over all that a model of a sector is made of, or refuses the file with the card and the line of what it cannot carry
//! over: nothing is dropped in silence. Elements of lines and surfaces are left out and counted by their names. Geometry is judged elsewhere.

mod ansys;
mod collapse;
pub mod error;
pub mod fields;
pub mod format;
mod gmsh;
mod include;
pub mod inp;
mod lines;
pub mod matrices;
pub mod mesh_file;
mod nastran;
mod plain;
mod solids;
mod vtu;
mod whole;

use std::borrow::Cow;

pub use error::{MeshFileError, MeshProblem};
pub use format::MeshFormat;
pub use include::Include;
pub use mesh_file::{FileElement, FileMaterial, MeshFile};

/// Reads a mesh file, whose format its content shows; it may be packed by gzip, and text may be in UTF-16.
///
/// `include` gives the content of another file by the name under which this one includes it, or says why it cannot.
///
/// # Errors
/// The first problem, with its line and card.
pub fn read(bytes: &[u8], include: &Include<'_>) -> Result<MeshFile, MeshFileError> {
    let bytes = &*plain::plain(bytes)?;
    let include = &|name: &str| {
        let file = include(name)?;
        plain::plain(&file).map(Cow::into_owned).map_err(|error| error.to_string())
    };
    let format = format::recognised(bytes).map_err(|error| match error.problem {
        MeshProblem::Unknown if matrices::is_matrix(bytes) => {
            let advice = "give it to `rubmap import matrices` beside the mesh";
            MeshProblem::NotAMesh { found: "a matrix file", advice }.at(0, "")
        }
        _ => error,
    })?;
    read_as(format, bytes, include)
}

/// Reads a mesh file of a known format.
///
/// # Errors
/// The first problem, with its line and card.
pub fn read_as(format: MeshFormat, bytes: &[u8], include: &Include<'_>) -> Result<MeshFile, MeshFileError> {
    match format {
        MeshFormat::Inp => inp::read(bytes, include),
        MeshFormat::Gmsh => gmsh::read(bytes),
        MeshFormat::Nastran => nastran::read(bytes, include),
        MeshFormat::Ansys => ansys::read(bytes),
        MeshFormat::Vtu => vtu::read(bytes),
    }
}
