//! Every check of docs/package.md on a parsed package, each with its own error.
//!
//! The order is that of understanding: what `sector.json` says by itself, the tables, the matrices, then the
//! cyclic faces and the contact nodes. [`mass`] comes last, on the finished sector.

mod contact;
mod cyclic;
pub(super) mod layout;
pub(super) mod mass;
mod matrices;
pub(super) mod statement;
pub(super) mod tables;

use super::content::SourceLines;
use super::error::PackageError;
use super::raw::RawPackage;
use layout::{Layout, NONE};

/// Checks `package` and sorts its matrices (by column, then row) if they are not.
pub(super) fn check(package: &mut RawPackage, lines: &SourceLines) -> Result<Layout, PackageError> {
    let frame = statement::check(&package.manifest)?;
    let names = &package.manifest;
    let index = tables::node_index(&names.nodes, &package.nodes, lines)?;
    let (node_of_row, rows_of_node) = tables::rows(&names.dofs, &package.dofs, lines, &index)?;
    matrices::check(package)?;
    let (high_of, low_of) = cyclic::check(package, &frame, &index, &rows_of_node)?;
    let (contact, normals) = contact::check(package, &index, &rows_of_node, &high_of, &low_of)?;
    let mut own_rows = Vec::new();
    let mut own_of_row = vec![NONE; node_of_row.len()];
    for (row, &node) in node_of_row.iter().enumerate() {
        if low_of[node as usize] == NONE {
            own_of_row[row] = own_rows.len() as u32;
            own_rows.push(row as u32);
        }
    }
    for (high, &low) in low_of.iter().enumerate().filter(|(_, low)| **low != NONE) {
        for (&high_row, &low_row) in rows_of_node[high].iter().zip(&rows_of_node[low as usize]) {
            if high_row != NONE {
                own_of_row[high_row as usize] = own_of_row[low_row as usize];
            }
        }
    }
    Ok(Layout { frame, node_of_row, rows_of_node, high_of, low_of, own_rows, own_of_row, contact, normals })
}
