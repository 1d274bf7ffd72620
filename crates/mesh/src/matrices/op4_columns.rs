//! Columns of a matrix of Nastran's OUTPUT4 in text form: whole ones, or strings of rows.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::fortran::each_field;
use super::lines::Lines;
use super::op4_header::{FORMAT, Header, part};

/// Receiver of an entry: line, row and column from 0, and text.
type Take<'a> = dyn FnMut(u64, u32, u32, &str) -> Result<(), MeshProblem> + 'a;

/// Reads the columns of a matrix, to the one after the last that marks its end.
pub(super) fn read(
    lines: &mut Lines<'_>,
    header: &Header,
    mut take: impl FnMut(u64, u32, u32, &str) -> Result<(), MeshProblem>,
) -> Result<(), MeshFileError> {
    loop {
        let (number, line) = next(lines, "a column")?;
        let field = |index: usize, expected| {
            fields::integer(part(&line, 8 * index, 8 * index + 8), expected)
                .map_err(|problem| problem.at(number, FORMAT))
        };
        let column = field(0, "the number of a column")?;
        let row = field(1, "the number of a row")?;
        let count = field(2, "a number of words")?;
        if column > header.columns {
            return each_field(lines, header.layout, count, FORMAT, |_, _| Ok(()));
        }
        let index = column.checked_sub(1).and_then(|index| u32::try_from(index).ok());
        let refused = || MeshProblem::NotA { text: column.to_string(), expected: "a column of the matrix" };
        let index = index.ok_or_else(|| refused().at(number, FORMAT))?;
        if row > 0 {
            run(lines, header, Run { row, column: index, numbers: count }, &mut take)?;
        } else {
            strings(lines, header, index, count, &mut take)?;
        }
    }
}

/// Run of numbers down a column.
struct Run {
    /// First row, from 1.
    row: u64,
    /// Column, from 0.
    column: u32,
    numbers: u64,
}

/// Reads the strings of a column, each with its head, until `words` are used up.
fn strings(
    lines: &mut Lines<'_>,
    header: &Header,
    column: u32,
    words: u64,
    take: &mut Take<'_>,
) -> Result<(), MeshFileError> {
    let mut left = words;
    while left > 0 {
        let (number, line) = next(lines, "a string of entries")?;
        let integer = |text| fields::integer(text, "the head of a string of entries");
        let head = if header.long_heads {
            integer(part(&line, 0, 8))
                .and_then(|length| Ok((length.checked_sub(1), integer(part(&line, 8, 16))?)))
        } else {
            integer(&line).map(|both| ((both >> 16).checked_sub(1), both & 0xffff))
        };
        let (length, row) = head.map_err(|problem| problem.at(number, FORMAT))?;
        let length_of_head = if header.long_heads { 2 } else { 1 };
        let rest = length.and_then(|length| left.checked_sub(length.checked_add(length_of_head)?));
        let (Some(length), Some(rest)) = (length, rest) else {
            let expected = "the head of a string that fits into its column";
            let problem = MeshProblem::NotA { text: fields::quoted(line.trim()), expected };
            return Err(problem.at(number, FORMAT));
        };
        left = rest;
        let numbers = length / header.words() * header.parts();
        run(lines, header, Run { row, column, numbers }, take)?;
    }
    Ok(())
}

/// Reads a run of numbers.
fn run(lines: &mut Lines<'_>, header: &Header, run: Run, take: &mut Take<'_>) -> Result<(), MeshFileError> {
    let first = run.row.checked_sub(1);
    let end = first.and_then(|first| first.checked_add(run.numbers / header.parts()));
    let (Some(first), true) = (first, end.is_some_and(|end| end <= header.rows)) else {
        let expected =
            format!("rows 1 to {}, not {} numbers from row {} on", header.rows, run.numbers, run.row);
        return Err(MeshProblem::Expected { expected }.at(lines.number(), FORMAT));
    };
    let mut place = 0;
    each_field(lines, header.layout, run.numbers, FORMAT, |line, field| {
        let row = first + place / header.parts();
        place += 1;
        let too_many = || MeshProblem::NotA { text: row.to_string(), expected: "a row of the matrix" };
        take(line, u32::try_from(row).map_err(|_| too_many())?, run.column, field)
    })
}

/// Next line.
fn next<'a>(
    lines: &mut Lines<'a>,
    expected: &str,
) -> Result<(u64, std::borrow::Cow<'a, str>), MeshFileError> {
    let cut = MeshProblem::CutShort { expected: expected.to_owned() };
    let number = lines.number();
    lines.next().ok_or_else(|| cut.at(number, FORMAT))
}
