//! Mesh of a deck as the element table of a package.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use rubmap_solid::material::Material;

use super::no_mesh::NoMesh;
use super::solids::{DeckElement, Solids};
use super::strengths::Strengths;
use crate::package::raw::{ManifestMesh, RawElement};

/// Mesh of one sector as a package holds it.
pub(super) struct SectorTable {
    /// Entry of the manifest, with the materials of the element sets.
    pub(super) manifest: ManifestMesh,
    pub(super) elements: Vec<RawElement>,
}

/// Element table of all elements that `keep` accepts, and their materials by the element sets of their sections.
pub(super) fn table(
    solids: &Solids,
    strengths: &Strengths,
    keep: impl Fn(u64, &DeckElement) -> Result<bool, NoMesh>,
) -> Result<SectorTable, NoMesh> {
    if let Some(unusable) = &solids.unusable {
        return Err(unusable.clone());
    }
    if solids.elements.is_empty() {
        return Err(NoMesh::NoElements);
    }
    // If an element has two sections, the later one holds.
    let mut section_of: HashMap<u64, (&str, &str)> = HashMap::new();
    for (set, material) in &solids.sections {
        let members = solids.sets.get(set).into_iter().flatten();
        section_of.extend(members.map(|&element| (element, (set.as_str(), material.as_str()))));
    }
    let mut sets: BTreeMap<&str, (Arc<str>, Material)> = BTreeMap::new();
    let mut elements = Vec::new();
    for (&id, element) in &solids.elements {
        if !keep(id, element)? {
            continue;
        }
        let &(set, material) = section_of.get(&id).ok_or(NoMesh::NoSection { element: id })?;
        if !sets.contains_key(set) {
            let mut constants = constants(solids, material)?;
            strengths.give(set, material, &mut constants);
            sets.insert(set, (set.into(), constants));
        }
        let set = Arc::clone(&sets[set].0);
        elements.push(RawElement { id, kind: element.kind, set, nodes: element.nodes.clone() });
    }
    let sets = sets.into_iter().map(|(name, (_, material))| (name.to_owned(), material)).collect();
    Ok(SectorTable { manifest: ManifestMesh { elements: "elements.csv".to_owned(), sets }, elements })
}

fn constants(solids: &Solids, name: &str) -> Result<Material, NoMesh> {
    let material = || name.to_owned();
    let Some(found) = solids.materials.get(name) else {
        return Err(NoMesh::NoMaterial { material: material() });
    };
    if let Some(kind) = &found.anisotropic {
        return Err(NoMesh::Anisotropic { material: material(), kind: kind.clone() });
    }
    match (&found.elastic[..], &found.density[..]) {
        (&[[youngs_modulus, poissons_ratio]], &[density]) => Ok(Material {
            youngs_modulus,
            poissons_ratio,
            density,
            yield_strength: None,
            ultimate_strength: None,
            fatigue_strength: None,
        }),
        ([], _) => Err(NoMesh::Lacking { material: material(), card: "*ELASTIC" }),
        (_, []) => Err(NoMesh::Lacking { material: material(), card: "*DENSITY" }),
        _ => Err(NoMesh::Temperature { material: material() }),
    }
}
