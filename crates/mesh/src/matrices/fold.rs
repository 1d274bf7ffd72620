//! Fold of the triangles of a matrix into the lower one.

use crate::error::{MeshFileError, MeshProblem};

use super::dof::Dof;
use super::file_matrix::MatrixRow;
use super::raw::{RawEntry, Triangles};

/// Largest difference of mirrored entries, by the largest entry: above what printing in twelve digits leaves, below what a model means.
const SYMMETRY: f64 = 1e-10;

/// Lower triangle, each position once, sorted by column then row, without zeros.
pub(super) fn lower(
    rows: &[MatrixRow],
    mut entries: Vec<RawEntry>,
    triangles: Triangles,
    format: &str,
) -> Result<Vec<(u32, u32, f64)>, MeshFileError> {
    entries.sort_unstable_by_key(|e| (e.row.min(e.column), e.row.max(e.column), e.row < e.column, e.line));
    let same = |a: &RawEntry, b: &RawEntry| (a.row, a.column) == (b.row, b.column);
    if let Some([_, second]) = entries.array_windows().find(|[a, b]| same(a, b)) {
        let (row, column) = (name(rows, second.row), name(rows, second.column));
        return Err(MeshProblem::EntryTwice { row, column }.at(u64::from(second.line), format));
    }
    let mirrored = |a: &RawEntry, b: &RawEntry| (a.row, a.column) == (b.column, b.row);
    let both = match triangles {
        Triangles::One => false,
        Triangles::Both => true,
        Triangles::Unstated => entries.array_windows().any(|[a, b]| mirrored(a, b)),
    };
    let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.value.abs()));
    let mut folded = Vec::with_capacity(entries.len());
    for group in entries.chunk_by(mirrored) {
        let Some(&first) = group.first() else { continue };
        let other = match group.get(1) {
            Some(second) => second.value,
            None if both && first.row != first.column => 0.0,
            None => first.value,
        };
        if (first.value - other).abs() > SYMMETRY * largest {
            let (row, column) = (name(rows, first.row), name(rows, first.column));
            let problem = MeshProblem::NotSymmetric { row, column, value: first.value, mirrored: other };
            return Err(problem.at(u64::from(group.last().unwrap_or(&first).line), format));
        }
        // Halves first: a sum of two finite numbers may not be finite.
        let value = 0.5 * first.value + 0.5 * other;
        if value != 0.0 {
            folded.push((first.row.max(first.column), first.row.min(first.column), value));
        }
    }
    Ok(folded)
}

/// Name of a row in a refusal.
fn name(rows: &[MatrixRow], row: u32) -> String {
    let row = rows.get(row as usize);
    row.map(|row| {
        Dof { node: i64::try_from(row.node).unwrap_or(i64::MAX), component: row.component }.to_string()
    })
    .unwrap_or_default()
}
