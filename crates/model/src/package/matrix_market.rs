//! Streaming reader of Matrix Market coordinate files, `symmetric` (`skew-symmetric`) and `general`, real or integer.
//!
//! Written for files of tens of millions of lines: one pass, no text held, about 16 bytes of memory per entry.

use std::io::Read;

use super::error::MatrixProblem;
use super::limits::Limits;
use super::lines::{Fault, Lines};
use super::quote::quoted;
use super::raw::RawMatrix;
use super::symmetric::{self, Entry, Mirror};

type MatrixFault = Fault<MatrixProblem>;

/// Largest number of entries for which room is reserved on the header's word; more room is made as entries really come.
const TRUSTED_ENTRIES: u64 = 1 << 22;

/// Reads a matrix of `dofs` rows; `open` starts the file anew, a second time only to find the lines of a problem.
pub(super) fn read<S: Read>(
    source: S,
    mirror: Mirror,
    dofs: usize,
    limits: &Limits,
) -> Result<Result<RawMatrix, MatrixProblem>, MatrixFault> {
    let (header, lower, upper) = read_entries(source, mirror, dofs, limits)?;
    Ok(match header.triangles {
        Triangles::One => symmetric::from_triangle(mirror, dofs, lower),
        Triangles::Both => symmetric::from_both_triangles(mirror, dofs, lower, upper),
    })
}

/// Line of an entry.
pub(super) struct EntryLine {
    pub(super) line: u64,
    /// Whether it is the mirror image of the position asked for.
    pub(super) mirrored: bool,
}

/// First two entries at (`row`, `column`), or at either mirror image; positions count from 1.
pub(super) fn places_of<S: Read>(
    source: S,
    mirror: Mirror,
    row: u64,
    column: u64,
    or_mirrored: bool,
) -> Result<Vec<EntryLine>, MatrixFault> {
    let mut lines = Lines::new(source);
    read_header(&mut lines, mirror)?;
    let mut found = Vec::new();
    while found.len() < 2
        && let Some(line) = lines.next(too_long)?
    {
        let Some((r, c, _)) = parse_entry(line) else { continue };
        let mirrored = (r, c) != (row, column);
        if !mirrored || (or_mirrored && (c, r) == (row, column)) {
            found.push(EntryLine { line: lines.number(), mirrored });
        }
    }
    Ok(found)
}

/// Triangles of the matrix that a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Triangles {
    One,
    Both,
}

struct Header {
    triangles: Triangles,
    entries: u64,
    rows: u64,
    columns: u64,
}

/// Entries folded into the lower triangle: from a file of one triangle all of them in the first list; from one of both (`general`) the
/// lower triangle with the diagonal in the first, the strict upper triangle in the second.
fn read_entries<S: Read>(
    source: S,
    mirror: Mirror,
    dofs: usize,
    limits: &Limits,
) -> Result<(Header, Vec<Entry>, Vec<Entry>), MatrixFault> {
    let mut lines = Lines::new(source);
    let header = read_header(&mut lines, mirror)?;
    let at = |line, problem| Err(Fault::At { line, problem });
    let size_line = lines.number();
    if header.rows != header.columns {
        return at(size_line, MatrixProblem::NotSquare { rows: header.rows, columns: header.columns });
    }
    if header.rows != dofs as u64 {
        return at(size_line, MatrixProblem::SizeDisagrees { rows: header.rows, dofs });
    }
    if header.entries > limits.matrix_entries as u64 {
        let problem = MatrixProblem::TooManyEntries { entries: header.entries, limit: limits.matrix_entries };
        return at(size_line, problem);
    }
    let mut lower = Vec::with_capacity(header.entries.min(TRUSTED_ENTRIES) as usize);
    let mut upper = Vec::new();
    let size = dofs as u64;
    let positions = match header.triangles {
        Triangles::One => size * (size + 1) / 2,
        Triangles::Both => size * size,
    };
    let mut found = 0_u64;
    let mut previous = None;
    while let Some(line) = lines.next(too_long)? {
        let Some((row, column, value)) = parse_entry(line) else {
            if is_blank_or_comment(line) {
                continue;
            }
            let text = quoted(&String::from_utf8_lossy(line));
            return at(lines.number(), MatrixProblem::BadEntry { text });
        };
        found += 1;
        if found > header.entries {
            return at(lines.number(), MatrixProblem::MoreEntries { announced: header.entries });
        }
        if row.wrapping_sub(1) >= size || column.wrapping_sub(1) >= size {
            return at(lines.number(), MatrixProblem::IndexOutOfRange { row, column, size: dofs });
        }
        if !value.is_finite() {
            return at(lines.number(), MatrixProblem::NotFinite { row, column });
        }
        // In range of `size`, which the row limit keeps within u32.
        let (r, c) = ((row - 1) as u32, (column - 1) as u32);
        let entry = mirror.folded(r, c, value);
        let same = |(before_r, before_c, _): (u32, u32, u64)| match header.triangles {
            Triangles::One => (before_r.max(before_c), before_r.min(before_c)) == (entry.0, entry.1),
            Triangles::Both => (before_r, before_c) == (r, c),
        };
        // A row written over and over is seen here, before it fills the memory.
        if let Some((before_r, before_c, first_line)) = previous.filter(|&before| same(before)) {
            let (row, column) = match header.triangles {
                Triangles::One => (row.max(column), row.min(column)),
                Triangles::Both => (row, column),
            };
            let mirrored = (before_r, before_c) != (r, c);
            let problem = MatrixProblem::Repeated { row, column, first_line: Some(first_line), mirrored };
            return at(lines.number(), problem);
        }
        previous = Some((r, c, lines.number()));
        if r >= c || header.triangles == Triangles::One {
            lower.push(entry);
        } else {
            upper.push(entry);
        }
        // One of more entries than there are positions is repeated: sorting what is read finds it.
        if found > positions {
            return Ok((header, lower, upper));
        }
    }
    if found < header.entries {
        return at(lines.number(), MatrixProblem::FewerEntries { found, announced: header.entries });
    }
    Ok((header, lower, upper))
}

fn read_header<S: Read>(lines: &mut Lines<S>, mirror: Mirror) -> Result<Header, MatrixFault> {
    let first = lines.next(too_long)?.unwrap_or_default();
    let triangles = parse_banner(first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first), mirror)
        .map_err(|problem| Fault::At { line: 1, problem })?;
    loop {
        let Some(line) = lines.next(too_long)? else {
            return Err(Fault::At { line: lines.number(), problem: MatrixProblem::BadSizeLine });
        };
        if is_blank_or_comment(line) {
            continue;
        }
        let sizes: Option<Vec<u64>> = words(line).map(parse_integer).collect();
        let Some(&[rows, columns, entries]) = sizes.as_deref() else {
            return Err(Fault::At { line: lines.number(), problem: MatrixProblem::BadSizeLine });
        };
        return Ok(Header { triangles, entries, rows, columns });
    }
}

fn parse_banner(line: &[u8], mirror: Mirror) -> Result<Triangles, MatrixProblem> {
    let line = String::from_utf8_lossy(line).to_ascii_lowercase();
    let mut words = line.split_ascii_whitespace();
    if words.next() != Some("%%matrixmarket") {
        return Err(MatrixProblem::NoHeader);
    }
    let one_triangle = match mirror {
        Mirror::Symmetric => "symmetric",
        Mirror::Skew => "skew-symmetric",
    };
    let mut word = |what, accepted: &[&str]| {
        let word = words.next().unwrap_or_default();
        if accepted.contains(&word) {
            return Ok(word.to_owned());
        }
        let word = quoted(word);
        Err(MatrixProblem::UnsupportedHeader { what, word, one_triangle })
    };
    word("object", &["matrix"])?;
    word("format", &["coordinate"])?;
    word("field", &["real", "integer"])?;
    let symmetry = word("symmetry", &[one_triangle, "general"])?;
    Ok(if symmetry == "general" { Triangles::Both } else { Triangles::One })
}

/// Entry of a line `row column value`; `None` if the line is anything else.
pub(super) fn parse_entry(line: &[u8]) -> Option<(u64, u64, f64)> {
    let mut words = words(line);
    let row = parse_integer(words.next()?)?;
    let column = parse_integer(words.next()?)?;
    let value = parse_real(words.next()?)?;
    words.next().is_none().then_some((row, column, value))
}

/// Words of a line, between blanks.
fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|byte| matches!(byte, b' ' | b'\t')).filter(|word| !word.is_empty())
}

fn parse_integer(word: &[u8]) -> Option<u64> {
    // 18 digits cannot overflow, and no matrix has more rows.
    if word.is_empty() || word.len() > 18 {
        return None;
    }
    word.iter().try_fold(0, |value, byte| byte.is_ascii_digit().then(|| value * 10 + u64::from(byte - b'0')))
}

/// Parses a real number; Fortran's `1.5D+03` is understood too.
fn parse_real(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| {
        let exponent = text.find(['d', 'D'])?;
        format!("{}e{}", &text[..exponent], &text[exponent + 1..]).parse().ok()
    })
}

fn is_blank_or_comment(line: &[u8]) -> bool {
    let text = line.trim_ascii_start();
    text.is_empty() || text.starts_with(b"%")
}

fn too_long(limit: usize) -> MatrixProblem {
    MatrixProblem::LineTooLong { limit }
}
