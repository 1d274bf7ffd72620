//! Matrix as a reader found it, before rows are left out and triangles folded.

use std::collections::HashMap;

use crate::error::MeshProblem;

use super::dof::Dof;

/// Matrix with the entries of its file in their order.
pub(super) struct RawMatrix {
    pub(super) dofs: Vec<Dof>,
    pub(super) entries: Vec<RawEntry>,
    pub(super) triangles: Triangles,
    /// Whether 1e36 on the diagonal marks a clamped row.
    pub(super) marks_clamped: bool,
}

/// Entry at a row and a column of [`RawMatrix::dofs`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RawEntry {
    pub(super) row: u32,
    pub(super) column: u32,
    pub(super) value: f64,
    /// Line of the file, or the last one that can be counted.
    pub(super) line: u32,
}

/// Triangles that a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Triangles {
    /// One triangle stands for both.
    One,
    /// Both triangles are written: an absent entry is zero.
    Both,
    /// Not stated by the file: both, if any position comes with its mirror image.
    Unstated,
}

impl RawEntry {
    /// Entry of a file's line.
    pub(super) fn new(row: u32, column: u32, value: f64, line: u64) -> Self {
        Self { row, column, value, line: u32::try_from(line).unwrap_or(u32::MAX) }
    }
}

/// Rows in the order in which they are met.
#[derive(Default)]
pub(super) struct Rows {
    pub(super) dofs: Vec<Dof>,
    index: HashMap<Dof, u32>,
}

impl Rows {
    /// Index of a degree of freedom, which becomes a new row if it is met for the first time.
    pub(super) fn of(&mut self, dof: Dof) -> Result<u32, MeshProblem> {
        if let Some(&row) = self.index.get(&dof) {
            return Ok(row);
        }
        let too_many = || MeshProblem::Expected { expected: "no more than 4294967295 rows".to_owned() };
        let row = u32::try_from(self.dofs.len()).map_err(|_| too_many())?;
        self.dofs.push(dof);
        self.index.insert(dof, row);
        Ok(row)
    }
}
