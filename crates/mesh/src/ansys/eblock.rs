//! Elements: the block of EBLOCK, with numbers of types and materials that other commands define.

use super::columns::Columns;
use super::command::Fields;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::integer;
use crate::lines::Lines;

/// Name of the command.
pub(super) const CARD: &str = "EBLOCK";
/// Columns of a solid's first line in front of its nodes.
const HEAD: usize = 11;
/// Columns in front of the nodes in the form without SOLID.
const LOOSE_HEAD: usize = 5;

/// Element as its block states it.
pub(super) struct Raw {
    /// Line on which it begins.
    pub(super) line: u64,
    /// Number of the element.
    pub(super) id: u64,
    /// Number of its type.
    pub(super) etype: u64,
    /// Number of its material.
    pub(super) material: u64,
    /// Numbers of its nodes; none in the form without SOLID, which does not state how many there are.
    pub(super) nodes: Option<Vec<u64>>,
}

/// Reads the lines of a block of elements, behind its command.
pub(super) fn read(lines: &mut Lines, fields: &Fields, into: &mut Vec<Raw>) -> Result<(), MeshFileError> {
    let solid = fields.upper(2) == "SOLID";
    let columns = Columns::read(lines, CARD)?;
    loop {
        let line = lines.expect(CARD, "the end of the elements (-1)")?;
        let text = line.trim_ascii();
        if text.split(u8::is_ascii_whitespace).next() == Some(b"-1") {
            return Ok(());
        }
        if !text.is_empty() {
            let raw = if solid { full(lines, &columns, line)? } else { loose(lines, &columns, line)? };
            into.push(raw);
        }
    }
}

/// Numbers of a line.
fn numbers(lines: &Lines, columns: &Columns, line: &[u8]) -> Result<Vec<u64>, MeshFileError> {
    let number = |text: &str| match text {
        "" => Ok(0),
        // Flags and coordinate systems may be negative, and are not used.
        _ => text.strip_prefix('-').map_or_else(|| integer(text, "a number"), |_| Ok(NEGATIVE)),
    };
    let numbers: Result<_, MeshProblem> = columns.cut(line).map(|cell| number(cell.text)).collect();
    numbers.map_err(|problem| problem.at(lines.number(), CARD))
}

/// Stand-in for a negative number, which no node, element, type or material has.
const NEGATIVE: u64 = u64::MAX;

/// Refuses a negative number.
fn natural(number: u64, expected: &'static str) -> Result<u64, MeshProblem> {
    let negative = MeshProblem::NotA { text: "-…".to_owned(), expected };
    if number == NEGATIVE { Err(negative) } else { Ok(number) }
}

/// Element with the number of its nodes stated, on as many lines as they take.
fn full(lines: &mut Lines, columns: &Columns, line: &[u8]) -> Result<Raw, MeshFileError> {
    let begin = lines.number();
    let found = numbers(lines, columns, line)?;
    let &[material, etype, _, _, _, _, _, _, count, _, id] = found.get(..HEAD).unwrap_or_default() else {
        let expected = "the 11 numbers of an element, then its nodes".to_owned();
        return Err(MeshProblem::Expected { expected }.at(begin, CARD));
    };
    let count = natural(count, "a number of nodes").map_err(|problem| problem.at(begin, CARD))?;
    let mut nodes = found.get(HEAD..).unwrap_or_default().to_vec();
    while (nodes.len() as u64) < count {
        let line = lines.expect(CARD, "the other nodes of the element")?;
        let more = numbers(lines, columns, line)?;
        if more.is_empty() {
            let expected = format!("{count} nodes of element {id}");
            return Err(MeshProblem::Expected { expected }.at(lines.number(), CARD));
        }
        nodes.extend(more);
    }
    nodes.truncate(usize::try_from(count).unwrap_or(usize::MAX));
    let checked = || {
        nodes.iter().try_for_each(|&node| natural(node, "a node number").map(|_| ()))?;
        let material = natural(material, "a material number")?;
        let etype = natural(etype, "a type number")?;
        Ok((natural(id, "an element number")?, etype, material))
    };
    let (id, etype, material) = checked().map_err(|problem: MeshProblem| problem.at(begin, CARD))?;
    Ok(Raw { line: begin, id, etype, material, nodes: Some(nodes) })
}

/// Element of the form without SOLID.
fn loose(lines: &Lines, columns: &Columns, line: &[u8]) -> Result<Raw, MeshFileError> {
    let found = numbers(lines, columns, line)?;
    let &[id, etype, _, material, _] = found.get(..LOOSE_HEAD).unwrap_or_default() else {
        let expected = "the 5 numbers of an element, then its nodes".to_owned();
        return Err(MeshProblem::Expected { expected }.at(lines.number(), CARD));
    };
    Ok(Raw { line: lines.number(), id, etype, material, nodes: None })
}
