//! Conversion of a meshed sector into the content of a model package (docs/package.md).

use std::sync::Arc;

use super::gyroscopic::gyroscopic_matrix;
use super::matrices::SectorMatrices;
use super::prestress::CanMove;
use super::sector::MeshedSector;
use crate::package::raw::{
    Axis, Frame, Manifest, ManifestContact, ManifestMesh, RawDof, RawElement, RawMatrix, RawNode, RawPackage,
};
use rubmap_wheel::dynamics::sector::Units;

/// Facts of a package that its mesh does not say.
#[derive(Debug, Clone, PartialEq)]
pub struct PackageFacts {
    /// Name of the model.
    pub name: String,
    /// Consistent units.
    pub units: Units,
    /// Highest speed Ω1 of the stiffness matrices (rad/s), positive.
    pub top_speed_rad_s: f64,
    /// Whether the package has the gyroscopic matrix that Coriolis forces need.
    pub gyroscopic: bool,
}

/// Assembles the sector and packs it: cylindrical frame, unassembled high face, K at rest, Ω1/2 and Ω1.
///
/// # Errors
/// [`CanMove`] for a sector that nothing clamps.
pub fn to_package(facts: &PackageFacts, sector: &MeshedSector) -> Result<RawPackage, CanMove> {
    let matrices = SectorMatrices::assemble(sector)?;
    let speeds_rad_s = [0.0, 0.5 * facts.top_speed_rad_s, facts.top_speed_rad_s];
    let mut package = without_matrices(facts, sector);
    let id = |node: usize| sector.mesh.node_ids[node];
    let dofs = &matrices.rest.dofs.list;
    package.dofs = dofs.iter().map(|&(n, c)| RawDof { node: id(n), component: c as u8 + 1 }).collect();
    package.stiffness = speeds_rad_s.iter().map(|&speed| matrices.stiffness(speed)).collect();
    package.mass = without_zeros(matrices.rest.mass());
    package.gyroscopic = facts.gyroscopic.then(|| gyroscopic_matrix(sector));
    package.manifest.speeds_rad_s = speeds_rad_s.to_vec();
    package.manifest.stiffness = (0..3).map(|s| format!("k{s}.npz")).collect();
    Ok(package)
}

/// Package of a sector with all but its rows and matrices.
pub(crate) fn without_matrices(facts: &PackageFacts, sector: &MeshedSector) -> RawPackage {
    let mesh = &sector.mesh;
    let id = |node: usize| mesh.node_ids[node];
    let pairs = mesh.cyclic.iter().map(|&(low, high)| [low as usize, high as usize]);
    let free = |[low, _]: &[usize; 2]| sector.clamped[*low] != [true; 3];
    let contact = sector.contact.iter().map(|tip| ManifestContact { node: id(tip.node), normal: tip.normal });
    let (origin, direction) = mesh.axis;
    let sets = mesh.sets.iter().map(|set| (set.name.clone(), set.material.clone())).collect();
    let manifest = Manifest {
        name: facts.name.clone(),
        sectors: mesh.sectors,
        units: facts.units.clone(),
        axis: Axis { origin, direction },
        speeds_rad_s: Vec::new(),
        frame: Frame::Cylindrical,
        mass: "m.npz".to_owned(),
        stiffness: Vec::new(),
        gyroscopic: facts.gyroscopic.then(|| "g.npz".to_owned()),
        nodes: "nodes.csv".to_owned(),
        dofs: "dofs.csv".to_owned(),
        cyclic: pairs.filter(free).map(|pair| pair.map(id)).collect(),
        contact: contact.collect(),
        mesh: Some(ManifestMesh { elements: "elements.csv".to_owned(), sets }),
    };
    let nodes = mesh.node_ids.iter().zip(&mesh.nodes);
    RawPackage {
        manifest,
        nodes: nodes.map(|(&id, &position)| RawNode { id, position }).collect(),
        dofs: Vec::new(),
        mass: RawMatrix { size: 0, entries: Vec::new() },
        stiffness: Vec::new(),
        gyroscopic: None,
        elements: Some(elements(sector)),
    }
}

/// Element table.
fn elements(sector: &MeshedSector) -> Vec<RawElement> {
    let mesh = &sector.mesh;
    let sets: Vec<Arc<str>> = mesh.sets.iter().map(|set| set.name.as_str().into()).collect();
    let element = |element: &rubmap_solid::mesh::Element| RawElement {
        id: element.id,
        kind: element.kind,
        set: Arc::clone(&sets[element.set as usize]),
        nodes: element.nodes.iter().map(|&node| mesh.node_ids[node as usize]).collect(),
    };
    mesh.elements.iter().map(element).collect()
}

/// Drops entries that are exactly zero (the mass does not couple z with the plane).
fn without_zeros(mut matrix: RawMatrix) -> RawMatrix {
    matrix.entries.retain(|&(_, _, value)| value != 0.0);
    matrix
}
