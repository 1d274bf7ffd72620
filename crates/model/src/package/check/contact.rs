//! Checks of the contact nodes: known, free, inside the sector, each once, with unit normals.

use nalgebra::Vector3;

use super::cyclic::Neighbours;
use super::layout::{NONE, components};
use super::tables::NodeIndex;
use crate::package::error::{ManifestProblem, PackageError};
use crate::package::raw::RawPackage;

/// Largest difference of a normal from unit length: exporters print few digits. The normal is then made a unit vector.
const NORMAL_TOLERANCE: f64 = 1e-3;

/// Checks the contact nodes; returns them and their normals, normalised, in the package's frame.
pub(super) fn check(
    package: &RawPackage,
    index: &NodeIndex,
    rows_of_node: &[[u32; 3]],
    neighbours: &Neighbours,
) -> Result<(Vec<u32>, Vec<[f64; 3]>), PackageError> {
    if package.manifest.contact.is_empty() {
        return Err(PackageError::manifest("/contact", ManifestProblem::NoContact));
    }
    let mut nodes = Vec::new();
    let mut normals = Vec::new();
    let mut first_use = std::collections::HashMap::new();
    for (k, contact) in package.manifest.contact.iter().enumerate() {
        let wrong =
            |field: &str, problem| Err(PackageError::manifest(format!("/contact/{k}/{field}"), problem));
        let node = contact.node;
        let Some(&place) = index.get(&node) else {
            return wrong("node", ManifestProblem::UnknownNode { node });
        };
        if let Some(first) = first_use.insert(node, k) {
            return wrong("node", ManifestProblem::ContactRepeated { node, first });
        }
        if neighbours.on_axis.contains(&place) {
            return wrong("node", ManifestProblem::ContactOnAxis { node });
        }
        let face = match (neighbours.high_of[place as usize], neighbours.low_of[place as usize]) {
            (NONE, NONE) => None,
            (NONE, _) => Some("high"),
            _ => Some("low"),
        };
        if let Some(face) = face {
            return wrong("node", ManifestProblem::ContactOnFace { node, face });
        }
        let rows = &rows_of_node[place as usize];
        if rows.contains(&NONE) {
            return wrong("node", ManifestProblem::ContactClamped { node, components: components(rows) });
        }
        let length = Vector3::from(contact.normal).norm();
        if !length.is_finite() {
            return wrong("normal", ManifestProblem::NotFinite);
        }
        if (length - 1.0).abs() > NORMAL_TOLERANCE {
            return wrong("normal", ManifestProblem::NormalNotUnit { length, tolerance: NORMAL_TOLERANCE });
        }
        nodes.push(place);
        normals.push(contact.normal.map(|component| component / length));
    }
    Ok((nodes, normals))
}
