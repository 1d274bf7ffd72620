//! Skin of a sector: faces of elements that no other element shares.

use std::collections::HashMap;

use crate::mesh::SectorMesh;
use crate::topology::Topology;

/// Face of the skin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkinFace {
    /// Index of the face's element in [`SectorMesh::elements`].
    pub element: u32,
    /// Indices of the face's nodes in [`SectorMesh::nodes`]: its three or four corners, counter-clockwise seen from outside; of a quadratic
    /// element then the middle of the edge behind each corner.
    pub nodes: Vec<u32>,
    /// Number of the face's corners.
    pub corners: usize,
    /// Cut that the face lies on, if any: there the wheel goes on.
    pub cut: Option<Cut>,
}

/// Cyclic face of the sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cut {
    /// Low face, where the sector begins.
    Low,
    /// High face, where the next sector begins.
    High,
}

/// Skin of a sector: all faces that belong to one element only.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skin {
    /// Faces, in the order of elements and their faces.
    pub faces: Vec<SkinFace>,
}

impl Skin {
    /// Faces of the whole wheel's skin: those on no cut.
    pub fn free(&self) -> impl Iterator<Item = &SkinFace> {
        self.faces.iter().filter(|face| face.cut.is_none())
    }
}

/// Skin of a mesh.
pub fn skin(mesh: &SectorMesh) -> Skin {
    // Nodes on the axis are on both cuts.
    let mut low = mesh.on_axis();
    let mut high = low.clone();
    for &(from, to) in &mesh.cyclic {
        (low[from as usize], high[to as usize]) = (true, true);
    }
    let mut found: Vec<SkinFace> = Vec::new();
    let mut shared: HashMap<Vec<u32>, (usize, u32)> = HashMap::new();
    for (e, element) in mesh.elements.iter().enumerate() {
        let topology = Topology::of(element.kind);
        for (face, corners) in topology.faces.iter().enumerate() {
            let mut key: Vec<u32> = corners.iter().map(|&corner| element.nodes[corner]).collect();
            let cut = if key.iter().all(|&node| low[node as usize]) {
                Some(Cut::Low)
            } else if key.iter().all(|&node| high[node as usize]) {
                Some(Cut::High)
            } else {
                None
            };
            key.sort_unstable();
            shared.entry(key).or_insert((found.len(), 0)).1 += 1;
            let nodes = topology.face_nodes(face).into_iter().map(|local| element.nodes[local]).collect();
            found.push(SkinFace { element: e as u32, nodes, corners: corners.len(), cut });
        }
    }
    let mut once = vec![false; found.len()];
    shared.values().filter(|(_, uses)| *uses == 1).for_each(|&(face, _)| once[face] = true);
    let faces = found.into_iter().zip(once).filter(|(_, once)| *once).map(|(face, _)| face).collect();
    Skin { faces }
}
