//! Positions of the nodes of a package, without its matrices.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use nalgebra::Vector3;

use super::error::PackageError;
use super::limits::Limits;
use super::raw::{Frame, Manifest, RawDof, RawNode};
use super::zip_package::{self, Stated};
use rubmap_solid::frame::AxisFrame;

/// Nodes of a sector, with its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SectorNodes {
    /// Axis of rotation: a point on it, and its direction, of any length.
    pub axis: ([f64; 3], [f64; 3]),
    /// Nodes in the order of the node table.
    pub nodes: Vec<PlacedNode>,
    /// Contact nodes from the leading to the trailing edge: their position in `nodes`, and the outward unit normal, (r, θ, z) components.
    pub contact: Vec<(usize, [f64; 3])>,
}

/// Node of a sector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedNode {
    /// Id in the user's model.
    pub id: u64,
    /// Position `[r, θ, z]` about the axis, θ in rad.
    pub position: [f64; 3],
    /// Cyclic face on which the node lies.
    pub face: Option<Face>,
    /// Whether the node has no unknowns.
    pub held: bool,
}

/// Cyclic face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Face where the sector begins.
    Low,
    /// Face where the next sector begins.
    High,
}

/// Reads the tables of the package at `path`, which passed every check of [`read`](super::read()) before.
///
/// # Errors
/// The first problem found with the archive, `sector.json` or the tables.
pub fn read_places(path: &Path, limits: &Limits) -> Result<SectorNodes, PackageError> {
    let Stated { manifest, nodes, dofs, .. } = zip_package::load_tables(path, limits)?;
    Ok(places(&manifest, &nodes, &dofs))
}

fn places(manifest: &Manifest, nodes: &[RawNode], dofs: &[RawDof]) -> SectorNodes {
    let free: HashSet<u64> = dofs.iter().map(|dof| dof.node).collect();
    let mut faces = HashMap::new();
    for [low, high] in &manifest.cyclic {
        faces.insert(*low, Face::Low);
        faces.insert(*high, Face::High);
    }
    // The axis has a direction, or the package would not have passed the checks.
    let frame = AxisFrame::new(manifest.axis.origin, manifest.axis.direction);
    let place = |node: &RawNode| PlacedNode {
        id: node.id,
        position: frame.as_ref().map_or(node.position, |frame| frame.coordinates(node.position)),
        face: faces.get(&node.id).copied(),
        held: !free.contains(&node.id),
    };
    let places: Vec<PlacedNode> = nodes.iter().map(place).collect();
    let numbers: HashMap<u64, usize> = places.iter().enumerate().map(|(k, place)| (place.id, k)).collect();
    let contact = manifest.contact.iter().filter_map(|contact| {
        let number = *numbers.get(&contact.node)?;
        let given = Vector3::from(contact.normal).normalize();
        let normal = match (manifest.frame, &frame) {
            (Frame::Cartesian, Some(frame)) => frame.cylindrical(places[number].position[1]) * given,
            _ => given,
        };
        Some((number, normal.into()))
    });
    let axis = (manifest.axis.origin, manifest.axis.direction);
    SectorNodes { axis, contact: contact.collect(), nodes: places }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impeller::{CantileverParameters, cantilever};
    use crate::package::{read, write};

    /// Contact nodes compared with those of the reader of the whole package.
    #[test]
    fn contact_nodes_are_where_the_model_has_them() {
        let beam =
            cantilever(&CantileverParameters { elements: [4, 1, 1], ..CantileverParameters::default() })
                .unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&beam, &file).unwrap();
        let sector = read(file.path(), &Limits::default()).unwrap().sector;
        let places = read_places(file.path(), &Limits::default()).unwrap();
        assert_eq!(places.nodes.len(), beam.nodes.len());
        assert_eq!(places.contact.len(), sector.contact.len());
        for ((number, normal), node) in places.contact.iter().zip(&sector.contact) {
            let place = places.nodes[*number];
            assert_eq!((place.id, place.position, place.held), (node.id, node.position, false));
            assert!(normal.iter().zip(node.normal).all(|(a, b)| (a - b).abs() < 1e-12));
        }
        let held = places.nodes.iter().filter(|place| place.held).count();
        assert_eq!(3 * (places.nodes.len() - held), beam.dofs.len(), "every other node has three unknowns");
        let low = places.nodes.iter().filter(|place| place.face == Some(Face::Low)).count();
        assert_eq!(low, beam.manifest.cyclic.len());
    }
}
