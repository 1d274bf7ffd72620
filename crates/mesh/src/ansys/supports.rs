//! Supports: `D` commands, of which a model carries those that hold a node in all three directions.

use std::collections::BTreeMap;

use super::command::Fields;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted, real};
use crate::mesh_file::MeshFile;

/// Name of the command.
const CARD: &str = "D";
/// All three displacements.
const ALL: u8 = 0b111;
/// Places of more labels in the command, behind value, second value, last node and step.
const MORE: std::ops::RangeInclusive<usize> = 7..=11;

/// Displacements held at each node, one bit each, and the line of the first.
#[derive(Default)]
pub(super) struct Supports(BTreeMap<u64, (u8, u64)>);

impl Supports {
    /// Takes the command `D,node,UX,0`.
    pub(super) fn add(&mut self, fields: &Fields, line: u64) -> Result<(), MeshProblem> {
        let labels = std::iter::once(fields.get(2)).chain(MORE.map(|place| fields.get(place)));
        let held = labels.map(bits).fold(0, |all, one| all | one);
        if held == 0 {
            return Ok(());
        }
        let numbered = fields.get(1).starts_with(|c: char| c.is_ascii_digit());
        if !numbered || fields.has(5) || fields.has(6) {
            return Err(MeshProblem::NotCarried {
                what: format!("a support of \"{}\"", quoted(fields.get(1))),
                advice: "write the archive by CDWRITE, which names every held node by its number",
            });
        }
        let node = integer(fields.get(1), "a node number")?;
        for place in [3, 4] {
            if fields.has(place) && real(fields.get(place), "a displacement")? != 0.0 {
                return Err(MeshProblem::NotCarried {
                    what: format!("the displacement {} of node {node}", quoted(fields.get(place))),
                    advice: "only supports that hold nodes at zero are: delete it (DDELE)",
                });
            }
        }
        self.0.entry(node).or_insert((0, line)).0 |= held;
        Ok(())
    }

    /// Puts the held nodes into a mesh.
    pub(super) fn place(self, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        for (node, (held, line)) in self.0 {
            let problem = if held != ALL {
                let advice = "hold the node in all three directions (D,node,ALL,0), or not at all (DDELE)";
                MeshProblem::NotCarried {
                    what: format!("a support of node {node} in some directions"),
                    advice,
                }
            } else if mesh.nodes.contains_key(&node) {
                mesh.held.insert(node);
                continue;
            } else {
                MeshProblem::NoSuch { what: "node", name: node.to_string() }
            };
            return Err(problem.at(line, CARD));
        }
        Ok(())
    }
}

/// Displacements that a label names; none for rotations, temperatures and the like, which solids do not have.
fn bits(label: &str) -> u8 {
    match label.to_uppercase().as_str() {
        "UX" => 0b001,
        "UY" => 0b010,
        "UZ" => 0b100,
        "ALL" => ALL,
        _ => 0,
    }
}
