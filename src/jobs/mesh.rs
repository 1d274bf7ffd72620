//! Mesh of a stored package.

use std::path::Path;

use super::error::Interruption;
use crate::dynamics::nodes::SectorNode;
use crate::package::{self, Limits};
use crate::solid::mesh::SectorMesh;

/// Elements and nodes of a package; none for a package without elements.
pub(super) fn mesh_and_nodes(package: &Path) -> Result<Option<(SectorMesh, Vec<SectorNode>)>, Interruption> {
    let limits = Limits::default();
    let mesh = package::read_mesh(package, &limits).map_err(Interruption::stored_package)?;
    let Some(mesh) = mesh else { return Ok(None) };
    let nodes = package::read_nodes(package, &limits).map_err(Interruption::stored_package)?;
    Ok(Some((mesh, nodes)))
}
