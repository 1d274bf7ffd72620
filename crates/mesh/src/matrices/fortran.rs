//! Numbers in columns of equal width, as a format of Fortran describes them.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use crate::lines::Lines;

/// Widest field that is read.
const WIDEST: usize = 100;

/// Layout of the lines: `3D26.18` is three fields of 26 columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) per_line: usize,
    pub(super) width: usize,
}

impl Layout {
    /// Parses a format of one kind of number, such as `(10I8)`, `(1P,3E25.16)` or `(E20.12)`.
    pub(super) fn parsed(format: &str) -> Result<Self, MeshProblem> {
        let text: String =
            format.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_ascii_uppercase();
        let inner = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')).unwrap_or(&text);
        let refused =
            || MeshProblem::NotA { text: fields::quoted(format), expected: "a format such as (10I8)" };
        Self::of(inner).ok_or_else(refused)
    }

    fn of(text: &str) -> Option<Self> {
        let text = match text.split_once('P') {
            Some((scale, rest)) if scale.parse::<i32>().is_ok() => rest.trim_start_matches(','),
            _ => text,
        };
        let kind = text.find(|c: char| !c.is_ascii_digit())?;
        let (count, rest) = text.split_at_checked(kind)?;
        let rest = ["ES", "EN", "I", "E", "D", "F", "G"].iter().find_map(|kind| rest.strip_prefix(kind))?;
        let per_line = if count.is_empty() { 1 } else { count.parse().ok()? };
        let width: usize = rest.split('.').next()?.parse().ok()?;
        ((1..=WIDEST).contains(&width) && per_line > 0).then_some(Self { per_line, width })
    }
}

/// Calls `take` with the line and the text of each of the next `count` fields, which begin on a new line.
pub(super) fn each_field(
    lines: &mut Lines<'_>,
    layout: Layout,
    count: u64,
    place: &str,
    mut take: impl FnMut(u64, &str) -> Result<(), MeshProblem>,
) -> Result<(), MeshFileError> {
    let mut left = count;
    while left > 0 {
        let Some((number, line)) = lines.next() else {
            let expected = format!("{left} more numbers");
            return Err(MeshProblem::CutShort { expected }.at(lines.number(), place));
        };
        let line = line.trim_end();
        let mut from = 0;
        for _ in 0..layout.per_line {
            if left == 0 || from >= line.len() {
                break;
            }
            let to = (from + layout.width).min(line.len());
            let field = line.get(from..to).map(str::trim).unwrap_or("\u{fffd}");
            take(number, field).map_err(|problem| problem.at(number, place))?;
            (from, left) = (to, left - 1);
        }
        if from == 0 {
            let expected = format!("{left} more numbers in columns of {}", layout.width);
            return Err(MeshProblem::Expected { expected }.at(number, place));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Layout, each_field};
    use crate::lines::Lines;

    #[test]
    fn formats() {
        for (text, per_line, width) in [
            ("(10I8)", 10, 8),
            ("(3D26.18)", 3, 26),
            ("(I14)", 1, 14),
            ("1P,3E23.16", 3, 23),
            ("(1P 5E16.8)", 5, 16),
            ("(4es20.12E3)", 4, 20),
        ] {
            assert_eq!(Layout::parsed(text).ok(), Some(Layout { per_line, width }), "{text}");
        }
        for text in ["", "(", "(10A8)", "(0I8)", "(3I)", "(99999999999999999999I8)", "(I0)", "(4(I8))", "é"]
        {
            assert!(Layout::parsed(text).is_err(), "{text}");
        }
    }

    #[test]
    fn fields_that_touch() {
        let mut found = Vec::new();
        let layout = Layout { per_line: 2, width: 4 };
        each_field(&mut Lines::new(b"1234-123\n 5\n"), layout, 3, "", |line, field| {
            found.push((line, field.to_owned()));
            Ok(())
        })
        .unwrap();
        assert_eq!(found, [(1, "1234".to_owned()), (1, "-123".to_owned()), (2, "5".to_owned())]);
    }
}
