//! Solid elements of a mesh from those of the blocks.

use rubmap_solid::element::ElementKind;
use rubmap_solid::natural::EDGES;

use super::eblock::{CARD, Raw};
use super::etype::{ElementType, ElementTypes, Fate};
use crate::collapse::collapsed;
use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::{FileElement, MeshFile};

/// Puts elements into a mesh, solids only.
pub(super) fn place(raws: &[Raw], types: &ElementTypes, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
    for raw in raws {
        let found = solid(raw, types, mesh).map_err(|problem| problem.at(raw.line, CARD))?;
        let Some((kind, nodes)) = found else { continue };
        let element = FileElement { kind, nodes, line: raw.line };
        if mesh.elements.insert(raw.id, element).is_some() {
            return Err(MeshProblem::Twice { what: "element", id: raw.id }.at(raw.line, CARD));
        }
    }
    Ok(())
}

/// Kind and nodes of an element; none if it is left out.
fn solid(
    raw: &Raw,
    types: &ElementTypes,
    mesh: &mut MeshFile,
) -> Result<Option<(ElementKind, Vec<u64>)>, MeshProblem> {
    let missing = || MeshProblem::NoSuch { what: "element type", name: raw.etype.to_string() };
    let etype = types.get(raw.etype).ok_or_else(missing)?;
    let name = etype.name();
    let kind = match etype.fate() {
        Fate::LeftOut => {
            mesh.leave_out(&name);
            return Ok(None);
        }
        Fate::Refused(advice) => return Err(MeshProblem::NotCarried { what: name, advice }),
        Fate::Hexahedron8 => ElementKind::C3D8I,
        Fate::Hexahedron20 { reduced: true } => ElementKind::C3D20R,
        Fate::Hexahedron20 { reduced: false } => ElementKind::C3D20,
        Fate::Tetrahedron10 => ElementKind::C3D10,
        Fate::Tetrahedron4 => ElementKind::C3D4,
    };
    let Some(nodes) = &raw.nodes else {
        let advice = "write the archive by CDWRITE, which blocks solids as EBLOCK,19,SOLID";
        return Err(MeshProblem::NotCarried { what: format!("{name} in a block without SOLID"), advice });
    };
    let (found, nodes) = shaped(raw.id, kind, nodes, etype)?;
    match (kind, found) {
        (ElementKind::C3D8I, ElementKind::C3D8I) => {
            mesh.note(format!("{name} is read as C3D8I: hexahedra with incompatible modes"));
        }
        (ElementKind::C3D8I, _) => {
            mesh.note(format!("{name} with repeated nodes is read as {}", found.name()));
        }
        (ElementKind::C3D4, _) => {
            mesh.note(format!("{name} is read as C3D4: without the pressures at its nodes"));
        }
        _ => {}
    }
    Ok(Some((found, nodes)))
}

/// Kind and nodes of an element after repeated nodes are taken together.
fn shaped(
    id: u64,
    kind: ElementKind,
    nodes: &[u64],
    etype: &ElementType,
) -> Result<(ElementKind, Vec<u64>), MeshProblem> {
    let tetrahedron = matches!(kind, ElementKind::C3D4 | ElementKind::C3D10);
    let quadratic = matches!(kind, ElementKind::C3D10 | ElementKind::C3D20 | ElementKind::C3D20R);
    let hexahedron = if quadratic { ElementKind::C3D20 } else { ElementKind::C3D8 };
    let (kind, least) = if tetrahedron && nodes.len() > kind.nodes() {
        (hexahedron, 8)
    } else {
        (kind, if tetrahedron { 4 } else { 8 })
    };
    let full = kind.nodes();
    let corners = nodes.iter().take(least).all(|&node| node != 0);
    if nodes.len() < least || nodes.len() > full || !corners {
        let expected = format!("{full} nodes of element {id} ({})", etype.name());
        return Err(MeshProblem::Expected { expected });
    }
    // Dropped nodes at the end need not be written.
    let mut padded = nodes.to_vec();
    padded.resize(full, 0);
    let found = if kind.corners() == 8 { collapsed(kind, &padded) } else { Some((kind, padded.clone())) };
    match found {
        Some((found, nodes)) if !nodes.contains(&0) && (!tetrahedron || found.corners() == 4) => {
            Ok((found, nodes))
        }
        Some((_, nodes)) if nodes.contains(&0) => Err(dropped(id, etype)),
        None if drops(&padded) => Err(dropped(id, etype)),
        _ => Err(MeshProblem::Collapsed { element: id }),
    }
}

/// Whether an edge of a hexahedron between two nodes has no node in its middle.
fn drops(nodes: &[u64]) -> bool {
    let at = |k: usize| nodes.get(k);
    (8..nodes.len()).zip(EDGES).any(|(k, [a, b])| at(k) == Some(&0) && at(a) != at(b))
}

/// Refusal of an element without some of its mid-edge nodes.
fn dropped(id: u64, etype: &ElementType) -> MeshProblem {
    let what = format!("element {id} ({}) with dropped mid-edge nodes", etype.name());
    MeshProblem::NotCarried {
        what,
        advice: "mesh all of the solid with quadratic elements that have all their nodes",
    }
}
