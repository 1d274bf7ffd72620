//! Matrices of Nastran's OUTPUT4 in binary form, of little-endian machines with integers of four bytes.

use crate::error::MeshProblem;

use super::op4_header::{Header, Number, Take, USUAL, string_head};

/// Length of the record of a header, which stands before it and after it.
const HEADER: u32 = 24;

/// Whether a file begins like one in binary form.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(&HEADER.to_le_bytes())
}

/// Records of a Fortran program: bytes between their length, written twice.
pub(super) struct Records<'a> {
    rest: &'a [u8],
}

impl<'a> Records<'a> {
    /// Records from the beginning of a file.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Next record, without its lengths.
    fn next(&mut self) -> Result<&'a [u8], MeshProblem> {
        let mut rest = self.rest;
        let length = taken_integer(&mut rest)?;
        let record = taken(&mut rest, u64::from(length))?;
        if taken_integer(&mut rest)? != length {
            return Err(MeshProblem::Expected {
                expected: "the length of a record again at its end".to_owned(),
            });
        }
        self.rest = rest;
        Ok(record)
    }
}

/// Takes `length` bytes.
fn taken<'a>(bytes: &mut &'a [u8], length: u64) -> Result<&'a [u8], MeshProblem> {
    let split = usize::try_from(length).ok().and_then(|length| bytes.split_at_checked(length));
    let cut = || MeshProblem::CutShort { expected: format!("{length} more bytes") };
    let (first, rest) = split.ok_or_else(cut)?;
    *bytes = rest;
    Ok(first)
}

/// Takes an integer of four bytes.
fn taken_integer(bytes: &mut &[u8]) -> Result<u32, MeshProblem> {
    let four = taken(bytes, 4)?;
    Ok(four.iter().rev().fold(0, |number, &byte| (number << 8) | u32::from(byte)))
}

/// Header of the next matrix; nothing at the end of the file.
pub(super) fn header(records: &mut Records<'_>) -> Result<Option<Header>, MeshProblem> {
    if records.rest.is_empty() {
        return Ok(None);
    }
    let mut record = records.next()?;
    let columns = taken_integer(&mut record)?;
    // BIGMAT shows in a negative number of rows.
    let rows = i64::from(taken_integer(&mut record)?.cast_signed());
    let form = i64::from(taken_integer(&mut record)?);
    let kind = i64::from(taken_integer(&mut record)?);
    let name = String::from_utf8_lossy(taken(&mut record, 8)?);
    let name = name.trim_matches(['\0', ' ']).to_owned();
    Ok(Some(Header::new(name, u64::from(columns), rows, form, kind, USUAL)))
}

/// Reads the columns of a matrix, to the one after the last that marks its end.
pub(super) fn columns(
    records: &mut Records<'_>,
    header: &Header,
    take: &mut Take<'_>,
) -> Result<(), MeshProblem> {
    loop {
        let mut record = records.next()?;
        let column = u64::from(taken_integer(&mut record)?);
        let row = u64::from(taken_integer(&mut record)?);
        let words = u64::from(taken_integer(&mut record)?);
        if column > header.columns {
            return Ok(());
        }
        let column = header.column(column)?;
        if row > 0 {
            run(&mut record, header, (row, column), words, take)?;
            continue;
        }
        let mut left = words;
        while left > 0 {
            let first = u64::from(taken_integer(&mut record)?);
            let second = if header.long_heads { u64::from(taken_integer(&mut record)?) } else { 0 };
            let head = string_head(header.long_heads, first, second, left)?;
            left = head.words_left;
            run(&mut record, header, (head.row, column), head.words, take)?;
        }
    }
}

/// Reads numbers of so many words from a row of a column on.
fn run(
    record: &mut &[u8],
    header: &Header,
    (row, column): (u64, u32),
    words: u64,
    take: &mut Take<'_>,
) -> Result<(), MeshProblem> {
    let bytes = taken(record, words.saturating_mul(4))?;
    let size = if header.is_single() { 4 } else { 8 };
    let numbers = bytes.chunks_exact(size);
    let first = header.first_row(row, numbers.len() as u64)?;
    for (mut number, place) in numbers.zip(0_u64..) {
        let low = taken_integer(&mut number)?;
        let value = if header.is_single() {
            f64::from(f32::from_bits(low))
        } else {
            f64::from_bits((u64::from(taken_integer(&mut number)?) << 32) | u64::from(low))
        };
        take(0, header.row(first, place)?, column, Number::Binary(value))?;
    }
    Ok(())
}
