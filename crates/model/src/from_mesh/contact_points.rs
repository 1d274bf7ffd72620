//! Contact nodes of a tip, with their normals.

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;
use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::place::{on_axis, tolerance};

use super::cyclic::Symmetry;
use super::error::FromMeshError;
use super::settings::MeshSettings;
use super::surface::Face;
use super::tip::Tip;
use crate::assembly::TipNode;
use crate::package::calculix::{ContactPoint, Normals, spread, with_normals};

/// Least number of contact nodes: normals are those of a curve through them.
pub(super) const LEAST: usize = 3;

/// Least cosine of the angle between the normals of contact line and skin (60°).
const LEAST_COSINE: f64 = 0.5;

/// Contact nodes with their normals.
#[derive(Debug)]
pub(super) struct Contact {
    pub(super) points: Vec<ContactPoint>,
    /// Number of usable nodes along the line.
    pub(super) of_line: usize,
    /// Least and largest distance between neighbours.
    pub(super) spacing: [f64; 2],
}

impl Contact {
    pub(super) fn tips(&self, mesh: &SectorMesh) -> Vec<TipNode> {
        let tip = |point: &ContactPoint| {
            let node = mesh.node_ids.binary_search(&point.node).ok()?;
            Some(TipNode { node, normal: point.normal })
        };
        self.points.iter().filter_map(tip).collect()
    }
}

/// Contact nodes of a tip: free ones off the cyclic faces and the axis, evenly spaced, with normals that the skin confirms.
pub(super) fn contact_line(
    settings: &MeshSettings,
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
    clamped: &[bool],
    tip: &Tip,
) -> Result<Contact, FromMeshError> {
    let on_faces: HashSet<u32> = symmetry.pairs.iter().flat_map(|&(low, high)| [low, high]).collect();
    let within = tolerance(mesh.nodes.iter().copied());
    let usable = |(id, at): &&(u64, [f64; 3])| {
        let node = mesh.node_ids.binary_search(id).ok();
        let is_free = |node: usize| !clamped[node] && !on_faces.contains(&(node as u32));
        node.is_some_and(is_free) && !on_axis(*at, axis, symmetry.sectors, within)
    };
    let line: Vec<_> = tip.line.iter().filter(usable).copied().collect();
    if line.len() < LEAST {
        return Err(FromMeshError::FewNodes { found: line.len() });
    }
    let normals = |nodes: &[(u64, [f64; 3])]| {
        let points = with_normals(nodes, &Normals::ContactNodes, axis, &mesh.nodes)
            .map_err(|error| FromMeshError::Normals(error.to_string()))?;
        match points.iter().find(|point| point.normal.iter().any(|x| !x.is_finite())) {
            Some(point) => Err(FromMeshError::NoMeridian { node: point.node }),
            None => Ok(points),
        }
    };
    // The whole line is looked at: few nodes of a crooked one may look straight.
    check_normals(mesh, surface, axis, tip, &normals(&line)?)?;
    let of_line = line.len();
    let chosen = spread(line, settings.contact_nodes);
    let spacing = chosen.windows(2).map(|pair| distance(pair[0].1, pair[1].1));
    let spacing = spacing.fold([f64::INFINITY, 0.0_f64], |[low, high], x| [low.min(x), high.max(x)]);
    Ok(Contact { points: normals(&chosen)?, of_line, spacing })
}

/// Refuses a line along a strip of the skin whose normals are far from those of the skin.
fn check_normals(
    mesh: &SectorMesh,
    surface: &[Face],
    axis: &AxisFrame,
    tip: &Tip,
    points: &[ContactPoint],
) -> Result<(), FromMeshError> {
    let mut skin: HashMap<u64, Vector3<f64>> = HashMap::new();
    for &k in &tip.faces {
        let face = &surface[k];
        for &node in &face.skin.nodes {
            *skin.entry(mesh.node_ids[node as usize]).or_default() += face.normal * face.area;
        }
    }
    for point in points {
        let Some(sum) = skin.get(&point.node) else { continue };
        let normal = axis.cylindrical(point.position[1]).tr_mul(&Vector3::from(point.normal));
        let cosine = normal.dot(&sum.normalize());
        if cosine.is_nan() || cosine <= LEAST_COSINE {
            let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
            return Err(FromMeshError::NormalOff { node: point.node, degrees });
        }
    }
    Ok(())
}
