//! Reader of the nodes of a package that was checked before, with the DOF that their displacement depends on; its matrices stay unread.

use std::collections::HashMap;
use std::path::Path;

use super::check::layout::{NONE, own_of_rows};
use super::check::{cyclic, statement, tables};
use super::error::PackageError;
use super::limits::Limits;
use super::raw::Frame;
use super::zip_package::{self, Stated};
use rubmap_wheel::dynamics::nodes::{NodeDof, SectorNode};

/// Reads every node of the package at `path`, in the order of its node table; [`read`](super::read) has accepted it before.
///
/// # Errors
/// Errors of [`read`](super::read) that `sector.json` and the tables can cause.
pub fn read_nodes(path: &Path, limits: &Limits) -> Result<Vec<SectorNode>, PackageError> {
    let Stated { manifest, nodes, dofs, lines, .. } = zip_package::load_tables(path, limits)?;
    let frame = statement::check(&manifest)?;
    let index = tables::node_index(&manifest.nodes, &nodes, &lines)?;
    let (node_of_row, rows_of_node) = tables::rows(&manifest.dofs, &dofs, &lines, &index)?;
    let (_, low_of) = cyclic::partners(&manifest, nodes.len(), &index)?;
    let (_, own_of_row) = own_of_rows(&node_of_row, &rows_of_node, &low_of);
    let contact: HashMap<u64, u32> = (0..).zip(&manifest.contact).map(|(k, node)| (node.node, k)).collect();
    let of = |place: usize| {
        // A high node has the DOF of its low node, in its components.
        let reference = if low_of[place] == NONE { place } else { low_of[place] as usize };
        let rows = rows_of_node[reference];
        let coordinates = frame.coordinates(nodes[place].position);
        let [_, theta, _] = frame.coordinates(nodes[reference].position);
        let basis = frame.cylindrical(theta);
        // A node that a Cartesian package clamps in part keeps its Cartesian components (partition.rs).
        let cartesian = manifest.frame == Frame::Cartesian && rows.contains(&NONE);
        let dof = |k: usize| {
            let components = std::array::from_fn(|component| match cartesian {
                true => basis[(component, k)],
                false => f64::from(u8::from(component == k)),
            });
            let row = rows[k];
            (row != NONE).then(|| NodeDof { dof: own_of_row[row as usize] as usize, components })
        };
        SectorNode {
            id: nodes[place].id,
            position: nodes[place].position,
            coordinates,
            dofs: std::array::from_fn(dof),
            on_high_face: low_of[place] != NONE,
            contact: contact.get(&nodes[place].id).copied(),
        }
    };
    Ok((0..nodes.len()).map(of).collect())
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::impeller::{CantileverParameters, cantilever};
    use crate::package::write;

    /// Node that a Cartesian package clamps in part: it keeps x, y, z, with their radial, tangential and axial parts.
    #[test]
    fn a_node_clamped_in_part_moves_along_its_cartesian_components() {
        let mut package =
            cantilever(&CantileverParameters { elements: [2, 1, 1], ..CantileverParameters::default() })
                .unwrap();
        package.manifest.frame = Frame::Cartesian;
        let id = package.dofs[package.dofs.len() / 2].node;
        package.dofs.retain(|dof| dof.node != id || dof.component != 1);
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&package, &file).unwrap();
        let nodes = read_nodes(file.path(), &Limits::default()).unwrap();
        let axis = Vector3::from(package.manifest.axis.direction).normalize();
        let whole = |node: &&SectorNode| node.dofs.iter().all(Option::is_some);
        assert!(nodes.iter().filter(whole).count() > 2);
        for node in nodes.iter().filter(whole) {
            assert_eq!(
                node.dofs.map(|dof| dof.unwrap().components),
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            );
        }
        let node = nodes.iter().find(|node| node.id == id).unwrap();
        let from_origin = Vector3::from(node.position) - Vector3::from(package.manifest.axis.origin);
        let radial = (from_origin - axis * from_origin.dot(&axis)).normalize();
        assert!(node.dofs[0].is_none());
        for k in [1, 2] {
            let expected = [radial[k], axis.cross(&radial)[k], axis[k]];
            let found = node.dofs[k].unwrap().components;
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
        }
    }
}
