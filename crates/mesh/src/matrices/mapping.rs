//! Mapping of the rows of a matrix to nodes: lines of a row, a node and a degree of freedom.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::dof::Dof;
use crate::lines::{Lines, words};

/// Place of a refusal that concerns the mapping.
const PLACE: &str = "mapping";

/// Names of degrees of freedom in Ansys, from component 1 on.
const NAMES: [&str; 6] = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"];

/// Degrees of freedom by row, which counts from 1.
pub(super) fn read(bytes: &[u8]) -> Result<BTreeMap<u64, Dof>, MeshFileError> {
    let mut rows = BTreeMap::new();
    let mut seen = BTreeSet::new();
    for (number, line) in Lines::new(bytes) {
        let words: Vec<&str> = words(&line).collect();
        let begins_as_text = words.first().is_none_or(|word| !word.starts_with(|c: char| c.is_ascii_digit()));
        if words.is_empty()
            || (begins_as_text && (rows.is_empty() || line.trim_start().starts_with(COMMENTS)))
        {
            continue;
        }
        let (row, dof) = parsed(&words).map_err(|problem| problem.at(number, PLACE))?;
        if rows.insert(row, dof).is_some() {
            return Err(MeshProblem::Twice { what: "row", id: row }.at(number, PLACE));
        }
        if !seen.insert(dof) {
            return Err(MeshProblem::TwoRows { dof: dof.to_string() }.at(number, PLACE));
        }
    }
    if rows.is_empty() {
        return Err(MeshProblem::Expected { expected: LINES.to_owned() }.at(0, PLACE));
    }
    Ok(rows)
}

/// Beginnings of lines that are comments.
const COMMENTS: [char; 5] = ['#', '%', '!', '*', '$'];

/// Form of the lines, in the words of a refusal.
const LINES: &str = "lines of a row, a node and a degree of freedom, such as 1 5 UX or 1 5 1";

/// Row and degree of freedom of a line.
fn parsed(words: &[&str]) -> Result<(u64, Dof), MeshProblem> {
    let [row, node, dof] = words else {
        return Err(MeshProblem::Expected { expected: LINES.to_owned() });
    };
    let name = NAMES.iter().position(|name| name.eq_ignore_ascii_case(dof));
    let number = || dof.parse().ok().filter(|number| (1..=6).contains(number));
    let component = name.and_then(|index| u8::try_from(index + 1).ok()).or_else(number);
    let expected = "a degree of freedom such as UX or 1";
    let component = component.ok_or_else(|| MeshProblem::NotA { text: fields::quoted(dof), expected })?;
    let node = fields::integer(node, "a node number")?;
    let node = i64::try_from(node).map_err(|_| MeshProblem::NotA {
        text: fields::quoted(&node.to_string()),
        expected: "a node number",
    })?;
    Ok((fields::integer(row, "a row number")?, Dof { node, component }))
}

/// Degrees of freedom of the rows 1 to `size`, each of which the mapping must have.
pub(super) fn of_size(bytes: &[u8], size: u64) -> Result<Vec<Dof>, MeshFileError> {
    let rows = read(bytes)?;
    let refused = |expected: String| Err(MeshProblem::Expected { expected }.at(0, PLACE));
    if let Some((row, _)) = rows.iter().find(|(row, _)| **row == 0 || **row > size) {
        return refused(format!("the rows 1 to {size} that the matrix has, not row {row}"));
    }
    match rows.keys().zip(1..).find(|(row, expected)| *row != expected) {
        Some((_, expected)) => refused(format!("a line for row {expected} of the matrix")),
        None if (rows.len() as u64) < size => {
            refused(format!("a line for row {} of the matrix", rows.len() + 1))
        }
        None => Ok(rows.into_values().collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::of_size;

    fn refusal(text: &str) -> String {
        of_size(text.as_bytes(), 2).unwrap_err().to_string()
    }

    #[test]
    fn every_form_of_a_line() {
        let rows = of_size(b"  Matrix Eqn     Node    DOF\n   1   5  UX\n\n   2   5  uz\n", 2).unwrap();
        assert_eq!(of_size(b"# row, node, dof\n2, 5, 3\n%\n1, 5, 1\n", 2).unwrap(), rows);
    }

    #[test]
    fn refusals() {
        assert_eq!(refusal("1 5 UX\n1 5 UY\n"), "line 2 (mapping): row 1 is there twice");
        assert_eq!(refusal("1 5 UX\n2 5 1\n"), "line 2 (mapping): node 5 component 1 has two rows");
        assert_eq!(refusal("1 5 UX\n"), "mapping: expected a line for row 2 of the matrix");
        assert_eq!(
            refusal("1 5 UX\n3 5 UY\n"),
            "mapping: expected the rows 1 to 2 that the matrix has, not row 3"
        );
        let temperature = "line 1 (mapping): \"TEMP\" is not a degree of freedom such as UX or 1";
        assert_eq!(refusal("1 5 TEMP\n"), temperature);
        assert!(refusal("5.1\n").contains("expected lines of a row, a node and a degree of freedom"));
        assert!(refusal("").contains("expected lines of a row"));
    }
}
