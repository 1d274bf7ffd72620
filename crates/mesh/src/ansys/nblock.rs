//! Nodes: the block of NBLOCK.

use super::columns::Columns;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, real};
use crate::lines::Lines;
use crate::mesh_file::MeshFile;

/// Name of the command.
const CARD: &str = "NBLOCK";

/// Reads the lines of a block of nodes, behind its command.
pub(super) fn read(lines: &mut Lines, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
    let columns = Columns::read(lines, CARD)?;
    loop {
        let line = lines.expect(CARD, "the end of the nodes (N,R5.3,LOC,-1 or -1)")?;
        let text = line.trim_ascii();
        if is_end(text) {
            return Ok(());
        }
        if !text.is_empty() {
            let Node { id, position, is_turned } =
                node(&columns, line).map_err(|problem| problem.at(lines.number(), CARD))?;
            if is_turned {
                mesh.nodal_frames.get_or_insert_with(|| (lines.number(), CARD.to_owned()));
            }
            if mesh.nodes.insert(id, position).is_some() {
                return Err(MeshProblem::Twice { what: "node", id }.at(lines.number(), CARD));
            }
        }
    }
}

/// Whether a line ends the block.
fn is_end(text: &[u8]) -> bool {
    let command = text.first().is_some_and(|b| b.eq_ignore_ascii_case(&b'N'));
    command || text.split(u8::is_ascii_whitespace).next() == Some(b"-1")
}

/// Node of a line.
struct Node {
    id: u64,
    position: [f64; 3],
    /// Whether an angle of rotation is not zero.
    is_turned: bool,
}

/// Node of a line. Coordinates and angles that the line does not reach to are zero.
fn node(columns: &Columns, line: &[u8]) -> Result<Node, MeshProblem> {
    let mut id = None;
    let mut position = [0.0; 3];
    let mut is_turned = false;
    let mut coordinates = position.iter_mut();
    for cell in columns.cut(line) {
        if cell.integer {
            if id.is_none() {
                id = Some(integer(cell.text, "a node number")?);
            }
        } else if let Some(coordinate) = coordinates.next() {
            if !cell.text.is_empty() {
                *coordinate = real(cell.text, "a coordinate")?;
            }
        } else if !cell.text.is_empty() {
            is_turned |= real(cell.text, "an angle of rotation")? != 0.0;
        }
    }
    let id = id.ok_or(MeshProblem::Expected { expected: "a node number".to_owned() })?;
    Ok(Node { id, position, is_turned })
}
