//! Checks that every format's mesh goes through once it is read.

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;

/// Checks that a mesh has solid elements and that their nodes are there; `card` is the place of elements in the file.
pub(crate) fn check(mesh: &MeshFile, card: &str) -> Result<(), MeshFileError> {
    if mesh.elements.is_empty() {
        let names = mesh.left_out.iter().map(|(name, count)| format!("{count} of type {name}"));
        let names: Vec<String> = names.collect();
        let left_out =
            if names.is_empty() { String::new() } else { format!(" (left out: {})", names.join(", ")) };
        return Err(MeshProblem::NoSolids { left_out }.at(0, ""));
    }
    for (&element, found) in &mesh.elements {
        if let Some(&node) = found.nodes.iter().find(|&node| !mesh.nodes.contains_key(node)) {
            return Err(MeshProblem::NoSuchNode { element, node }.at(found.line, card));
        }
    }
    Ok(())
}
