//! Reader of the elements of a package that was checked before; its matrices stay unread.

use std::path::Path;

use rubmap_solid::mesh::SectorMesh;

use super::check::mesh::Faces;
use super::check::{cyclic, mesh, statement, tables};
use super::error::PackageError;
use super::limits::Limits;
use super::zip_package::{self, Stated};

/// Reads the mesh of the package at `path`, with its nodes in the order of the node table, which is that of
/// [`read_nodes`](super::read_nodes()); none if the package has no mesh. [`read`](super::read()) has accepted it before.
///
/// # Errors
/// Errors of [`read`](super::read()) that `sector.json` and the tables can cause.
pub fn read_mesh(path: &Path, limits: &Limits) -> Result<Option<SectorMesh>, PackageError> {
    let Stated { manifest, nodes, dofs, elements, lines } = zip_package::load_tables(path, limits)?;
    let (Some(stated), Some(elements)) = (&manifest.mesh, elements) else { return Ok(None) };
    let frame = statement::check(&manifest)?;
    let index = tables::node_index(&manifest.nodes, &nodes, &lines)?;
    let (_, rows_of_node) = tables::rows(&manifest.dofs, &dofs, &lines, &index)?;
    let (high_of, low_of) = cyclic::partners(&manifest, nodes.len(), &index)?;
    let faces = Faces { high_of: &high_of, low_of: &low_of };
    mesh::made(&manifest, stated, &elements, &nodes, &lines, &frame, &index, &rows_of_node, &faces).map(Some)
}
