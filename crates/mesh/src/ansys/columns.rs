//! Columns of a block's lines, as its Fortran format states them, such as `(3i9,6e21.13e3)`.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields::quoted;
use crate::lines::Lines;

/// Most columns of a line; Ansys writes no more than 21.
const MOST: usize = 100;
/// Widest column; Ansys writes none wider than 25.
const WIDEST: usize = 100;

/// Columns of a line, in order.
pub(super) struct Columns(Vec<Column>);

/// Column of a line.
#[derive(Clone, Copy)]
struct Column {
    integer: bool,
    width: usize,
}

/// Text of a column.
#[derive(Debug, PartialEq)]
pub(super) struct Cell<'a> {
    /// Whether the column is one of integers.
    pub(super) integer: bool,
    /// Text without blanks around it.
    pub(super) text: &'a str,
}

impl Columns {
    /// Takes the format line that follows a block's command.
    pub(super) fn read(lines: &mut Lines, card: &str) -> Result<Self, MeshFileError> {
        let line = String::from_utf8_lossy(lines.expect(card, "the block's format")?);
        let not = || MeshProblem::NotA {
            text: quoted(line.trim()),
            expected: "a Fortran format of the block, such as (3i9,6e21.13e3)",
        };
        Self::parsed(&line).ok_or_else(|| not().at(lines.number(), card))
    }

    /// Columns of a format.
    fn parsed(format: &str) -> Option<Self> {
        let format = format.trim().to_lowercase();
        let mut columns = Vec::new();
        for part in format.strip_prefix('(')?.strip_suffix(')')?.split(',') {
            let letter = part.find(|c: char| !c.is_ascii_digit() && c != ' ')?;
            let (count, rest) = (part.get(..letter)?.trim(), part.get(letter..)?);
            let count: usize = if count.is_empty() { 1 } else { count.parse().ok()? };
            let kind = rest.chars().next()?;
            let digits = rest.get(kind.len_utf8()..)?.split('.').next()?.trim();
            let width: usize = digits.parse().ok()?;
            let known = matches!(kind, 'i' | 'e' | 'd' | 'f' | 'g');
            if !known || width == 0 || width > WIDEST || count > MOST - columns.len() {
                return None;
            }
            columns.extend(std::iter::repeat_n(Column { integer: kind == 'i', width }, count));
        }
        Some(Self(columns))
    }

    /// Cuts a line into cells; columns behind its end are left out.
    pub(super) fn cut<'l>(&self, line: &'l [u8]) -> impl Iterator<Item = Cell<'l>> {
        let mut rest = line.trim_ascii_end();
        self.0.iter().map_while(move |column| {
            if rest.is_empty() {
                return None;
            }
            let (cell, after) = rest.split_at_checked(column.width).unwrap_or((rest, &[]));
            rest = after;
            // Bytes that are no text are no number either.
            let text = std::str::from_utf8(cell).unwrap_or("\u{fffd}").trim();
            Some(Cell { integer: column.integer, text })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_by_widths() {
        let columns = Columns::parsed(" (2i3,2e8.2E3) ").expect("a format");
        let cells: Vec<String> =
            columns.cut(b"  1-12 1.0E+03-1.0").map(|cell| cell.text.to_owned()).collect();
        assert_eq!(cells, ["1", "-12", "1.0E+03", "-1.0"]);
        assert_eq!(columns.cut(b"").count(), 0);
        assert_eq!(
            columns.cut(b"  1   \xff\xfe").map(|cell| cell.text.to_owned()).nth(2).unwrap(),
            "\u{fffd}"
        );
    }

    #[test]
    fn other_formats_are_refused() {
        for format in
            ["", "3i9", "(3i9", "()", "(i)", "(3x9)", "(i0)", "(i101)", "(101i9)", "(99999999999999999999i9)"]
        {
            assert!(Columns::parsed(format).is_none(), "{format}");
        }
    }
}
