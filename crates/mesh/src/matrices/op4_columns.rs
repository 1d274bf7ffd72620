//! Columns of a matrix of Nastran's OUTPUT4 in text form: whole ones, or strings of rows.

use std::borrow::Cow;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::fortran::each_field;
use super::op4_header::{FORMAT, Header, Number, Take, part, string_head};
use crate::lines::Lines;

/// Reads the columns of a matrix, to the one after the last that marks its end.
pub(super) fn read(lines: &mut Lines<'_>, header: &Header, take: &mut Take<'_>) -> Result<(), MeshFileError> {
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
        let column = header.column(column).map_err(|problem| problem.at(number, FORMAT))?;
        if row > 0 {
            run(lines, header, (row, column), count, take)?;
        } else {
            strings(lines, header, column, count, take)?;
        }
    }
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
        let head = || {
            if header.long_heads {
                string_head(true, integer(part(&line, 0, 8))?, integer(part(&line, 8, 16))?, left)
            } else {
                string_head(false, integer(&line)?, 0, left)
            }
        };
        let head = head().map_err(|problem| problem.at(number, FORMAT))?;
        left = head.words_left;
        let numbers = if header.is_single() { head.words } else { head.words / 2 };
        run(lines, header, (head.row, column), numbers, take)?;
    }
    Ok(())
}

/// Reads so many numbers from a row of a column on.
fn run(
    lines: &mut Lines<'_>,
    header: &Header,
    (row, column): (u64, u32),
    numbers: u64,
    take: &mut Take<'_>,
) -> Result<(), MeshFileError> {
    let first = header.first_row(row, numbers).map_err(|problem| problem.at(lines.number(), FORMAT))?;
    let mut places = 0..;
    each_field(lines, header.layout, numbers, FORMAT, |line, field| {
        let place = places.next().unwrap_or_default();
        take(line, header.row(first, place)?, column, Number::Text(field))
    })
}

/// Next line.
fn next<'a>(lines: &mut Lines<'a>, expected: &str) -> Result<(u64, Cow<'a, str>), MeshFileError> {
    let cut = MeshProblem::CutShort { expected: expected.to_owned() };
    let number = lines.number();
    lines.next().ok_or_else(|| cut.at(number, FORMAT))
}
