//! Content that an importer of any format passes to the checks.

use super::raw::RawPackage;

/// Content of a package as its files state it, the lines of its table rows, and its content address.
#[derive(Debug)]
pub(super) struct Content {
    pub(super) package: RawPackage,
    pub(super) lines: SourceLines,
    pub(super) digest: String,
}

/// Lines on which the rows of the tables stand. Empty for a package that never was a file: row k then counts as line k + 1, where
/// [`write`](super::write()) would put it.
#[derive(Debug, Default)]
pub(super) struct SourceLines {
    pub(super) nodes: Vec<u64>,
    pub(super) dofs: Vec<u64>,
    pub(super) elements: Vec<u64>,
}

impl SourceLines {
    pub(super) fn of_node(&self, row: usize) -> u64 {
        self.nodes.get(row).copied().unwrap_or(row as u64 + 1)
    }

    pub(super) fn of_element(&self, row: usize) -> u64 {
        self.elements.get(row).copied().unwrap_or(row as u64 + 1)
    }

    pub(super) fn of_dof(&self, row: usize) -> u64 {
        self.dofs.get(row).copied().unwrap_or(row as u64 + 1)
    }
}
