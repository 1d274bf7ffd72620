//! Conversion of a list of entries to a symmetric or skew-symmetric matrix: sorted, each position once, the triangles mirror images.

use rayon::slice::ParallelSliceMut;

use super::error::MatrixProblem;
use super::raw::RawMatrix;

/// Entry `(row, column, value)`, 0-based, row ≥ column.
pub(super) type Entry = (u32, u32, f64);

/// Largest difference of two mirrored entries, relative to the larger one: exports are rounded to seven digits at worst.
const MIRROR_TOLERANCE: f64 = 1e-6;

/// Largest difference of two mirrored entries, relative to the geometric mean of their diagonals, or to the largest entry where the
/// diagonal is zero: for entries that cancel to nearly zero in assembly.
const CANCELLATION_TOLERANCE: f64 = 1e-12;

/// Relation between the two triangles of a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mirror {
    /// Symmetric matrix, Aᵀ = A.
    Symmetric,
    /// Skew-symmetric matrix, Aᵀ = −A.
    Skew,
}

impl Mirror {
    /// Value at (column, row) for `value` at (row, column).
    pub(super) fn image(self, value: f64) -> f64 {
        match self {
            Self::Symmetric => value,
            // Not −value: an absent entry has an absent image, not −0.
            Self::Skew => 0.0 - value,
        }
    }

    /// Folds an entry of any triangle into the lower triangle.
    pub(super) fn folded(self, row: u32, column: u32, value: f64) -> Entry {
        if row >= column { (row, column, value) } else { (column, row, self.image(value)) }
    }
}

/// Makes a matrix from entries of which each position appears once, folded into the lower triangle.
pub(super) fn from_triangle(
    mirror: Mirror,
    size: usize,
    mut entries: Vec<Entry>,
) -> Result<RawMatrix, MatrixProblem> {
    sort(&mut entries);
    // Folding has lost which triangle each of two equal positions came from; off the diagonal it may be the other.
    check_unique(&entries, true)?;
    if mirror == Mirror::Skew {
        drop_diagonal(&mut entries)?;
    }
    Ok(RawMatrix { size, entries })
}

/// Makes a matrix from its lower triangle with the diagonal, and its strict upper triangle folded into the lower.
///
/// A pair within tolerance becomes its mean; equal values keep their bits.
pub(super) fn from_both_triangles(
    mirror: Mirror,
    size: usize,
    mut lower: Vec<Entry>,
    mut upper: Vec<Entry>,
) -> Result<RawMatrix, MatrixProblem> {
    sort(&mut lower);
    sort(&mut upper);
    check_unique(&lower, false)?;
    check_unique(&upper, false).map_err(other_triangle)?;
    // Scale per row against which cancelled entries are small: the product of two is a geometric mean.
    let scale: Vec<f64> = match mirror {
        Mirror::Symmetric => {
            let mut diagonal = vec![0.0; size];
            for &(row, _, value) in lower.iter().filter(|entry| entry.0 == entry.1) {
                diagonal[row as usize] = f64::abs(value).sqrt();
            }
            diagonal
        }
        Mirror::Skew => {
            drop_diagonal(&mut lower)?;
            vec![largest(&lower).max(largest(&upper)).sqrt(); size]
        }
    };
    let mut entries = Vec::with_capacity(lower.len());
    let mut worst: Option<(f64, Entry, f64)> = None;
    let mut count = 0;
    let mut pair = |row: u32, column: u32, below: f64, above: f64| {
        let difference = (below - above).abs();
        let scale = scale[row as usize] * scale[column as usize];
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
            skew: mirror == Mirror::Skew,
            row,
            column,
            value,
            mirrored: mirror.image(mirrored),
            line: None,
            mirrored_line: None,
            count,
        });
    }
    Ok(RawMatrix { size, entries })
}

/// Makes a matrix from stored entries of unstated symmetry, positions repeated or not: repeated ones are summed.
///
/// `lower` has the lower triangle with the diagonal, `upper` the strict upper one folded into it. If only one of
/// the two has an entry that is not zero, the matrix is that triangle and its mirror image; if both have, they must
/// agree; if neither has, the matrix is diagonal and both readings are the same.
pub(super) fn from_any(
    mirror: Mirror,
    size: usize,
    lower: Vec<Entry>,
    mut upper: Vec<Entry>,
) -> Result<RawMatrix, MatrixProblem> {
    let mut lower = summed(lower);
    let off_diagonal = |entry: &Entry| entry.0 != entry.1;
    let below = lower.iter().any(|entry| off_diagonal(entry) && entry.2 != 0.0);
    let above = upper.iter().any(|entry| entry.2 != 0.0);
    if below && above {
        return from_both_triangles(mirror, size, lower, summed(upper));
    }
    if above {
        // Zeros stored in the empty triangle mean nothing.
        lower.retain(|entry| !off_diagonal(entry));
        lower.append(&mut upper);
        lower = summed(lower);
    }
    from_triangle(mirror, size, lower)
}

/// Sorts entries and sums those of equal positions in the order given.
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

/// Drops the diagonal of a skew-symmetric matrix, which must be zero: zeros and the rest of cancellation need not be kept.
fn drop_diagonal(entries: &mut Vec<Entry>) -> Result<(), MatrixProblem> {
    let tolerance = CANCELLATION_TOLERANCE * largest(entries);
    match entries.iter().find(|entry| entry.0 == entry.1 && entry.2.abs() > tolerance) {
        Some(&(row, _, value)) => Err(MatrixProblem::SkewDiagonal { row: u64::from(row) + 1, value }),
        None => {
            entries.retain(|entry| entry.0 != entry.1);
            Ok(())
        }
    }
}

fn largest(entries: &[Entry]) -> f64 {
    entries.iter().fold(0.0, |largest, entry| f64::max(largest, entry.2.abs()))
}

/// Sorts by column, then row: the order of compressed columns, and of most files.
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

fn other_triangle(problem: MatrixProblem) -> MatrixProblem {
    match problem {
        MatrixProblem::Repeated { row, column, first_line, mirrored } => {
            MatrixProblem::Repeated { row: column, column: row, first_line, mirrored }
        }
        problem => problem,
    }
}
