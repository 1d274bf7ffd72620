//! Untied matrices from the cyclic ones, and the order in which their interior is eliminated.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::untied::UntiedSector;
use crate::dynamics::sector::CyclicMatrix;

impl UntiedSector {
    /// Assembles Σ factor · matrix over `terms`, all symmetric, untied, both triangles.
    pub(super) fn assemble(&self, terms: &[(f64, &CyclicMatrix)]) -> SparseColMat<usize, f64> {
        let matrices: Vec<&CyclicMatrix> = terms.iter().map(|&(_, matrix)| matrix).collect();
        self.untied(&matrices, 1.0, |term, value| terms[term].0 * value)
    }

    /// Assembles the transpose of a skew-symmetric matrix, untied, both triangles.
    pub(super) fn assemble_skew_transpose(&self, matrix: &CyclicMatrix) -> SparseColMat<usize, f64> {
        self.untied(&[matrix], -1.0, |_, value| -value)
    }

    /// Assembles Σ value(matrix, entry) over `matrices`; an entry of `next` stands again at its mirror image, times `image`.
    fn untied(
        &self,
        matrices: &[&CyclicMatrix],
        image: f64,
        value: impl Fn(usize, f64) -> f64,
    ) -> SparseColMat<usize, f64> {
        let (starts, rows, values) = self.gather(matrices, image, value, |sum, value| *sum += value);
        let symbolic = SymbolicSparseColMat::new_checked(self.size(), self.size(), starts, None, rows);
        SparseColMat::new(symbolic, values)
    }

    /// Positions of the entries of any of `matrices`.
    pub(super) fn pattern(&self, matrices: &[&CyclicMatrix]) -> SymbolicSparseColMat<usize> {
        // Most exporters write the same entries at every speed.
        let mut distinct: Vec<&CyclicMatrix> = Vec::new();
        for &matrix in matrices {
            if !distinct.iter().any(|known| same_pattern(known, matrix)) {
                distinct.push(matrix);
            }
        }
        let (starts, rows, _) = self.gather(&distinct, 1.0, |_, _| (), |(), ()| ());
        SymbolicSparseColMat::new_checked(self.size(), self.size(), starts, None, rows)
    }

    /// Entries of all `matrices` by column, then row: column starts, rows, values; `value` of an entry of a matrix,
    /// and `add` for entries that fall together; `image` as in [`untied`](Self::untied).
    fn gather<T: Copy + Default + Send + Sync>(
        &self,
        matrices: &[&CyclicMatrix],
        image: f64,
        value: impl Fn(usize, f64) -> T,
        add: impl Fn(&mut T, T) + Sync,
    ) -> (Vec<usize>, Vec<usize>, Vec<T>) {
        let mut ends = vec![0usize; self.size() + 1];
        self.visit(matrices, image, |_, column, _, _| ends[column + 1] += 1);
        for column in 0..self.size() {
            ends[column + 1] += ends[column];
        }
        let starts = ends.clone();
        let mut entries = vec![(0u32, T::default()); starts[self.size()]];
        self.visit(matrices, image, |row, column, matrix, number| {
            entries[ends[column]] = (row as u32, value(matrix, number));
            ends[column] += 1;
        });
        let column = |column: usize| {
            let mut found = entries[starts[column]..starts[column + 1]].to_vec();
            found.sort_by_key(|&(row, _)| row);
            found.dedup_by(|next, kept| {
                let same = next.0 == kept.0;
                if same {
                    add(&mut kept.1, next.1);
                }
                same
            });
            // Several matrices leave room for all their entries.
            found.shrink_to_fit();
            found
        };
        let columns: Vec<Vec<(u32, T)>> = (0..self.size()).into_par_iter().map(column).collect();
        drop(entries);
        let mut starts = vec![0];
        let mut rows = Vec::new();
        let mut values = Vec::new();
        for column in columns {
            rows.extend(column.iter().map(|&(row, _)| row as usize));
            values.extend(column.iter().map(|&(_, value)| value));
            starts.push(rows.len());
        }
        (starts, rows, values)
    }

    /// Calls `entry(row, column, matrix, value)` for every untied entry of each matrix.
    fn visit(&self, matrices: &[&CyclicMatrix], image: f64, mut entry: impl FnMut(usize, usize, usize, f64)) {
        for (index, matrix) in matrices.iter().enumerate() {
            for from in matrix.own.triplet_iter() {
                entry(self.place[from.row], self.place[from.col], index, *from.val);
            }
            for from in matrix.next.triplet_iter() {
                entry(self.place[from.row], self.high[from.col], index, *from.val);
                entry(self.high[from.col], self.place[from.row], index, image * *from.val);
            }
        }
    }
}

fn same_pattern(a: &CyclicMatrix, b: &CyclicMatrix) -> bool {
    let same = |a: &SparseColMat<usize, f64>, b: &SparseColMat<usize, f64>| {
        a.symbolic().col_ptr() == b.symbolic().col_ptr() && a.symbolic().row_idx() == b.symbolic().row_idx()
    };
    same(&a.own, &b.own) && same(&a.next, &b.next)
}
