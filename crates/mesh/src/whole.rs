//! Checks that every format's mesh goes through once it is read.

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;

/// Checks that a mesh has solid elements and that their nodes are there; `card` is the place of elements in the file.
pub(crate) fn check(mesh: &MeshFile, card: &str) -> Result<(), MeshFileError> {
    if mesh.elements.is_empty() {
        return Err(MeshProblem::NoSolids { left_out: mesh.left_out_said() }.at(0, ""));
    }
    for (&element, found) in &mesh.elements {
        if let Some(&node) = found.nodes.iter().find(|&node| !mesh.nodes.contains_key(node)) {
            return Err(MeshProblem::NoSuchNode { element, node }.at(found.line, card));
        }
    }
    Ok(())
}
