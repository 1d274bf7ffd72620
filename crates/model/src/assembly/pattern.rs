//! Pattern of coupled degrees of freedom: the sparsity shared by all matrices of one mesh.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use rayon::prelude::*;
use rubmap_solid::mesh::Element;

use crate::package::raw::RawMatrix;

/// Lower triangle by columns, rows ascending, with every pair of DOF that share an element.
#[derive(Debug, Clone)]
pub(super) struct Pattern {
    /// Start of each column in `rows`, and the end of the last.
    starts: Vec<usize>,
    /// Row indices, column after column.
    rows: Vec<u32>,
}

impl Pattern {
    /// Pattern of `elements` whose nodes have the displacements `numbering`, of `size` rows in all.
    ///
    /// The rows of one node are consecutive; nodes that are tied together share theirs.
    pub(super) fn new(elements: &[Element], numbering: &[[Option<usize>; 3]], size: usize) -> Self {
        // A node is known by its first row.
        let first_row = |&node: &u32| numbering[node as usize].iter().flatten().next().copied();
        let mut members = vec![0; size];
        for rows in numbering {
            let mut free = rows.iter().flatten();
            if let Some(&first) = free.next() {
                members[first] = 1 + free.count();
            }
        }
        let mut below = vec![Vec::new(); size];
        for element in elements {
            for column in element.nodes.iter().filter_map(first_row) {
                below[column].extend(element.nodes.iter().filter_map(first_row).filter(|&row| row > column));
            }
        }
        below.par_iter_mut().for_each(|rows| {
            rows.sort_unstable();
            rows.dedup();
        });
        let mut starts = vec![0];
        let mut rows = Vec::new();
        for first in (0..size).filter(|&first| members[first] > 0) {
            for column in first..first + members[first] {
                rows.extend((column..first + members[first]).map(|row| row as u32));
                for &other in &below[first] {
                    rows.extend((other..other + members[other]).map(|row| row as u32));
                }
                starts.push(rows.len());
            }
        }
        Self { starts, rows }
    }

    /// Number of rows and columns.
    pub(super) fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of positions.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Row indices of a column, and the position of the first.
    pub(super) fn column(&self, column: usize) -> (&[u32], usize) {
        let start = self.starts[column];
        (&self.rows[start..self.starts[column + 1]], start)
    }

    /// Matrix with `value(p)` at position p, as in a package.
    pub(super) fn raw_matrix(&self, value: impl Fn(usize) -> f64) -> RawMatrix {
        let mut entries = Vec::with_capacity(self.len());
        for column in 0..self.size() {
            for position in self.starts[column]..self.starts[column + 1] {
                entries.push((self.rows[position], column as u32, value(position)));
            }
        }
        RawMatrix { size: self.size(), entries }
    }

    /// Lower triangle with `values` at its positions, for a solver.
    pub(super) fn into_lower_triangle(self, values: Vec<f64>) -> SparseColMat<usize, f64> {
        let size = self.size();
        let rows = self.rows.into_iter().map(|row| row as usize).collect();
        SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, self.starts, None, rows), values)
    }
}
