//! Checks of docs/package.md on a parsed package, each with its own error.
//!
//! The order is that of understanding: what `sector.json` says by itself, the tables, the matrices, then the cyclic faces and the contact
//! nodes. [`mass`] and [`agreement`] come last, on the finished sector.

pub(super) mod agreement;
mod contact;
pub(super) mod cyclic;
pub(super) mod elements;
pub(super) mod layout;
pub(super) mod mass;
pub(super) mod materials;
mod matrices;
pub(super) mod mesh;
mod overlap;
pub(crate) mod slits;
pub(super) mod statement;
pub(super) mod tables;

use super::content::SourceLines;
use super::error::PackageError;
use super::raw::RawPackage;
use cyclic::Neighbours;
use layout::{Layout, own_of_rows};

/// Checks the elements of a package and their relation to its tables.
pub(super) fn mesh_alone(package: &RawPackage) -> Result<(), PackageError> {
    let lines = SourceLines::default();
    let frame = statement::check(&package.manifest)?;
    let index = tables::node_index(&package.manifest.nodes, &package.nodes, &lines)?;
    let (_, rows_of_node) = tables::rows(&package.manifest.dofs, &package.dofs, &lines, &index)?;
    let (high_of, low_of) = cyclic::partners(&package.manifest, package.nodes.len(), &index)?;
    let faces = mesh::Faces { high_of: &high_of, low_of: &low_of };
    mesh::check(package, &lines, &frame, &index, &rows_of_node, &faces).map(drop)
}

/// Checks `package` and sorts its matrices (by column, then row) if they are not.
pub(super) fn check(package: &mut RawPackage, lines: &SourceLines) -> Result<Layout, PackageError> {
    let frame = statement::check(&package.manifest)?;
    let names = &package.manifest;
    let index = tables::node_index(&names.nodes, &package.nodes, lines)?;
    let (node_of_row, rows_of_node) = tables::rows(&names.dofs, &package.dofs, lines, &index)?;
    matrices::check(package)?;
    let neighbours = cyclic::check(package, &frame, &index, &rows_of_node)?;
    let (contact, normals) = contact::check(package, &index, &rows_of_node, &neighbours)?;
    let Neighbours { high_of, low_of, on_axis } = neighbours;
    let faces = mesh::Faces { high_of: &high_of, low_of: &low_of };
    let mesh = mesh::check(package, lines, &frame, &index, &rows_of_node, &faces)?;
    let (own_rows, own_of_row) = own_of_rows(&node_of_row, &rows_of_node, &low_of);
    Ok(Layout {
        frame,
        node_of_row,
        rows_of_node,
        high_of,
        low_of,
        on_axis,
        own_rows,
        own_of_row,
        contact,
        normals,
        mesh,
    })
}
