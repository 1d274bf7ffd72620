//! Contact nodes: from a node set, from the tip along a shroud curve, or from the longest blade tip that is found on the skin.
//!
//! A tip is a smooth patch of the skin between flanks: it looks in the meridional plane, its edges are convex, and the faces beyond them
//! look around the wheel. Contact nodes are those nearest to the middle of its thickness.

use std::collections::{BTreeSet, HashMap, HashSet};

use nalgebra::Vector3;
use rubmap_mesh::MeshFile;
use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::mesh::SectorMesh;

use super::cyclic::Symmetry;
use super::edges::between;
use super::error::FromMeshError;
use super::midline::{along, midline};
use super::patches::{one_patch_at, patches};
use super::settings::MeshSettings;
use super::shroud;
use super::surface::{Face, SMOOTH, sides};
use super::way::Line;
use crate::package::calculix::nearest_neighbours;

/// Largest circumferential part of a tip's normal, by area.
const MERIDIONAL: f64 = 0.4;

/// Least circumferential part of a flank's normal.
const FLANK: f64 = 0.3;

/// Least share of a tip's outline with a convex edge to a flank.
const BETWEEN_FLANKS: f64 = 0.6;

/// Least share of a tip's outline with a convex edge. Strips along leading and trailing edges end at the hub, where the edge is hollow.
const CONVEX: f64 = 0.999;

/// Least length of another tip, in parts of the longest, for both to be alike.
const ALIKE: f64 = 0.98;

/// Largest number of nodes of a set that is a line.
const MOST_OF_A_LINE: usize = 5000;

/// Way in which the contact nodes were chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum TipSource {
    /// Line of nodes of this set.
    Line(String),
    /// Middle of the patch that this set covers.
    Area(String),
    /// Sharp edges between two nodes.
    Edge([u64; 2]),
    /// Middle of the patch that these nodes name.
    Patch(Vec<u64>),
    /// Middle of the tip along a shroud curve, and the least and largest distance of its nodes from the curve.
    Shroud([f64; 2]),
    /// Middle of the longest of the tips that were found, and their number.
    Found(usize),
}

/// Contact line with its source.
#[derive(Debug)]
pub(super) struct Tip {
    /// Nodes along the tip from the end at the smaller radius.
    pub(super) line: Line,
    pub(super) source: TipSource,
    /// Faces of the tip, as places in the surface; none for a line of nodes.
    pub(super) faces: Vec<usize>,
    /// Sentences that the user should know of.
    pub(super) notes: Vec<String>,
}

/// Contact line: between two nodes, along a named patch or a shroud curve, of a set, or along the longest tip.
pub(super) fn tip(
    file: &MeshFile,
    settings: &MeshSettings,
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
) -> Result<Tip, FromMeshError> {
    let of_line =
        |line, source| Tip { line: in_order(line, axis), source, faces: Vec::new(), notes: Vec::new() };
    if let Some(ends) = settings.contact_between {
        return Ok(of_line(between(mesh, surface, ends)?, TipSource::Edge(ends)));
    }
    if !settings.contact_at.is_empty() {
        let faces = one_patch_at(mesh, surface, symmetry, &settings.contact_at)?;
        return Ok(of_strip(mesh, surface, axis, faces, TipSource::Patch(settings.contact_at.clone())));
    }
    if let Some(curve) = &settings.shroud {
        let (faces, others) = shroud::strip(mesh, surface, symmetry, axis, curve)?;
        let mut found = of_strip(mesh, surface, axis, faces, TipSource::Shroud([0.0; 2]));
        found.source = TipSource::Shroud(shroud::distances(&found.line, axis, curve));
        if others > 0 {
            found.notes.push(format!(
                "{others} other tips lie as near to the shroud curve and are no longer; only the longest has contact nodes"
            ));
        }
        return Ok(found);
    }
    let Some(name) = &settings.contact_set else {
        let mut tips = tips(mesh, surface, symmetry, axis);
        tips.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (length, faces) = tips.first().cloned().ok_or(FromMeshError::NoTip)?;
        let mut found = of_strip(mesh, surface, axis, faces, TipSource::Found(tips.len()));
        let alike = tips.iter().skip(1).filter(|(other, _)| *other > ALIKE * length).count();
        if alike > 0 {
            found.notes.push(format!(
                "{alike} other tips are as long; only one of them has contact nodes. Does the sector have several equal blades?"
            ));
        }
        return Ok(found);
    };
    let nodes = super::sets::node_set(file, name)?;
    let chosen: HashSet<u32> = (0..)
        .zip(&mesh.node_ids)
        .filter(|(_, id)| nodes.binary_search(id).is_ok())
        .map(|(node, _)| node)
        .collect();
    let covered: Vec<usize> = (0..surface.len())
        .filter(|&k| surface[k].corners().iter().all(|node| chosen.contains(node)))
        .collect();
    if !covered.is_empty() {
        return Ok(of_strip(mesh, surface, axis, covered, TipSource::Area(name.clone())));
    }
    let places = (0..).zip(&mesh.node_ids).filter(|(node, _)| chosen.contains(node));
    let nodes: Line = places.map(|(node, &id)| (id, mesh.nodes[node as usize])).collect();
    if nodes.is_empty() {
        return Err(FromMeshError::SetElsewhere { name: name.clone() });
    }
    let line = chain(&nodes).ok_or_else(|| FromMeshError::NoLine { name: name.clone() })?;
    Ok(of_line(line, TipSource::Line(name.clone())))
}

/// Contact line along the middle of a strip of faces.
fn of_strip(
    mesh: &SectorMesh,
    surface: &[Face],
    axis: &AxisFrame,
    faces: Vec<usize>,
    source: TipSource,
) -> Tip {
    let (line, in_middle) = along(mesh, surface, &faces);
    let mut notes = Vec::new();
    if !in_middle {
        notes.push("the tip has no row of nodes in the middle of its thickness: contact nodes are those of the row nearest to it".to_owned());
    }
    Tip { line: in_order(line, axis), source, faces, notes }
}

/// Line from its end at the smaller radius, or at the smaller height where both ends have one radius.
fn in_order(mut line: Line, axis: &AxisFrame) -> Line {
    let place = |node: &(u64, [f64; 3])| axis.coordinates(node.1);
    if let (Some(first), Some(last)) = (line.first().map(place), line.last().map(place)) {
        let length = distance(first, last);
        let backwards =
            if (first[0] - last[0]).abs() > 1e-2 * length { first[0] > last[0] } else { first[2] > last[2] };
        if backwards {
            line.reverse();
        }
    }
    line
}

/// Nodes as a chain of nearest neighbours from one end to the other; none if they are no single line.
fn chain(nodes: &[(u64, [f64; 3])]) -> Option<Line> {
    if nodes.len() > MOST_OF_A_LINE {
        return None;
    }
    let farthest = |from: [f64; 3]| {
        let away = |node: &(u64, [f64; 3])| distance(node.1, from);
        nodes.iter().max_by(|a, b| away(a).total_cmp(&away(b)).then(b.0.cmp(&a.0))).copied()
    };
    let start = farthest(farthest(nodes.first()?.1)?.1)?;
    let end = farthest(start.1)?;
    let chain = nearest_neighbours(nodes, start);
    (chain.last().map(|node| node.0) == Some(end.0)).then_some(chain)
}

/// Tips on the skin: length of the middle line and faces of each.
fn tips(
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
) -> Vec<(f64, Vec<usize>)> {
    let free = || (0..surface.len()).filter(|k| !symmetry.faces.contains(k));
    let sides = sides(surface, free());
    let around: Vec<f64> = surface.iter().map(|face| face.cylindrical_normal(axis)[1].abs()).collect();
    let is_tip = |patch: &BTreeSet<usize>| {
        let area: f64 = patch.iter().map(|&k| surface[k].area).sum();
        let turned: f64 = patch.iter().map(|&k| surface[k].area * around[k]).sum();
        let [outline, convex, flanked] = outline(mesh, surface, &sides, patch, &around);
        turned <= MERIDIONAL * area && convex >= CONVEX * outline && flanked >= BETWEEN_FLANKS * outline
    };
    let patches = patches(surface, &sides, free(), SMOOTH);
    let faces = patches.into_iter().filter(is_tip).map(|patch| patch.into_iter().collect::<Vec<_>>());
    faces.map(|faces| (midline(mesh, surface, &faces).length(), faces)).collect()
}

/// Lengths of a patch's outline: in all, of convex edges, and of convex edges to a flank.
fn outline(
    mesh: &SectorMesh,
    surface: &[Face],
    sides: &HashMap<[u32; 2], Vec<usize>>,
    patch: &BTreeSet<usize>,
    around: &[f64],
) -> [f64; 3] {
    let at = |node: u32| Vector3::from(mesh.nodes[node as usize]);
    let mut lengths = [0.0; 3];
    for &face in patch {
        for [a, b] in surface[face].edges() {
            let beyond = sides.get(&[a.min(b), a.max(b)]).into_iter().flatten().find(|&&other| other != face);
            if beyond.is_some_and(|other| patch.contains(other)) {
                continue;
            }
            let length = (at(b) - at(a)).norm();
            lengths[0] += length;
            let Some(&other) = beyond else { continue };
            // Beyond a convex edge the neighbour lies below the face.
            if surface[face].normal.dot(&(surface[other].centre - at(a))) < 0.0 {
                lengths[1] += length;
                lengths[2] += if around[other] >= FLANK { length } else { 0.0 };
            }
        }
    }
    lengths
}
