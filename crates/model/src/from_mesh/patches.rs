//! Smooth patches of the skin, which sharp edges bound, and their choice by nodes.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use rubmap_solid::mesh::SectorMesh;

use super::cyclic::Symmetry;
use super::error::FromMeshError;
use super::surface::{Face, SMOOTH, sides};

/// Smooth patches of the faces on no cut, as places in the surface.
pub(super) fn free_patches(surface: &[Face], symmetry: &Symmetry) -> Vec<BTreeSet<usize>> {
    let free = || (0..surface.len()).filter(|k| !symmetry.faces.contains(k));
    patches(surface, &sides(surface, free()), free(), SMOOTH)
}

/// Free patches that nodes name: those with a named node that no other free patch has, or with a face whose corners are all named.
pub(super) fn patches_at(
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    setting: &'static str,
    nodes: &[u64],
) -> Result<Vec<BTreeSet<usize>>, FromMeshError> {
    let patches = free_patches(surface, symmetry);
    let mut around: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    let mut named = BTreeSet::new();
    for &id in nodes {
        let node =
            mesh.node_ids.binary_search(&id).map_err(|_| FromMeshError::OffSkin { node: id, setting })?;
        named.insert(node as u32);
    }
    // Corners of faces that are named as a whole.
    let mut covered: BTreeSet<u32> = BTreeSet::new();
    let mut chosen = BTreeSet::new();
    for (place, patch) in patches.iter().enumerate() {
        for face in patch.iter().map(|&k| &surface[k]) {
            for &node in face.skin.nodes.iter().filter(|node| named.contains(node)) {
                around.entry(node).or_default().insert(place);
            }
            if face.corners().iter().all(|node| named.contains(node)) {
                covered.extend(face.corners());
                chosen.insert(place);
            }
        }
    }
    for node in named {
        let id = mesh.node_ids[node as usize];
        match around.get(&node).map(|patches| (patches.len(), patches)) {
            None => return Err(FromMeshError::OffSkin { node: id, setting }),
            Some((1, patches)) => chosen.extend(patches),
            Some(_) if covered.contains(&node) => {}
            Some((patches, _)) => return Err(FromMeshError::OnEdge { node: id, setting, patches }),
        }
    }
    Ok(chosen.into_iter().map(|place| patches[place].clone()).collect())
}

/// Faces of the one patch that the nodes of `contact_at` name.
pub(super) fn one_patch_at(
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    nodes: &[u64],
) -> Result<Vec<usize>, FromMeshError> {
    let mut named = patches_at(mesh, surface, symmetry, "contact_at", nodes)?;
    match (named.pop(), named.len()) {
        (Some(patch), 0) => Ok(patch.into_iter().collect()),
        (_, others) => Err(FromMeshError::TwoTips { patches: others + 1 }),
    }
}

/// Patches of some faces, in which normals of neighbours have more than this cosine between them.
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
