//! Rows in another order or frame than the package says.
//!
//! A package is refused only if another reading of its rows, of those that exports are known for, puts nodes in balance that
//! are not as it is stated, and spoils none: matrices that no reading balances may be of something else than an elastic solid.

use rubmap_solid::frame::Basis;

use super::rigid::{Balance, Body, Reading};
use crate::package::check::layout::NONE;
use crate::package::error::{ManifestProblem, PackageError, RowReading};
use crate::package::raw::{Frame, RawDof, RawPackage};

/// Fewest nodes that another reading must put in balance.
const FEWEST: usize = 3;

/// Refuses rows that are in balance only in another reading.
pub(super) fn check(body: &Body, stated: &Balance, package: &RawPackage) -> Result<(), PackageError> {
    let inner = body.inner().count();
    if inner < stated.count() + FEWEST {
        return Ok(());
    }
    let alpha = std::f64::consts::TAU / package.manifest.sectors as f64;
    let other = match body.frame {
        Frame::Cartesian => Frame::Cylindrical,
        Frame::Cylindrical => Frame::Cartesian,
    };
    let frame_field = "/frame".to_owned();
    let frames = [
        (RowReading::OtherFrame { meant: other.name() }, body.in_frames(|_| other)),
        (
            RowReading::FacesInOtherFrame { meant: other.name() },
            body.in_frames(|node| if body.on_face[node] { other } else { body.frame }),
        ),
    ];
    let turned = (body.frame == Frame::Cartesian)
        .then(|| (RowReading::HighFaceTurned, high_face_turned(body, package, alpha)))
        .into_iter();
    for (reading, rows) in frames.into_iter().chain(turned) {
        judge(body, stated, package, &rows, frame_field.clone(), reading)?;
    }
    for (reading, order) in orders(package) {
        let rows_of_node = in_order(&order, package, body.rows_of_node.len());
        if rows_of_node != body.rows_of_node {
            let rows = Reading { rows_of_node, ..body.as_stated() };
            judge(body, stated, package, &rows, "/dofs".to_owned(), reading)?;
        }
    }
    Ok(())
}

fn judge(
    body: &Body,
    stated: &Balance,
    package: &RawPackage,
    rows: &Reading,
    field: String,
    reading: RowReading,
) -> Result<(), PackageError> {
    let found = Balance::of(body, rows, &package.stiffness[0]);
    let (mut gained, mut lost) = (0, 0);
    for (before, after) in stated.nodes.iter().zip(&found.nodes) {
        gained += usize::from(!before & after);
        lost += usize::from(before & !after);
    }
    if gained < FEWEST.max(lost * 10) {
        return Ok(());
    }
    let problem = ManifestProblem::RowsOtherwise {
        reading,
        stated: stated.count(),
        found: found.count(),
        inner: body.inner().count(),
    };
    Err(PackageError::manifest(field, problem))
}

/// Components of high nodes along the axes of the first sector turned with it, as those of its low face.
fn high_face_turned(body: &Body, package: &RawPackage, alpha: f64) -> Reading {
    let mut reading = body.as_stated();
    let axis = nalgebra::Unit::new_normalize(body.axis);
    let turned = Basis::from(nalgebra::Rotation3::from_axis_angle(&axis, alpha)).transpose();
    let high: std::collections::HashSet<u64> = package.manifest.cyclic.iter().map(|pair| pair[1]).collect();
    for (node, basis) in package.nodes.iter().zip(&mut reading.bases) {
        if high.contains(&node.id) {
            *basis = turned;
        }
    }
    reading
}

/// DOF in the orders that exports have them in.
fn orders(package: &RawPackage) -> Vec<(RowReading, Vec<RawDof>)> {
    let mut listed: Vec<u64> = package.dofs.iter().map(|dof| dof.node).collect();
    let mut seen = std::collections::HashSet::new();
    listed.retain(|&node| seen.insert(node));
    let mut components: std::collections::HashMap<u64, Vec<u8>> = std::collections::HashMap::new();
    for dof in &package.dofs {
        components.entry(dof.node).or_default().push(dof.component);
    }
    components.values_mut().for_each(|components| components.sort_unstable());
    let reversed: Vec<u64> = listed.iter().rev().copied().collect();
    let mut ascending = listed.clone();
    ascending.sort_unstable();
    let descending: Vec<u64> = ascending.iter().rev().copied().collect();
    let table: Vec<u64> =
        package.nodes.iter().map(|node| node.id).filter(|node| components.contains_key(node)).collect();
    let by_node = |nodes: &[u64]| -> Vec<RawDof> {
        let of = |&node: &u64| components[&node].iter().map(move |&component| RawDof { node, component });
        nodes.iter().flat_map(of).collect()
    };
    let by_component = |nodes: &[u64]| -> Vec<RawDof> {
        let mut dofs = by_node(nodes);
        dofs.sort_by_key(|dof| dof.component);
        dofs
    };
    let nodes = |order| RowReading::NodesInOtherOrder { order };
    let grouped = |order| RowReading::ByComponent { order };
    vec![
        (RowReading::ByNode, by_node(&listed)),
        (nodes("the reverse of dofs.csv"), by_node(&reversed)),
        (nodes("ascending ids"), by_node(&ascending)),
        (nodes("descending ids"), by_node(&descending)),
        (nodes("the node table"), by_node(&table)),
        (grouped("dofs.csv"), by_component(&listed)),
        (grouped("ascending ids"), by_component(&ascending)),
        (grouped("the node table"), by_component(&table)),
    ]
}

fn in_order(order: &[RawDof], package: &RawPackage, nodes: usize) -> Vec<[u32; 3]> {
    let index: std::collections::HashMap<u64, usize> =
        package.nodes.iter().enumerate().map(|(k, node)| (node.id, k)).collect();
    let mut rows = vec![[NONE; 3]; nodes];
    for (row, dof) in order.iter().enumerate() {
        rows[index[&dof.node]][usize::from(dof.component) - 1] = row as u32;
    }
    rows
}
