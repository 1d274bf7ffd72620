//! Matrices of Nastran's OUTPUT4, in text form or binary.

use crate::error::{MeshFileError, MeshProblem};

use super::choice;
use super::mapping;
use super::op4_binary::{self, Records};
use super::op4_columns;
use super::op4_header::{FORMAT, Header, Take};
use super::raw::{RawEntry, RawMatrix};
use crate::lines::Lines;

/// Reads the matrix of a name, or the only one, with the mapping of its rows.
pub(super) fn read(bytes: &[u8], mapping: &[u8], name: Option<&str>) -> Result<RawMatrix, MeshFileError> {
    let mut names = Vec::new();
    let mut source = Source::of(bytes);
    while let Some(header) = source.header()? {
        source.columns(&header, &mut |_, _, _, _| Ok(()))?;
        names.push(header.name);
    }
    let name = choice::of(names, name, FORMAT)?;
    let mut source = Source::of(bytes);
    while let Some(header) = source.header()? {
        if header.name != name {
            source.columns(&header, &mut |_, _, _, _| Ok(()))?;
            continue;
        }
        let triangles = header.triangles().map_err(|problem| problem.at(source.line(), FORMAT))?;
        let dofs = mapping::of_size(mapping, header.rows)?;
        let mut entries = Vec::new();
        source.columns(&header, &mut |line, row, column, number| {
            let value = number.value()?;
            if value != 0.0 {
                entries.push(RawEntry::new(row, column, value, line));
            }
            Ok(())
        })?;
        return Ok(RawMatrix { dofs, entries, triangles, marks_clamped: false });
    }
    Err(MeshProblem::CutShort { expected: "the matrix".to_owned() }.at(0, FORMAT))
}

/// File in either form.
enum Source<'a> {
    Text(Lines<'a>),
    Binary(Records<'a>),
}

impl<'a> Source<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        if op4_binary::is_binary(bytes) {
            Self::Binary(Records::new(bytes))
        } else {
            Self::Text(Lines::new(bytes))
        }
    }

    /// Line that was read last; 0 in binary files.
    fn line(&self) -> u64 {
        match self {
            Self::Text(lines) => lines.number(),
            Self::Binary(_) => 0,
        }
    }

    /// Header of the next matrix; nothing at the end of the file.
    fn header(&mut self) -> Result<Option<Header>, MeshFileError> {
        match self {
            Self::Text(lines) => {
                let header = lines.find(|(_, line)| !line.trim().is_empty());
                let header = header.map(|(number, line)| {
                    Header::parsed(&line).map_err(|problem| problem.at(number, FORMAT))
                });
                header.transpose()
            }
            Self::Binary(records) => op4_binary::header(records).map_err(|problem| problem.at(0, FORMAT)),
        }
    }

    /// Reads the columns of a matrix, to the one after the last that marks its end.
    fn columns(&mut self, header: &Header, take: &mut Take<'_>) -> Result<(), MeshFileError> {
        match self {
            Self::Text(lines) => op4_columns::read(lines, header, take),
            Self::Binary(records) => {
                op4_binary::columns(records, header, take).map_err(|problem| problem.at(0, FORMAT))
            }
        }
    }
}
