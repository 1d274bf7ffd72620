//! Solid elements on their way into a mesh, for the readers that know an element's nodes at once.

use std::collections::btree_map::Entry;

use rubmap_solid::element::ElementKind;

use crate::collapse::collapsed;
use crate::error::MeshProblem;
use crate::mesh_file::{FileElement, MeshFile};

/// Note on linear hexahedra of formats that do not state a formulation.
const LINEAR: &str = "linear hexahedra are read as C3D8I, which does not lock in bending";

/// Solid element of `nodes` in CalculiX's order; repeated nodes of hexahedra are taken together.
pub(crate) fn element(
    id: u64,
    kind: ElementKind,
    nodes: &[u64],
    line: u64,
) -> Result<FileElement, MeshProblem> {
    let (kind, nodes) = match kind.corners() {
        8 => collapsed(kind, nodes).ok_or(MeshProblem::Collapsed { element: id })?,
        _ => (kind, nodes.to_vec()),
    };
    Ok(FileElement { kind, nodes, line })
}

/// Adds an element whose nodes the mesh has.
pub(crate) fn add(mesh: &mut MeshFile, id: u64, element: FileElement) -> Result<(), MeshProblem> {
    if let Some(&node) = element.nodes.iter().find(|node| !mesh.nodes.contains_key(node)) {
        return Err(MeshProblem::NoSuchNode { element: id, node });
    }
    if element.kind == ElementKind::C3D8I && !mesh.notes.iter().any(|note| note == LINEAR) {
        mesh.note(LINEAR.to_owned());
    }
    match mesh.elements.entry(id) {
        Entry::Vacant(place) => {
            place.insert(element);
            Ok(())
        }
        Entry::Occupied(_) => Err(MeshProblem::Twice { what: "element", id }),
    }
}
