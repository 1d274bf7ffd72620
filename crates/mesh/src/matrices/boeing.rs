//! Matrices in the Harwell–Boeing format, as HBMAT of Ansys writes them in text form.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::fortran::{Layout, each_field};
use super::mapping;
use super::raw::{RawEntry, RawMatrix, Triangles};
use crate::lines::Lines;

/// Name of the format.
pub(super) const FORMAT: &str = "Harwell-Boeing matrix";

/// Content of the header.
struct Header {
    triangles: Triangles,
    size: u64,
    entries: u64,
    pointers: Layout,
    indices: Layout,
    values: Layout,
}

/// Reads the matrix with the mapping of its rows.
pub(super) fn read(bytes: &[u8], mapping: &[u8]) -> Result<RawMatrix, MeshFileError> {
    let mut lines = Lines::new(bytes);
    let header = header(&mut lines)?;
    let dofs = mapping::of_size(mapping, header.size)?;
    let starts = starts(&mut lines, &header)?;
    let mut rows: Vec<u32> = Vec::new();
    each_field(&mut lines, header.indices, header.entries, FORMAT, |_, field| {
        let row = fields::integer(field, "a row number")?.checked_sub(1).filter(|row| *row < header.size);
        let row = row.and_then(|row| u32::try_from(row).ok());
        let expected = "a row of the matrix";
        rows.push(row.ok_or_else(|| MeshProblem::NotA { text: fields::quoted(field), expected })?);
        Ok(())
    })?;
    let mut entries = Vec::new();
    let mut rows = rows.into_iter();
    let mut column = 0_u32;
    // Number of the entry as pointers count it, and of the first one of the next column.
    let mut next = 1;
    let mut ends = starts.into_iter().skip(1).peekable();
    each_field(&mut lines, header.values, header.entries, FORMAT, |line, field| {
        while ends.next_if(|end| *end <= next).is_some() {
            column += 1;
        }
        next += 1;
        if let Some(row) = rows.next() {
            entries.push(RawEntry::new(row, column, fields::real(field, "an entry")?, line));
        }
        Ok(())
    })?;
    Ok(RawMatrix { dofs, entries, triangles: header.triangles, marks_clamped: false })
}

/// Number of the first entry of each column, and of the one after the last.
fn starts(lines: &mut Lines<'_>, header: &Header) -> Result<Vec<u64>, MeshFileError> {
    let mut starts: Vec<u64> = Vec::new();
    let expected = "a pointer to the first entry of a column, which never decreases";
    each_field(lines, header.pointers, header.size.saturating_add(1), FORMAT, |_, field| {
        let start = fields::integer(field, expected)?;
        if start < starts.last().copied().unwrap_or(1) || (starts.is_empty() && start != 1) {
            return Err(MeshProblem::NotA { text: fields::quoted(field), expected });
        }
        starts.push(start);
        Ok(())
    })?;
    if starts.last().is_some_and(|last| last.checked_sub(1) != Some(header.entries)) {
        let expected = format!("a last pointer to entry {} + 1", header.entries);
        return Err(MeshProblem::Expected { expected }.at(lines.number(), FORMAT));
    }
    Ok(starts)
}

/// Reads the header: title, numbers of lines, type and size, formats, and a line on right sides if there are any.
fn header(lines: &mut Lines<'_>) -> Result<Header, MeshFileError> {
    let mut next = |expected: &str| {
        let cut = MeshProblem::CutShort { expected: expected.to_owned() };
        lines.next().ok_or_else(|| cut.at(0, FORMAT))
    };
    next("a title")?;
    let (_, counts) = next("the numbers of lines")?;
    let right_sides = counts.split_whitespace().nth(4).is_some_and(|word| word != "0");
    let (number, kind) = next("the type of the matrix")?;
    let (triangles, size, entries) = kind_and_size(&kind).map_err(|problem| problem.at(number, FORMAT))?;
    let (number, formats) = next("the formats")?;
    let layouts = layouts(&formats).map_err(|problem| problem.at(number, FORMAT))?;
    let [pointers, indices, values] = layouts;
    if right_sides {
        next("the kind of the right sides")?;
    }
    Ok(Header { triangles, size, entries, pointers, indices, values })
}

/// Triangles, number of rows and number of entries, from the line of the type.
fn kind_and_size(line: &str) -> Result<(Triangles, u64, u64), MeshProblem> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let &[kind, rows, columns, entries, ..] = words.as_slice() else {
        return Err(MeshProblem::Expected { expected: "type, rows, columns and entries".to_owned() });
    };
    let triangles = match kind.to_ascii_uppercase().as_str() {
        "RSA" => Triangles::One,
        "RUA" => Triangles::Both,
        _ => {
            let what = format!("a matrix of type {}", fields::quoted(kind));
            let advice = "mass and stiffness matrices are RSA (real, symmetric, assembled) or RUA";
            return Err(MeshProblem::NotCarried { what, advice });
        }
    };
    let rows = fields::integer(rows, "a number of rows")?;
    if fields::integer(columns, "a number of columns")? != rows {
        return Err(MeshProblem::Expected { expected: format!("as many columns as rows, {rows}") });
    }
    Ok((triangles, rows, fields::integer(entries, "a number of entries")?))
}

/// Layouts of pointers, row numbers and values.
fn layouts(line: &str) -> Result<[Layout; 3], MeshProblem> {
    let mut formats = line.split_inclusive(')');
    let mut next = || Layout::parsed(formats.next().unwrap_or_default());
    Ok([next()?, next()?, next()?])
}
