//! The places of a mesh at which stress is claimed, and what their material bears.

use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::material::Material;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::stress::NodalStress;

/// A node of the sector with stress.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    /// Its id.
    pub(super) node: u64,
    /// Where it is.
    pub(super) position: [f64; 3],
    /// The element set around it whose strengths count.
    pub(super) set: usize,
    /// Distance from the nearest contact node, those of the neighbouring blades included.
    pub(super) from_contact: f64,
}

/// The places of `operator`, in its order; `contact` are the ids of contact nodes.
pub(super) fn places(mesh: &SectorMesh, operator: &NodalStress, contact: &[u64]) -> Vec<Place> {
    let mut set_of = vec![None; mesh.nodes.len()];
    for element in &mesh.elements {
        let set = element.set as usize;
        for &node in &element.nodes {
            let weaker = |known: usize| {
                let strength = |set: usize| borne(&mesh.sets[set].material);
                if strength(set) < strength(known) { set } else { known }
            };
            let known = &mut set_of[node as usize];
            *known = Some(known.map_or(set, weaker));
        }
    }
    for &(low, high) in &mesh.cyclic {
        set_of[low as usize] = set_of[low as usize].or(set_of[high as usize]);
    }
    let angle = std::f64::consts::TAU / mesh.sectors as f64;
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1);
    let own: Vec<[f64; 3]> = (mesh.node_ids.iter().zip(&mesh.nodes))
        .filter(|(id, _)| contact.contains(id))
        .map(|(_, &position)| position)
        .collect();
    let turned = |&at: &[f64; 3]| {
        [-angle, 0.0, angle].map(|angle| frame.as_ref().map_or(at, |frame| frame.turn_point(at, angle)))
    };
    let contact: Vec<[f64; 3]> = own.iter().flat_map(turned).collect();
    let place = |&node: &u32| {
        let position = mesh.nodes[node as usize];
        Place {
            node: mesh.node_ids[node as usize],
            position,
            set: set_of[node as usize].unwrap_or(0),
            from_contact: contact.iter().map(|&at| distance(at, position)).fold(f64::INFINITY, f64::min),
        }
    };
    operator.places().iter().map(place).collect()
}

/// What orders materials by weakness: those without a fatigue strength come last.
fn borne(material: &Material) -> f64 {
    material.fatigue_strength.as_ref().map_or(f64::INFINITY, |strength| strength.amplitude)
}
