//! Matrices of Nastran's OUTPUT4 in text form.

use crate::error::{MeshFileError, MeshProblem};

use super::choice;
use super::lines::Lines;
use super::mapping;
use super::op4_columns;
use super::op4_header::{FORMAT, Header};
use super::raw::{RawEntry, RawMatrix};

/// Reads the matrix of a name, or the only one, with the mapping of its rows.
pub(super) fn read(bytes: &[u8], mapping: &[u8], name: Option<&str>) -> Result<RawMatrix, MeshFileError> {
    let mut names = Vec::new();
    let mut lines = Lines::new(bytes);
    while let Some(header) = next_header(&mut lines)? {
        op4_columns::read(&mut lines, &header, |_, _, _, _| Ok(()))?;
        names.push(header.name);
    }
    let name = choice::of(names, name, FORMAT)?;
    let mut lines = Lines::new(bytes);
    while let Some(header) = next_header(&mut lines)? {
        if header.name != name {
            op4_columns::read(&mut lines, &header, |_, _, _, _| Ok(()))?;
            continue;
        }
        let triangles = header.triangles().map_err(|problem| problem.at(lines.number(), FORMAT))?;
        let dofs = mapping::of_size(mapping, header.rows)?;
        let mut entries = Vec::new();
        op4_columns::read(&mut lines, &header, |line, row, column, field| {
            let value = crate::fields::real(field, "an entry")?;
            if value != 0.0 {
                entries.push(RawEntry::new(row, column, value, line));
            }
            Ok(())
        })?;
        return Ok(RawMatrix { dofs, entries, triangles, marks_clamped: false });
    }
    Err(MeshProblem::CutShort { expected: "the matrix".to_owned() }.at(0, FORMAT))
}

/// Header of the next matrix; nothing at the end of the file.
fn next_header(lines: &mut Lines<'_>) -> Result<Option<Header>, MeshFileError> {
    let Some((number, line)) = lines.find(|(_, line)| !line.trim().is_empty()) else { return Ok(None) };
    Header::parsed(&line).map(Some).map_err(|problem| problem.at(number, FORMAT))
}
