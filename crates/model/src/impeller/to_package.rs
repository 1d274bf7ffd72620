//! Conversion of a sector mesh into the content of a model package (docs/package.md).

use std::collections::BTreeMap;
use std::sync::Arc;

use rubmap_solid::element::ElementKind;

use super::error::ImpellerError;
use super::material::Material;
use super::matrices::SectorMatrices;
use super::mesh::{Elements, SectorMesh};
use super::ranges::positive;
use crate::package::raw::{
    Axis, Frame, Manifest, ManifestContact, ManifestMesh, RawDof, RawElement, RawMatrix, RawNode, RawPackage,
};
use rubmap_wheel::dynamics::sector::Units;

/// Name of the only element set.
const SET: &str = "WHEEL";

/// Assembles the sector and packs it: cylindrical frame, unassembled high face, K at rest, Ω1/2 and Ω1.
///
/// Node ids count from 1 in the order of the mesh.
///
/// # Errors
/// [`ImpellerError`] from the assembly, or for a top speed that is not positive.
pub fn to_package(
    name: &str,
    sector: &SectorMesh,
    material: &Material,
    units: &Units,
    top_speed_rad_s: f64,
) -> Result<RawPackage, ImpellerError> {
    positive("top_speed_rad_s", top_speed_rad_s)?;
    let matrices = SectorMatrices::assemble(sector, material)?;
    let speeds_rad_s = vec![0.0, 0.5 * top_speed_rad_s, top_speed_rad_s];
    let id = |node: usize| node as u64 + 1;
    let free = |node: usize| sector.clamped[node] != [true; 3];
    let cyclic = sector.cyclic.iter().filter(|&&(low, _)| free(low)).map(|&(l, h)| [id(l), id(h)]).collect();
    let contact = sector.contact.iter().map(|tip| ManifestContact { node: id(tip.node), normal: tip.normal });
    let manifest = Manifest {
        name: name.to_owned(),
        sectors: sector.sectors,
        units: units.clone(),
        axis: Axis { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] },
        speeds_rad_s: speeds_rad_s.clone(),
        frame: Frame::Cylindrical,
        mass: "m.npz".to_owned(),
        stiffness: (0..3).map(|s| format!("k{s}.npz")).collect(),
        gyroscopic: None,
        nodes: "nodes.csv".to_owned(),
        dofs: "dofs.csv".to_owned(),
        cyclic,
        contact: contact.collect(),
        mesh: Some(ManifestMesh {
            elements: "elements.csv".to_owned(),
            sets: BTreeMap::from([(SET.to_owned(), material.to_solid())]),
        }),
    };
    let nodes = &sector.mesh.nodes;
    let dofs = &matrices.rest.dofs.list;
    Ok(RawPackage {
        manifest,
        nodes: nodes.iter().enumerate().map(|(n, &position)| RawNode { id: id(n), position }).collect(),
        dofs: dofs.iter().map(|&(n, c)| RawDof { node: id(n), component: c as u8 + 1 }).collect(),
        stiffness: speeds_rad_s.iter().map(|&speed| matrices.stiffness(speed)).collect(),
        mass: without_zeros(matrices.rest.mass()),
        gyroscopic: None,
        elements: Some(elements(&sector.mesh.elements)),
    })
}

/// Element table; numbers count from 1.
fn elements(elements: &Elements) -> Vec<RawElement> {
    let set: Arc<str> = SET.into();
    let kind = match elements {
        Elements::Linear(_) => ElementKind::QM6,
        Elements::Quadratic(_) => ElementKind::C3D20,
    };
    let element = |e: usize| RawElement {
        id: e as u64 + 1,
        kind,
        set: Arc::clone(&set),
        nodes: elements.nodes_of(e).iter().map(|&node| node as u64 + 1).collect(),
    };
    (0..elements.len()).map(element).collect()
}

/// Drops entries that are exactly zero (the mass does not couple z with the plane).
fn without_zeros(mut matrix: RawMatrix) -> RawMatrix {
    matrix.entries.retain(|&(_, _, value)| value != 0.0);
    matrix
}
