//! Clamped nodes: of a set, of patches, as the file holds them, or the bore.

use rubmap_mesh::MeshFile;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;

use super::cyclic::Symmetry;
use super::error::FromMeshError;
use super::patches::patches_at;
use super::settings::MeshSettings;
use super::surface::Face;

/// Largest difference of radii on the bore, in parts of its radius.
const SAME_RADIUS: f64 = 1e-3;

/// Least radius of a bore, in parts of the wheel's.
const LEAST_BORE: f64 = 1e-3;

/// Way in which the clamp was chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum ClampSource {
    /// Node set of the settings.
    Set(String),
    /// Nodes that the file holds.
    File,
    /// Surface of the bore, with its radius.
    Bore(f64),
    /// Patches that these nodes name.
    Patches(Vec<u64>),
}

/// Whether each node is clamped, and why.
pub(super) fn clamped(
    file: &MeshFile,
    settings: &MeshSettings,
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
) -> Result<(Vec<bool>, ClampSource), FromMeshError> {
    let (mut clamped, source) = if let Some(name) = &settings.clamp_set {
        let nodes = super::sets::node_set(file, name)?;
        (marked(mesh, |id| nodes.binary_search(&id).is_ok()), ClampSource::Set(name.clone()))
    } else if !settings.clamp_at.is_empty() {
        let named = patches_at(mesh, surface, symmetry, "clamp_at", &settings.clamp_at)?;
        (
            of_faces(mesh, surface, named.into_iter().flatten()),
            ClampSource::Patches(settings.clamp_at.clone()),
        )
    } else if !file.held.is_empty() {
        (marked(mesh, |id| file.held.contains(&id)), ClampSource::File)
    } else {
        bore(mesh, surface, symmetry, axis)?
    };
    if !clamped.contains(&true) {
        return Err(FromMeshError::NothingClamped);
    }
    if let Some(element) = held_by_corners(mesh, surface, &clamped) {
        return Err(FromMeshError::ClampOfCorners { element });
    }
    // A support on one face holds the same node of the next sector.
    for &(low, high) in &symmetry.pairs {
        let either = clamped[low as usize] || clamped[high as usize];
        (clamped[low as usize], clamped[high as usize]) = (either, either);
    }
    Ok((clamped, source))
}

fn marked(mesh: &SectorMesh, is: impl Fn(u64) -> bool) -> Vec<bool> {
    mesh.node_ids.iter().map(|&id| is(id)).collect()
}

/// Whether each node belongs to one of these faces of the skin.
fn of_faces(mesh: &SectorMesh, surface: &[Face], faces: impl Iterator<Item = usize>) -> Vec<bool> {
    let mut marked = vec![false; mesh.nodes.len()];
    faces.flat_map(|face| &surface[face].skin.nodes).for_each(|&node| marked[node as usize] = true);
    marked
}

/// Number of an element with a face whose corners are clamped and whose other nodes are all free, as in sets of corner nodes.
fn held_by_corners(mesh: &SectorMesh, surface: &[Face], clamped: &[bool]) -> Option<u64> {
    let held = |node: &u32| clamped[*node as usize];
    let by_corners = |face: &&Face| {
        let (corners, others) = face.skin.nodes.split_at(face.skin.corners);
        !others.is_empty() && corners.iter().all(held) && !others.iter().any(held)
    };
    surface.iter().find(by_corners).map(|face| mesh.elements[face.skin.element as usize].id)
}

/// Nodes of the faces at the smallest radius.
fn bore(
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
) -> Result<(Vec<bool>, ClampSource), FromMeshError> {
    let radius: Vec<f64> = mesh.nodes.iter().map(|&at| axis.coordinates(at)[0]).collect();
    // Nodes in the middle of straight edges lie inside of the bore's circle.
    let corners = surface.iter().flat_map(Face::corners).map(|&node| radius[node as usize]);
    let (least, most) =
        corners.fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(r), most.max(r)));
    if least < LEAST_BORE * most {
        return Err(FromMeshError::NoBore);
    }
    let at_bore = |node: &u32| radius[*node as usize] <= least * (1.0 + SAME_RADIUS);
    let on_bore = |&k: &usize| !symmetry.faces.contains(&k) && surface[k].corners().iter().all(at_bore);
    let clamped = of_faces(mesh, surface, (0..surface.len()).filter(on_bore));
    if clamped.contains(&true) { Ok((clamped, ClampSource::Bore(least))) } else { Err(FromMeshError::NoBore) }
}
