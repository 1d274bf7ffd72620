//! Mesh files of other programs: nodes, elements, sets, materials and supports, as the file states them.
//!
//! ```text
//! bytes ── format (recognised by content) ── reader of that format ──▶ MeshFile
//! ```
//!
//! A reader carries over all that a model of a sector is made of, or refuses the file with the card and the line of what it cannot carry
//! over: nothing is dropped in silence. Elements of lines and surfaces are left out and counted by their names. Geometry is judged elsewhere.

pub mod collapse;
pub mod error;
mod fields;
pub mod format;
pub mod matrices;
pub mod mesh_file;

pub use error::{MeshFileError, MeshProblem};
pub use format::MeshFormat;
pub use mesh_file::{FileElement, FileMaterial, MeshFile};

/// Source of the files that a mesh file includes.
pub type Include<'a> = dyn Fn(&str) -> Result<Vec<u8>, String> + 'a;
