//! Skin of a body with what is needed to recognise its parts: place, area and outward normal of every face.

use std::collections::{BTreeSet, HashMap, HashSet};

use nalgebra::Vector3;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::skin::{SkinFace, skin};

/// Cosine of the largest angle between neighbouring faces of one smooth patch (35°).
pub(super) const SMOOTH: f64 = 0.82;

/// Face of the skin.
#[derive(Debug, Clone)]
pub(super) struct Face {
    pub(super) skin: SkinFace,
    /// Mean of the corners.
    pub(super) centre: Vector3<f64>,
    /// Outward unit normal.
    pub(super) normal: Vector3<f64>,
    pub(super) area: f64,
}

impl Face {
    /// Corners, counter-clockwise seen from outside.
    pub(super) fn corners(&self) -> &[u32] {
        &self.skin.nodes[..self.skin.corners]
    }

    /// Edges as pairs of corners, each from the first to the second as one walks around the face.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let corners = self.corners();
        (0..corners.len()).map(move |k| [corners[k], corners[(k + 1) % corners.len()]])
    }

    /// Steps from node to node around the face, over the nodes in the middle of edges.
    pub(super) fn steps(&self) -> Vec<[u32; 2]> {
        let middles = &self.skin.nodes[self.skin.corners..];
        let step = |(k, [a, b]): (usize, [u32; 2])| match middles.get(k) {
            Some(&middle) => vec![[a, middle], [middle, b]],
            None => vec![[a, b]],
        };
        self.edges().enumerate().flat_map(step).collect()
    }

    /// Outward unit normal in (r, θ, z) components.
    pub(super) fn cylindrical_normal(&self, axis: &AxisFrame) -> Vector3<f64> {
        let [_, theta, _] = axis.coordinates(self.centre.into());
        axis.cylindrical(theta) * self.normal
    }
}

/// Faces of a body's skin.
pub(super) fn surface(mesh: &SectorMesh) -> Vec<Face> {
    let at = |node: u32| Vector3::from(mesh.nodes[node as usize]);
    let face = |skin: SkinFace| {
        let corners: Vec<Vector3<f64>> = skin.nodes[..skin.corners].iter().map(|&node| at(node)).collect();
        let centre = corners.iter().sum::<Vector3<f64>>() / corners.len() as f64;
        let around = (0..corners.len())
            .map(|k| (corners[k] - centre).cross(&(corners[(k + 1) % corners.len()] - centre)));
        let twice: Vector3<f64> = around.sum();
        let normal = twice.try_normalize(0.0).unwrap_or_default();
        Face { skin, centre, normal, area: 0.5 * twice.norm() }
    };
    skin(mesh).faces.into_iter().map(face).collect()
}

/// Faces on both sides of every edge of some faces, as places in `faces`; an edge at the boundary has one.
pub(super) fn sides<'a>(
    faces: &'a [Face],
    chosen: impl Iterator<Item = usize> + 'a,
) -> HashMap<[u32; 2], Vec<usize>> {
    let mut sides: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for face in chosen {
        for [a, b] in faces[face].edges() {
            sides.entry([a.min(b), a.max(b)]).or_default().push(face);
        }
    }
    sides
}

/// Patches of some faces, in which normals of neighbours have at least this cosine between them.
pub(super) fn patches(
    surface: &[Face],
    sides: &HashMap<[u32; 2], Vec<usize>>,
    free: impl Iterator<Item = usize>,
    least_cosine: f64,
) -> Vec<BTreeSet<usize>> {
    let mut seen = HashSet::new();
    let mut patches = Vec::new();
    for first in free {
        if !seen.insert(first) {
            continue;
        }
        let mut patch = BTreeSet::from([first]);
        let mut open = vec![first];
        while let Some(face) = open.pop() {
            for [a, b] in surface[face].edges() {
                for &other in sides.get(&[a.min(b), a.max(b)]).into_iter().flatten() {
                    if surface[face].normal.dot(&surface[other].normal) > least_cosine && seen.insert(other) {
                        patch.insert(other);
                        open.push(other);
                    }
                }
            }
        }
        patches.push(patch);
    }
    patches
}
