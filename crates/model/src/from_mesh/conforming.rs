//! Check that elements share whole faces: neither nodes in the middle of edges nor parts of faces hang.

use std::collections::HashMap;

use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::topology::Topology;

use super::error::FromMeshError;
use super::opposite::Opposite;
use super::surface::Face;

/// Largest gap between faces that were meant to be one, in parts of a face's size.
const GAP: f64 = 2e-3;

/// Largest gap between faces that look at each other for it to be reported, in parts of a face's size.
const NARROW: f64 = 0.1;

/// Refuses elements that share the corners of a face but not the nodes on its edges, and faces that lie on each other with other nodes;
/// returns a note on narrow gaps between faces, if there are any.
pub(super) fn check(mesh: &SectorMesh, surface: &[Face]) -> Result<Option<String>, FromMeshError> {
    let mut shared: HashMap<Vec<u32>, (u64, Vec<u32>)> = HashMap::new();
    for element in &mesh.elements {
        let topology = Topology::of(element.kind);
        for face in 0..topology.faces.len() {
            let corners = topology.faces[face].len();
            let nodes: Vec<u32> =
                topology.face_nodes(face).iter().map(|&local| element.nodes[local]).collect();
            let sorted = |part: &[u32]| {
                let mut part = part.to_vec();
                part.sort_unstable();
                part
            };
            let (key, middles) = (sorted(&nodes[..corners]), sorted(&nodes[corners..]));
            match shared.get(&key) {
                Some((other, known)) if *known != middles => {
                    return Err(FromMeshError::EdgesDiffer { elements: [*other, element.id] });
                }
                Some(_) => {}
                None => drop(shared.insert(key, (element.id, middles))),
            }
        }
    }
    let opposite = Opposite::new(mesh, surface.iter().collect());
    let elements =
        |one: &Face, other: &Face| [one, other].map(|face| mesh.elements[face.skin.element as usize].id);
    let mut narrowest: Option<(f64, [u64; 2])> = None;
    let mut count = 0;
    for face in surface {
        if let Some(other) = opposite.at(face.centre, face.normal, GAP) {
            return Err(FromMeshError::FacesMeet { elements: elements(face, other) });
        }
        if let Some((other, gap)) = opposite.before(face.centre, face.normal, NARROW) {
            count += 1;
            if narrowest.is_none_or(|(least, _)| gap < least) {
                narrowest = Some((gap, elements(face, other)));
            }
        }
    }
    Ok(narrowest.map(|(gap, [one, other])| {
        format!(
            "parts nearly touch: {count} faces look at others less than a tenth of their size away, nearest those of elements {one} and {other}, \
             {gap:.3e} apart; nothing joins them there. Merge their nodes with a larger tolerance if they are one part"
        )
    }))
}
