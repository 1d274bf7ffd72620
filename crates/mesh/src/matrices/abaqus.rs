//! Matrices of Abaqus, as `*MATRIX OUTPUT` writes them in the formats MATRIX INPUT, LABELS and COORDINATE.

use std::collections::BTreeSet;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::dof::{Dof, whole};
use super::mapping;
use super::raw::{RawEntry, RawMatrix, Rows, Triangles};
use crate::lines::{Lines, words};

/// Name of the format.
pub(super) const FORMAT: &str = "Abaqus matrix";

/// Advice on matrices in forms that are not read.
const GENERATE: &str =
    "write the global matrices by *MATRIX GENERATE and *MATRIX OUTPUT, FORMAT=MATRIX INPUT, one file each";

/// Reads lines of node, component, node, component and value.
pub(super) fn read_labels(bytes: &[u8]) -> Result<RawMatrix, MeshFileError> {
    let mut rows = Rows::default();
    let mut entries = Vec::new();
    let triangles = each_line(bytes, |number, words| {
        let &[row, row_component, column, column_component, value] = words else {
            let expected = "node, component, node, component and value".to_owned();
            return Err(MeshProblem::Expected { expected });
        };
        let row = rows.of(Dof::parsed(row, row_component)?)?;
        let column = rows.of(Dof::parsed(column, column_component)?)?;
        entries.push(RawEntry::new(row, column, fields::real(value, "an entry")?, number));
        Ok(())
    })?;
    Ok(RawMatrix { dofs: rows.dofs, entries, triangles, marks_clamped: true })
}

/// Reads lines of row, column and value, with the mapping of the rows. Negative rows are those of internal nodes.
pub(super) fn read_coordinates(bytes: &[u8], mapping: &[u8]) -> Result<RawMatrix, MeshFileError> {
    let labels = mapping::read(mapping)?;
    let mut unused: BTreeSet<u64> = labels.keys().copied().collect();
    let mut rows = Rows::default();
    let mut entries = Vec::new();
    let triangles = each_line(bytes, |number, words| {
        let &[row, column, value] = words else {
            return Err(MeshProblem::Expected { expected: "row, column and value".to_owned() });
        };
        let mut row_of = |word: &str| {
            let row = whole(word, "a row number")?;
            let Ok(positive) = u64::try_from(row) else {
                return rows.of(Dof { node: row, component: 0 });
            };
            unused.remove(&positive);
            let missing = || MeshProblem::NoSuch { what: "row of the mapping", name: row.to_string() };
            rows.of(*labels.get(&positive).ok_or_else(missing)?)
        };
        let (row, column) = (row_of(row)?, row_of(column)?);
        entries.push(RawEntry::new(row, column, fields::real(value, "an entry")?, number));
        Ok(())
    })?;
    if let Some(row) = unused.first() {
        let expected = format!("an entry of row {row}, which the mapping has: is it of another matrix?");
        return Err(MeshProblem::Expected { expected }.at(0, FORMAT));
    }
    Ok(RawMatrix { dofs: rows.dofs, entries, triangles, marks_clamped: true })
}

/// Calls `entry` with the words of each line that is no comment and no header; returns what the header says of triangles.
fn each_line(
    bytes: &[u8],
    mut entry: impl FnMut(u64, &[&str]) -> Result<(), MeshProblem>,
) -> Result<Triangles, MeshFileError> {
    let mut header = None;
    let mut began = false;
    for (number, line) in Lines::new(bytes) {
        let text = line.trim();
        if text.is_empty() || text.starts_with("**") {
            continue;
        }
        let result = if text.starts_with('*') {
            if header.is_some() || began {
                let what = "a second matrix in the file".to_owned();
                return Err(MeshProblem::NotCarried { what, advice: GENERATE }.at(number, FORMAT));
            }
            stated(text).map(|triangles| header = Some(triangles))
        } else {
            began = true;
            entry(number, &words(text).collect::<Vec<_>>())
        };
        result.map_err(|problem| problem.at(number, FORMAT))?;
    }
    Ok(header.unwrap_or(Triangles::Unstated))
}

/// Triangles that a header states.
fn stated(header: &str) -> Result<Triangles, MeshProblem> {
    let header = header.to_ascii_uppercase().replace(' ', "");
    let mut options = header.split(',');
    if !options.next().is_some_and(|keyword| keyword.starts_with("*MATRIX")) {
        return Err(MeshProblem::Expected { expected: "*MATRIX or an entry".to_owned() });
    }
    match options.find_map(|option| option.strip_prefix("TYPE=")) {
        Some("SYMMETRIC" | "DIAGONAL") => Ok(Triangles::One),
        Some("UNSYMMETRIC") => Ok(Triangles::Both),
        None => Ok(Triangles::Unstated),
        Some(other) => Err(MeshProblem::NotCarried {
            what: format!("a matrix of type {}", fields::quoted(other)),
            advice: GENERATE,
        }),
    }
}
