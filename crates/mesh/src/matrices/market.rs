//! Matrices in the Matrix Market format, as `*EXPORT` of Ansys writes them (MMF).

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::mapping;
use super::raw::{RawEntry, RawMatrix, Triangles};
use crate::lines::{Lines, words};

/// Name of the format.
pub(super) const FORMAT: &str = "Matrix Market";

/// Reads the matrix with the mapping of its rows.
pub(super) fn read(bytes: &[u8], mapping: &[u8]) -> Result<RawMatrix, MeshFileError> {
    let mut lines = Lines::new(bytes);
    let first = lines.next().map(|(_, line)| line.into_owned()).unwrap_or_default();
    let triangles = triangles(&first).map_err(|problem| problem.at(1, FORMAT))?;
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('%'));
    let Some((number, sizes)) = lines.next() else {
        return Err(MeshProblem::CutShort { expected: "the size of the matrix".to_owned() }.at(0, FORMAT));
    };
    let (size, announced) = size(&sizes).map_err(|problem| problem.at(number, FORMAT))?;
    let dofs = mapping::of_size(mapping, size)?;
    let mut entries = Vec::new();
    for (number, line) in lines {
        let entry = entry(&line, size, number).map_err(|problem| problem.at(number, FORMAT))?;
        if entries.len() as u64 == announced {
            let expected = format!("the end after {announced} entries");
            return Err(MeshProblem::Expected { expected }.at(number, FORMAT));
        }
        entries.push(entry);
    }
    if (entries.len() as u64) < announced {
        let expected = format!("{} more entries", announced - entries.len() as u64);
        return Err(MeshProblem::CutShort { expected }.at(0, FORMAT));
    }
    Ok(RawMatrix { dofs, entries, triangles, marks_clamped: false })
}

/// Triangles that the first line states.
fn triangles(line: &str) -> Result<Triangles, MeshProblem> {
    let line = line.to_ascii_lowercase();
    let kind: Vec<&str> = line.split_whitespace().skip(1).collect();
    match kind.as_slice() {
        ["matrix", "coordinate", "real" | "integer", "symmetric"] => Ok(Triangles::One),
        ["matrix", "coordinate", "real" | "integer", "general"] => Ok(Triangles::Both),
        _ => Err(MeshProblem::NotCarried {
            what: format!("a \"{}\"", fields::quoted(&kind.join(" "))),
            advice: "mass and stiffness matrices are of kind coordinate, real, symmetric or general",
        }),
    }
}

/// Number of rows and of entries.
fn size(line: &str) -> Result<(u64, u64), MeshProblem> {
    let words: Vec<&str> = words(line).collect();
    let &[rows, columns, entries] = words.as_slice() else {
        return Err(MeshProblem::Expected { expected: "rows, columns and number of entries".to_owned() });
    };
    let rows = fields::integer(rows, "a number of rows")?;
    if fields::integer(columns, "a number of columns")? != rows {
        return Err(MeshProblem::Expected { expected: format!("as many columns as rows, {rows}") });
    }
    Ok((rows, fields::integer(entries, "a number of entries")?))
}

/// Entry of a line.
fn entry(line: &str, size: u64, number: u64) -> Result<RawEntry, MeshProblem> {
    let words: Vec<&str> = words(line).collect();
    let &[row, column, value] = words.as_slice() else {
        return Err(MeshProblem::Expected { expected: "row, column and value".to_owned() });
    };
    let index = |word: &str| {
        let index = fields::integer(word, "a row number")?.checked_sub(1).filter(|index| *index < size);
        let expected = "a row of the matrix";
        let refused = || MeshProblem::NotA { text: fields::quoted(word), expected };
        index.and_then(|index| u32::try_from(index).ok()).ok_or_else(refused)
    };
    Ok(RawEntry::new(index(row)?, index(column)?, fields::real(value, "an entry")?, number))
}
