//! Header of a matrix of Nastran's OUTPUT4, and the heads of the strings of its columns.

use crate::error::MeshProblem;
use crate::fields;

use super::dof::whole;
use super::fortran::Layout;
use super::raw::Triangles;

/// Name of the format.
pub(super) const FORMAT: &str = "Nastran OUTPUT4";

/// Layout of numbers where the header states none.
pub(super) const USUAL: Layout = Layout { per_line: 5, width: 16 };

/// Number of rows from which the heads of strings are in the long form in any case.
const LONG: u64 = 65_536;

/// Header of a matrix.
pub(super) struct Header {
    pub(super) name: String,
    pub(super) columns: u64,
    pub(super) rows: u64,
    form: i64,
    kind: i64,
    pub(super) layout: Layout,
    /// Whether the head of a string is its length and its row (BIGMAT), not one number of both.
    pub(super) long_heads: bool,
}

/// Part of a line from one column to before another, trimmed.
pub(super) fn part(line: &str, from: usize, to: usize) -> &str {
    line.get(from..to.min(line.len())).unwrap_or_default().trim()
}

impl Header {
    /// Parses a header: columns, rows, form and type in eight columns each, name in eight, format of the numbers.
    pub(super) fn parsed(line: &str) -> Result<Self, MeshProblem> {
        let columns = fields::integer(part(line, 0, 8), "a number of columns")?;
        let rows = whole(part(line, 8, 16), "a number of rows")?;
        let form = whole(part(line, 16, 24), "the form of a matrix")?;
        let kind = whole(part(line, 24, 32), "the type of the entries")?;
        let format = part(line, 40, line.len());
        let layout = if format.is_empty() { USUAL } else { Layout::parsed(format)? };
        let name = part(line, 32, 40).to_owned();
        Ok(Self::new(name, columns, rows, form, kind, layout))
    }

    /// Header of a matrix, whose number of rows is negative if the heads of strings are long.
    pub(super) fn new(name: String, columns: u64, rows: i64, form: i64, kind: i64, layout: Layout) -> Self {
        let long_heads = rows < 0 || rows.unsigned_abs() >= LONG;
        Self { name, columns, rows: rows.unsigned_abs(), form, kind, layout, long_heads }
    }

    /// Triangles that the file holds, of a matrix that is square, real and stored in columns.
    pub(super) fn triangles(&self) -> Result<Triangles, MeshProblem> {
        let refused = |what: String, advice| Err(MeshProblem::NotCarried { what, advice });
        if !matches!(self.kind, 1 | 2) {
            return refused(
                "a matrix of complex numbers".to_owned(),
                "export it as real: type 1 or 2, without structural damping",
            );
        }
        if self.columns != self.rows {
            return refused(
                format!("a matrix of {} rows and {} columns", self.rows, self.columns),
                "mass and stiffness matrices are square",
            );
        }
        match self.form {
            1 | 2 => Ok(Triangles::Both),
            // Nastran writes both triangles of symmetric matrices, too; other programs one.
            6 => Ok(Triangles::Unstated),
            form => refused(
                format!("a matrix of form {form}"),
                "mass and stiffness matrices are of form 6 (symmetric) or 1 (square)",
            ),
        }
    }

    /// Whether numbers are of one word, not two.
    pub(super) fn is_single(&self) -> bool {
        matches!(self.kind, 1 | 3)
    }

    /// Number of written numbers of an entry: a complex one has two.
    fn parts(&self) -> u64 {
        if matches!(self.kind, 1 | 2) { 1 } else { 2 }
    }

    /// Column from 0 of one from 1.
    pub(super) fn column(&self, column: u64) -> Result<u32, MeshProblem> {
        let index = column.checked_sub(1).and_then(|index| u32::try_from(index).ok());
        let expected = "a column of the matrix";
        index.ok_or_else(|| MeshProblem::NotA { text: column.to_string(), expected })
    }

    /// Row from 0 of one from 1, from which so many numbers fit into the matrix.
    pub(super) fn first_row(&self, row: u64, numbers: u64) -> Result<u64, MeshProblem> {
        let first = row.checked_sub(1);
        let fits =
            |first: &u64| first.checked_add(numbers / self.parts()).is_some_and(|end| end <= self.rows);
        let refused = || MeshProblem::Expected {
            expected: format!("rows 1 to {}, not {numbers} numbers from row {row} on", self.rows),
        };
        first.filter(fits).ok_or_else(refused)
    }

    /// Row of the number at a place of a run.
    pub(super) fn row(&self, first: u64, place: u64) -> Result<u32, MeshProblem> {
        let row = first + place / self.parts();
        let expected = "a row of the matrix";
        u32::try_from(row).map_err(|_| MeshProblem::NotA { text: row.to_string(), expected })
    }
}

/// Receiver of a number: line, row and column from 0.
pub(super) type Take<'a> = dyn FnMut(u64, u32, u32, Number<'_>) -> Result<(), MeshProblem> + 'a;

/// Number as a file has it.
pub(super) enum Number<'a> {
    Text(&'a str),
    Binary(f64),
}

impl Number<'_> {
    /// Value, which is finite.
    pub(super) fn value(&self) -> Result<f64, MeshProblem> {
        match self {
            Self::Text(text) => fields::real(text, "an entry"),
            Self::Binary(value) if value.is_finite() => Ok(*value),
            Self::Binary(value) => Err(MeshProblem::NotA { text: value.to_string(), expected: "an entry" }),
        }
    }
}

/// Head of a string.
pub(super) struct StringHead {
    /// Row, from 1.
    pub(super) row: u64,
    /// Words of its numbers.
    pub(super) words: u64,
    /// Words of the column that are left after the string.
    pub(super) words_left: u64,
}

/// Head of a string: length and row in two numbers (BIGMAT), or in the first alone, as 65536 times the length and the row.
pub(super) fn string_head(
    long: bool,
    first: u64,
    second: u64,
    words_left: u64,
) -> Result<StringHead, MeshProblem> {
    // A length counts one word of the head; a column counts all.
    let (length, row, head) = if long { (first, second, 2) } else { (first >> 16, first & 0xffff, 1) };
    let words = length.checked_sub(1);
    let left = words.and_then(|words| words_left.checked_sub(words.checked_add(head)?));
    let expected = "the head of a string that fits into its column";
    let refused = || MeshProblem::NotA { text: format!("{length}, {row}"), expected };
    let (words, words_left) = words.zip(left).ok_or_else(refused)?;
    Ok(StringHead { row, words, words_left })
}
