//! `$Nodes`: numbers and positions.

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;

use super::source::Source;

/// Reads the nodes of a file of version 2.2.
pub(super) fn version_2(source: &mut Source<'_>, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
    source.text_row("the number of nodes")?;
    let count = source.text_size("the number of nodes")?;
    source.claim(count, 28, "nodes")?;
    for _ in 0..count {
        source.row("a node")?;
        let id = source.small("a node number")?;
        let position = position(source)?;
        source.end_row()?;
        insert(source, mesh, id, position)?;
    }
    source.end()
}

/// Reads the nodes of a file of version 4.1: in each block all numbers, then all positions.
pub(super) fn version_4(source: &mut Source<'_>, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
    source.row("the number of blocks of nodes")?;
    let blocks = source.size("the number of blocks of nodes")?;
    for expected in ["the number of nodes", "the smallest node number", "the largest node number"] {
        source.size(expected)?;
    }
    source.end_row()?;
    for _ in 0..blocks {
        source.row("a block of nodes")?;
        let dimension = source.integer("the dimension of an entity")?;
        source.integer("the number of an entity")?;
        let parametric = source.integer("0 or 1 for parametric coordinates")?;
        let count = source.size("the number of nodes of a block")?;
        source.end_row()?;
        source.claim(count, 32, "nodes")?;
        let mut ids = Vec::new();
        for _ in 0..count {
            source.row("a node number")?;
            ids.push(source.size("a node number")?);
            source.end_row()?;
        }
        let parameters = if parametric == 0 { 0 } else { dimension.clamp(0, 3) };
        for id in ids {
            source.row("the position of a node")?;
            let position = position(source)?;
            for _ in 0..parameters {
                source.real("a parametric coordinate")?;
            }
            source.end_row()?;
            insert(source, mesh, id, position)?;
        }
    }
    source.end()
}

fn position(source: &mut Source<'_>) -> Result<[f64; 3], MeshFileError> {
    let mut position = [0.0; 3];
    for x in &mut position {
        *x = source.real("a coordinate")?;
    }
    Ok(position)
}

fn insert(
    source: &Source<'_>,
    mesh: &mut MeshFile,
    id: u64,
    position: [f64; 3],
) -> Result<(), MeshFileError> {
    match mesh.nodes.insert(id, position) {
        None => Ok(()),
        Some(_) => Err(source.error(MeshProblem::Twice { what: "node", id })),
    }
}
