//! Places of a mesh with valid stress, and the strength of their material.

use std::collections::BTreeSet;

use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::material::Material;
use rubmap_solid::mesh::{ElementSet, SectorMesh};
use rubmap_solid::stress::NodalStress;

/// Node of the sector with stress.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    /// Id of the node.
    pub(super) node: u64,
    /// Position of the node.
    pub(super) position: [f64; 3],
    /// Element sets around the node, ascending.
    pub(super) sets: Vec<usize>,
    /// Distance from the nearest contact node, those of the neighbouring blades included.
    pub(super) from_contact: f64,
}

/// Places of `operator`, in its order; `contact` are the ids of contact nodes.
pub(super) fn places(mesh: &SectorMesh, operator: &NodalStress, contact: &[u64]) -> Vec<Place> {
    let mut sets = vec![BTreeSet::new(); mesh.nodes.len()];
    for element in &mesh.elements {
        for &node in &element.nodes {
            sets[node as usize].insert(element.set as usize);
        }
    }
    for &(low, high) in &mesh.cyclic {
        let across = std::mem::take(&mut sets[high as usize]);
        sets[low as usize].extend(across);
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
            sets: sets[node as usize].iter().copied().collect(),
            from_contact: contact.iter().map(|&at| distance(at, position)).fold(f64::INFINITY, f64::min),
        }
    };
    operator.places().iter().map(place).collect()
}

impl Place {
    /// Weakest in fatigue of the element sets around the node.
    pub(super) fn weakest(&self, sets: &[ElementSet]) -> usize {
        let borne = |set: &usize| borne(&sets[*set].material);
        self.sets.iter().copied().min_by(|a, b| borne(a).total_cmp(&borne(b))).unwrap_or(0)
    }

    /// Least yield strength of the element sets around the node.
    pub(super) fn yield_strength(&self, sets: &[ElementSet]) -> Option<f64> {
        self.sets.iter().filter_map(|&set| sets[set].material.yield_strength).min_by(f64::total_cmp)
    }
}

/// Fatigue strength by which materials are ordered from the weakest; infinite without one, so that those come last.
fn borne(material: &Material) -> f64 {
    material.fatigue_strength.as_ref().map_or(f64::INFINITY, |strength| strength.amplitude)
}
