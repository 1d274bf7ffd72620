//! Patches of the skin as they are listed and drawn.

use std::collections::{BTreeSet, HashMap, HashSet};

use nalgebra::Vector3;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use serde::Serialize;

use super::cyclic::Symmetry;
use super::patches::patches;
use super::surface::{Face, SMOOTH, sides};

/// Role of a patch in the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum MeshRole {
    /// Cyclic face where the sector begins.
    Low,
    /// Cyclic face where the next sector begins.
    High,
    /// Clamped face.
    Clamp,
    /// Tip of the blade that may touch the casing.
    Contact,
}

/// Smooth patch of the skin.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeshPatch {
    /// Role in the model, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub role: Option<MeshRole>,
    /// Numbers of the nodes that name the patch in `clamp_at` and `contact_at`: one node away from its edges, or the corners of one face where
    /// there is none. Patches of cyclic faces have no name.
    pub at: Vec<u64>,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Area of the patch, its faces taken as flat.
    pub area: f64,
    /// Centre of the area.
    pub centre: [f64; 3],
    /// Mean distance from the axis of rotation, by area, if the axis was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Mean position along the axis of rotation, by area, if the axis was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axial: Option<f64>,
}

/// Skin of a mesh.
pub(super) struct Parts<'a> {
    pub(super) mesh: &'a SectorMesh,
    pub(super) surface: &'a [Face],
    /// Places of the nodes of the mesh among those of the skin.
    pub(super) place: &'a HashMap<u32, u32>,
}

impl Parts<'_> {
    /// Patches with the roles of cyclic faces, and their faces: free ones by area, then those of the low and the high face.
    pub(super) fn patches(&self, symmetry: Option<&Symmetry>) -> (Vec<MeshPatch>, Vec<BTreeSet<usize>>) {
        let low: HashSet<u32> = symmetry.iter().flat_map(|found| &found.pairs).map(|pair| pair.0).collect();
        let role = |face: usize| {
            let cyclic = symmetry.is_some_and(|symmetry| symmetry.faces.contains(&face));
            let is_low = || self.surface[face].corners().iter().any(|node| low.contains(node));
            cyclic.then(|| if is_low() { MeshRole::Low } else { MeshRole::High })
        };
        let of_role = |wanted: Option<MeshRole>| {
            let chosen = || (0..self.surface.len()).filter(|&face| role(face) == wanted);
            patches(self.surface, &sides(self.surface, chosen()), chosen(), SMOOTH)
        };
        let mut free = of_role(None);
        free.sort_by(|a, b| self.area(b).total_cmp(&self.area(a)).then(a.first().cmp(&b.first())));
        let cuts = [MeshRole::Low, MeshRole::High].map(|cut| (Some(cut), of_role(Some(cut))));
        let mut on: HashMap<u32, usize> = HashMap::new();
        let all = free.iter().chain(cuts.iter().flat_map(|(_, patches)| patches));
        all.flat_map(|patch| self.nodes(patch)).for_each(|node| *on.entry(node).or_default() += 1);
        let axis = symmetry.and_then(|found| AxisFrame::new(found.axis.origin, found.axis.direction));
        let mut listed = Vec::new();
        let mut faces = Vec::new();
        for (role, patches) in std::iter::once((None, free)).chain(cuts) {
            for patch in patches {
                let at = if role.is_none() { self.name(&patch, &on) } else { Vec::new() };
                listed.push(self.described(&patch, role, at, axis.as_ref()));
                faces.push(patch);
            }
        }
        (listed, faces)
    }

    fn described(
        &self,
        patch: &BTreeSet<usize>,
        role: Option<MeshRole>,
        at: Vec<u64>,
        axis: Option<&AxisFrame>,
    ) -> MeshPatch {
        let area = self.area(patch);
        let mean = |value: &dyn Fn(&Face) -> f64| {
            patch.iter().map(|&face| value(&self.surface[face]) * self.surface[face].area).sum::<f64>()
                / area.max(f64::MIN_POSITIVE)
        };
        let about = |k: usize| axis.map(|axis| mean(&|face| axis.coordinates(face.centre.into())[k]));
        MeshPatch {
            role,
            at,
            nodes: self.nodes(patch).len(),
            triangles: patch.iter().map(|&face| self.surface[face].steps().len() - 2).sum(),
            area,
            centre: std::array::from_fn(|k| mean(&|face| face.centre[k])),
            radius: about(0),
            axial: about(2),
        }
    }

    fn area(&self, patch: &BTreeSet<usize>) -> f64 {
        patch.iter().map(|&face| self.surface[face].area).sum()
    }

    fn nodes(&self, patch: &BTreeSet<usize>) -> BTreeSet<u32> {
        patch.iter().flat_map(|&face| self.surface[face].skin.nodes.iter().copied()).collect()
    }

    /// Node of a patch that no other patch has, the one nearest to its centre; the corners of the face nearest to it where there is none.
    fn name(&self, patch: &BTreeSet<usize>, on: &HashMap<u32, usize>) -> Vec<u64> {
        let sum: Vector3<f64> = patch.iter().map(|&k| self.surface[k].centre * self.surface[k].area).sum();
        let centre = sum / self.area(patch).max(f64::MIN_POSITIVE);
        let away = |node: &u32| (Vector3::from(self.mesh.nodes[*node as usize]) - centre).norm();
        let inner = self.nodes(patch).into_iter().filter(|node| on.get(node) == Some(&1));
        let id = |node: u32| self.mesh.node_ids[node as usize];
        if let Some(node) = inner.min_by(|a, b| away(a).total_cmp(&away(b))) {
            return vec![id(node)];
        }
        let off = |face: &&Face| (face.centre - centre).norm();
        let faces = patch.iter().map(|&face| &self.surface[face]);
        let nearest = faces.min_by(|a, b| off(a).total_cmp(&off(b)));
        let mut corners: Vec<u64> =
            nearest.into_iter().flat_map(Face::corners).map(|&node| id(node)).collect();
        corners.sort_unstable();
        corners
    }

    /// Triangles of a face, over the nodes in the middle of its edges, as places among the nodes of the skin.
    pub(super) fn triangles(&self, face: usize) -> Vec<u32> {
        let around: Vec<u32> = self.surface[face].steps().iter().map(|step| self.place[&step[0]]).collect();
        // A fan from a node in the middle of an edge, where there is one: from a corner a triangle would be flat.
        let quadratic = around.len() > self.surface[face].skin.corners;
        let count = around.len();
        let start = usize::from(quadratic);
        (1..count - 1)
            .flat_map(|k| [around[start], around[(start + k) % count], around[(start + k + 1) % count]])
            .collect()
    }
}
