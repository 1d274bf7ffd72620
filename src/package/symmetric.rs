//! From a list of entries to a symmetric matrix: sorted, each position once, both triangles equal.

use rayon::slice::ParallelSliceMut;

use super::error::MatrixProblem;
use super::raw::RawMatrix;

/// `(row, column, value)`, 0-based, row ≥ column.
pub(super) type Entry = (u32, u32, f64);

/// Two mirrored entries may differ by this much of the larger: exports are rounded to seven digits at worst.
const MIRROR_TOLERANCE: f64 = 1e-6;

/// … or by this much of the geometric mean of their diagonals: entries that cancel to nearly zero in assembly.
const CANCELLATION_TOLERANCE: f64 = 1e-12;

/// A matrix from entries of which each position appears once, folded into the lower triangle.
pub(super) fn from_triangle(size: usize, mut entries: Vec<Entry>) -> Result<RawMatrix, MatrixProblem> {
    sort(&mut entries);
    // Folding has lost which triangle each of two equal positions came from; off the diagonal it may be the other.
    check_unique(&entries, true)?;
    Ok(RawMatrix { size, entries })
}

/// A matrix from its lower triangle with the diagonal, and the mirror image of its strict upper triangle.
///
/// A pair within tolerance becomes its mean; equal values keep their bits.
pub(super) fn from_both_triangles(
    size: usize,
    mut lower: Vec<Entry>,
    mut upper: Vec<Entry>,
) -> Result<RawMatrix, MatrixProblem> {
    sort(&mut lower);
    sort(&mut upper);
    check_unique(&lower, false)?;
    check_unique(&upper, false).map_err(mirror)?;
    let mut diagonal = vec![0.0; size];
    for &(row, column, value) in lower.iter().filter(|entry| entry.0 == entry.1) {
        debug_assert_eq!(row, column);
        diagonal[row as usize] = f64::abs(value);
    }
    let mut entries = Vec::with_capacity(lower.len());
    let mut worst: Option<(f64, Entry, f64)> = None;
    let mut count = 0;
    let mut pair = |row: u32, column: u32, below: f64, above: f64| {
        let difference = (below - above).abs();
        let scale = (diagonal[row as usize].sqrt()) * (diagonal[column as usize].sqrt());
        let tolerance = (MIRROR_TOLERANCE * below.abs().max(above.abs())).max(CANCELLATION_TOLERANCE * scale);
        // Not finite (overflow of the difference) is worse than any number.
        if difference > tolerance || !difference.is_finite() {
            count += 1;
            if worst.is_none_or(|(largest, ..)| difference > largest) {
                worst = Some((difference, (row, column, below), above));
            }
        }
        entries.push((row, column, if below == above { below } else { 0.5 * below + 0.5 * above }));
    };
    let mut above = upper.iter().copied().peekable();
    for (row, column, value) in lower {
        while let Some((r, c, v)) = above.next_if(|&(r, c, _)| key(r, c) < key(row, column)) {
            pair(r, c, 0.0, v);
        }
        if row == column {
            pair(row, column, value, value);
        } else {
            let mirrored = above.next_if(|&(r, c, _)| (r, c) == (row, column)).map_or(0.0, |(_, _, v)| v);
            pair(row, column, value, mirrored);
        }
    }
    above.for_each(|(row, column, value)| pair(row, column, 0.0, value));
    if let Some((_, (row, column, value), mirrored)) = worst {
        let (row, column) = (u64::from(row) + 1, u64::from(column) + 1);
        return Err(MatrixProblem::NotSymmetric {
            row,
            column,
            value,
            mirrored,
            line: None,
            mirrored_line: None,
            count,
        });
    }
    Ok(RawMatrix { size, entries })
}

/// A matrix from stored entries of unstated symmetry, positions repeated or not: repeated ones are summed.
///
/// `lower` has the lower triangle with the diagonal, `upper` the mirror image of the strict upper one. If only one of
/// the two has an entry that is not zero, the matrix is that triangle and its mirror image; if both have, they must
/// agree; if neither has, the matrix is diagonal and both readings are the same.
pub(super) fn from_any(
    size: usize,
    lower: Vec<Entry>,
    mut upper: Vec<Entry>,
) -> Result<RawMatrix, MatrixProblem> {
    let mut lower = summed(lower);
    let off_diagonal = |entry: &Entry| entry.0 != entry.1;
    let below = lower.iter().any(|entry| off_diagonal(entry) && entry.2 != 0.0);
    let above = upper.iter().any(|entry| entry.2 != 0.0);
    if below && above {
        return from_both_triangles(size, lower, summed(upper));
    }
    if above {
        // Zeros stored in the empty triangle mean nothing.
        lower.retain(|entry| !off_diagonal(entry));
        lower.append(&mut upper);
        lower = summed(lower);
    }
    from_triangle(size, lower)
}

/// Entries sorted, those of equal positions summed in the order given.
fn summed(mut entries: Vec<Entry>) -> Vec<Entry> {
    sort(&mut entries);
    entries.dedup_by(|next, first| {
        let same = (first.0, first.1) == (next.0, next.1);
        if same {
            first.2 += next.2;
        }
        same
    });
    entries
}

/// By column, then row: the order of compressed columns, and of most files.
fn sort(entries: &mut [Entry]) {
    if !entries.is_sorted_by_key(|&(row, column, _)| key(row, column)) {
        // Stable, so that the first of two equal positions stays first.
        entries.par_sort_by_key(|&(row, column, _)| key(row, column));
    }
}

fn key(row: u32, column: u32) -> u64 {
    u64::from(column) << 32 | u64::from(row)
}

fn check_unique(entries: &[Entry], folded: bool) -> Result<(), MatrixProblem> {
    match entries.windows(2).find(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1)) {
        None => Ok(()),
        Some(pair) => Err(MatrixProblem::Repeated {
            row: u64::from(pair[0].0) + 1,
            column: u64::from(pair[0].1) + 1,
            first_line: None,
            mirrored: folded && pair[0].0 != pair[0].1,
        }),
    }
}

fn mirror(problem: MatrixProblem) -> MatrixProblem {
    match problem {
        MatrixProblem::Repeated { row, column, first_line, mirrored } => {
            MatrixProblem::Repeated { row: column, column: row, first_line, mirrored }
        }
        problem => problem,
    }
}
