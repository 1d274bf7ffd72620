//! Sets: the blocks of CMBLOCK, which list numbers and ranges of them.

use super::columns::Columns;
use super::command::Fields;
use super::listed::listed;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted};
use crate::lines::Lines;
use crate::mesh_file::MeshFile;

/// Name of the command.
const CARD: &str = "CMBLOCK";

/// Component, as the file lists it.
pub(super) struct Component {
    name: String,
    kind: Kind,
    /// First and last number of each range.
    ranges: Vec<(u64, u64)>,
}

/// Kind of what a component lists.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Nodes,
    Elements,
    Other,
}

/// Reads the lines of a component, behind its command.
pub(super) fn read(lines: &mut Lines, fields: &Fields) -> Result<Component, MeshFileError> {
    let begin = lines.number();
    let kind = match fields.upper(2).as_str() {
        "NODE" | "NODES" => Kind::Nodes,
        "ELEM" | "ELEMENT" | "ELEMENTS" => Kind::Elements,
        _ => Kind::Other,
    };
    let count = integer(fields.get(3), "the number of the component's entries")
        .map_err(|problem| problem.at(begin, CARD))?;
    let columns = Columns::read(lines, CARD)?;
    let mut component = Component { name: fields.get(1).to_owned(), kind, ranges: Vec::new() };
    let mut taken = 0;
    while taken < count {
        let line = lines.expect(CARD, "the other entries of the component")?;
        let before = taken;
        for cell in columns.cut(line) {
            component.take(cell.text).map_err(|problem| problem.at(lines.number(), CARD))?;
            taken += 1;
        }
        if taken == before {
            let expected = format!("{count} entries of {}", quoted(&component.name));
            return Err(MeshProblem::Expected { expected }.at(lines.number(), CARD));
        }
    }
    Ok(component)
}

/// Puts components into a mesh.
pub(super) fn place(components: Vec<Component>, mesh: &mut MeshFile) {
    let mut lacking = Vec::new();
    for component in components {
        let name = component.name.clone();
        if !component.place(mesh) {
            lacking.push(name);
        }
    }
    if !lacking.is_empty() {
        mesh.note(format!("sets that list nodes which the file does not have: {}", listed(&lacking)));
    }
}

impl Component {
    /// Takes an entry: a number, or with a minus sign the end of the range that the number before began.
    fn take(&mut self, text: &str) -> Result<(), MeshProblem> {
        const EXPECTED: &str = "a node or element number";
        let Some(end) = text.strip_prefix('-') else {
            let number = integer(text, EXPECTED)?;
            self.ranges.push((number, number));
            return Ok(());
        };
        let end = integer(end, EXPECTED)?;
        match self.ranges.last_mut() {
            Some((first, last)) if first == last && *first <= end => *last = end,
            _ => return Err(MeshProblem::NotA { text: quoted(text), expected: "the end of a range" }),
        }
        Ok(())
    }

    /// Puts the component into a mesh and returns whether all its nodes are there. Numbers rise in it, as Ansys keeps them.
    fn place(mut self, mesh: &mut MeshFile) -> bool {
        // Ranges that overlap are taken together: else a short file could list a mesh over and over.
        self.ranges.sort_unstable();
        let mut apart: Vec<(u64, u64)> = Vec::new();
        for (first, last) in self.ranges {
            match apart.last_mut() {
                Some((_, end)) if first <= *end => *end = last.max(*end),
                _ => apart.push((first, last)),
            }
        }
        match self.kind {
            Kind::Nodes => {
                let missing = |&(first, last): &(u64, u64)| mesh.nodes.range(first..=last).next().is_none();
                let whole = !apart.iter().any(missing);
                let nodes = apart.iter().flat_map(|&(first, last)| mesh.nodes.range(first..=last));
                let nodes = nodes.map(|(&id, _)| id).collect();
                mesh.node_sets.insert(self.name, nodes);
                return whole;
            }
            Kind::Elements => {
                let solids = apart.iter().flat_map(|&(first, last)| mesh.elements.range(first..=last));
                let solids = solids.map(|(&id, _)| id).collect();
                mesh.element_sets.insert(self.name, solids);
            }
            Kind::Other => {}
        }
        true
    }
}
