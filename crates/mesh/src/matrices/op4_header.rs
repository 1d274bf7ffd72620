//! Header of a matrix of Nastran's OUTPUT4 in text form.

use crate::error::MeshProblem;
use crate::fields;

use super::dof::whole;
use super::fortran::Layout;
use super::raw::Triangles;

/// Name of the format.
pub(super) const FORMAT: &str = "Nastran OUTPUT4";

/// Layout of numbers where the header tells none.
const USUAL: Layout = Layout { per_line: 5, width: 16 };

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
        let long_heads = rows < 0 || rows.unsigned_abs() >= LONG;
        let name = part(line, 32, 40).to_owned();
        Ok(Self { name, columns, rows: rows.unsigned_abs(), form, kind, layout, long_heads })
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
            6 => Ok(Triangles::Untold),
            form => refused(
                format!("a matrix of form {form}"),
                "mass and stiffness matrices are of form 6 (symmetric) or 1 (square)",
            ),
        }
    }

    /// Number of words that an entry counts in the heads of strings.
    pub(super) fn words(&self) -> u64 {
        // Numbers of double precision are two words, complex ones twice as many.
        match self.kind {
            1 => 1,
            2 | 3 => 2,
            _ => 4,
        }
    }

    /// Number of written numbers of an entry.
    pub(super) fn parts(&self) -> u64 {
        if matches!(self.kind, 1 | 2) { 1 } else { 2 }
    }
}
