//! Rows in another order or frame than the package says.
//!
//! A package is refused only if another reading of its rows, one that exports are known for, puts nodes in balance that are not in balance
//! as stated, and takes none out of balance: matrices that no reading balances may belong to something other than an elastic solid.

use std::f64::consts::TAU;

use super::better::{Better, FEWEST, best};
use super::rigid::{Balance, Body, Reading};
use crate::package::check::layout::{Layout, NONE};
use crate::package::error::{ManifestProblem, PackageError, RowReading};
use crate::package::raw::{Frame, RawPackage};

/// Refuses rows that are in balance only in another reading; names the one that balances most nodes.
pub(super) fn check(
    body: &Body,
    stated: &Balance,
    package: &RawPackage,
    layout: &Layout,
) -> Result<(), PackageError> {
    let inner = body.inner().count();
    if inner < stated.count() + FEWEST {
        return Ok(());
    }
    let others = readings(body, package, layout).map(|(field, meant, reading)| {
        ((field, meant), Balance::of(body, &reading, &package.stiffness[0]).nodes)
    });
    match best(&stated.nodes, inner, others) {
        Some(Better { reading: (field, reading), found }) => {
            let problem = ManifestProblem::RowsOtherwise { reading, stated: stated.count(), found, inner };
            Err(PackageError::manifest(field, problem))
        }
        None => Ok(()),
    }
}

/// Readings of the rows that exports are known for, each with the field of the manifest that states the reading.
fn readings<'a>(
    body: &'a Body,
    package: &'a RawPackage,
    layout: &'a Layout,
) -> impl Iterator<Item = (&'static str, RowReading, Reading)> + 'a {
    let stated_frame = package.manifest.frame;
    let other = match stated_frame {
        Frame::Cartesian => Frame::Cylindrical,
        Frame::Cylindrical => Frame::Cartesian,
    };
    let meant = other.name();
    let faces = move |node: usize| if body.on_face[node] { other } else { stated_frame };
    let frames = [false, true].into_iter().map(move |faces_alone| match faces_alone {
        false => ("/frame", RowReading::OtherFrame { meant }, body.in_frames(|_| other)),
        true => ("/frame", RowReading::FacesInOtherFrame { meant }, body.in_frames(faces)),
    });
    let turned = (stated_frame == Frame::Cartesian).then(|| {
        let mut turned = body.stated.clone();
        let axes = layout.frame.turned_global(TAU / package.manifest.sectors as f64);
        for (basis, _) in turned.bases.iter_mut().zip(&layout.low_of).filter(|(_, low)| **low != NONE) {
            *basis = axes;
        }
        ("/frame", RowReading::HighFaceTurned, turned)
    });
    let ordered = orders(package, layout).into_iter().map(|(meant, order)| {
        let mut reading = body.stated.clone();
        for (row, &listed) in order.iter().enumerate() {
            let node = layout.node_of_row[listed as usize] as usize;
            let component = package.dofs[listed as usize].component;
            reading.rows_of_node[node][usize::from(component) - 1] = row as u32;
        }
        ("/dofs", meant, reading)
    });
    let ordered = ordered.filter(|(_, _, reading)| reading.rows_of_node != body.stated.rows_of_node);
    frames.chain(turned).chain(ordered)
}

/// Rows of the DOF table in the orders of known exports.
fn orders(package: &RawPackage, layout: &Layout) -> Vec<(RowReading, Vec<u32>)> {
    let node = |row: u32| layout.node_of_row[row as usize];
    let id = |row: u32| package.dofs[row as usize].node;
    let component = |row: u32| package.dofs[row as usize].component;
    // First row of each node.
    let mut first = vec![NONE; layout.rows_of_node.len()];
    for row in (0..package.dofs.len() as u32).rev() {
        first[node(row) as usize] = row;
    }
    let listed = |row: u32| first[node(row) as usize];
    let nodes = |order| RowReading::NodesInOtherOrder { order };
    let grouped = |order| RowReading::ByComponent { order };
    let sorted = |key: &dyn Fn(u32) -> (u64, u64)| {
        let mut rows: Vec<u32> = (0..package.dofs.len() as u32).collect();
        rows.sort_by_key(|&row| key(row));
        rows
    };
    let by_node = |of: &dyn Fn(u32) -> u64| sorted(&|row| (of(row), component(row).into()));
    let by_component = |of: &dyn Fn(u32) -> u64| sorted(&|row| (component(row).into(), of(row)));
    let reversed = |of: &dyn Fn(u32) -> u64| by_node(&|row| u64::MAX - of(row));
    let (listed, table) = (|row: u32| u64::from(listed(row)), |row: u32| u64::from(node(row)));
    vec![
        (RowReading::ByNode, by_node(&listed)),
        (nodes("the DOF table, reversed"), reversed(&listed)),
        (nodes("ascending ids"), by_node(&id)),
        (nodes("descending ids"), reversed(&id)),
        (nodes("the node table"), by_node(&table)),
        (grouped("the DOF table"), by_component(&listed)),
        (grouped("ascending ids"), by_component(&id)),
        (grouped("the node table"), by_component(&table)),
    ]
}
