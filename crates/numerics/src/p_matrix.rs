//! Whether a small matrix is a P-matrix: all its principal minors positive.
//!
//! Recursively (Tsatsomeros and Li, BIT Numerical Mathematics 40, 2000): A is a P-matrix if and only if its first diagonal entry is positive, and A
//! without its first index and the Schur complement of that entry are P-matrices. That takes 2ⁿ short eliminations instead of 2ⁿ determinants.

use faer::{Mat, MatRef};

/// Largest matrix of which all principal minors are examined.
pub const MOST_INDICES: usize = 12;

/// Share of the largest diagonal entry below which a pivot is round-off.
const ROUND_OFF: f64 = 1e-13;

/// Index set of `a` whose principal minor is not positive, by its last index; none was found in a P-matrix.
///
/// Examines all sets of up to [`MOST_INDICES`] indices; of a larger matrix all runs of as many consecutive indices.
pub fn non_positive_minor(a: MatRef<'_, f64>) -> Option<usize> {
    let n = a.nrows();
    let least = ROUND_OFF * (0..n).fold(0.0f64, |most, i| most.max(a[(i, i)]));
    if n <= MOST_INDICES {
        any_set(a, least, 0)
    } else {
        let run = |first: usize| {
            let length = MOST_INDICES.min(n - first);
            run_from(a.submatrix(first, first, length, length), least, first)
        };
        (0..n).find_map(run)
    }
}

/// Searches all sets of the indices from `first`; `a` is the Schur complement after eliminating the indices chosen before.
fn any_set(a: MatRef<'_, f64>, least: f64, first: usize) -> Option<usize> {
    let n = a.nrows();
    if n == 0 {
        return None;
    }
    if is_not_above(a[(0, 0)], least) {
        return Some(first);
    }
    let without = a.submatrix(1, 1, n - 1, n - 1);
    any_set(without, least, first + 1).or_else(|| any_set(eliminated(a).as_ref(), least, first + 1))
}

/// Searches the sets {first}, {first, first + 1}, …: one elimination serves them all.
fn run_from(a: MatRef<'_, f64>, least: f64, first: usize) -> Option<usize> {
    let mut rest = a.to_owned();
    for index in first..first + a.nrows() {
        if is_not_above(rest[(0, 0)], least) {
            return Some(index);
        }
        rest = eliminated(rest.as_ref());
    }
    None
}

/// Whether a value is at most `limit`, or not a number.
fn is_not_above(value: f64, limit: f64) -> bool {
    value.is_nan() || value <= limit
}

/// Schur complement of the first diagonal entry.
fn eliminated(a: MatRef<'_, f64>) -> Mat<f64> {
    let n = a.nrows() - 1;
    Mat::from_fn(n, n, |i, j| a[(i + 1, j + 1)] - a[(i + 1, 0)] * a[(0, j + 1)] / a[(0, 0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::fixed;
    use proptest::prelude::*;

    /// The smallest principal minor, by determinants.
    fn smallest_minor(a: &Mat<f64>) -> f64 {
        let minor = |set: usize| {
            let chosen: Vec<_> = (0..a.nrows()).filter(|i| set >> i & 1 == 1).collect();
            nalgebra::DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| a[(chosen[i], chosen[j])])
                .determinant()
        };
        (1..1usize << a.nrows()).map(minor).fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #![proptest_config(fixed(256))]

        #[test]
        fn agrees_with_determinants(
            n in 1usize..6,
            entries in prop::collection::vec(-1.0f64..1.0, 25),
            diagonal in 0.5f64..2.5,
        ) {
            let a = Mat::from_fn(n, n, |i, j| entries[5 * i + j] + if i == j { diagonal } else { 0.0 });
            let smallest = smallest_minor(&a);
            // A minor nearer to zero may fall on either side by round-off.
            prop_assume!(smallest.abs() > 1e-9);
            prop_assert_eq!(non_positive_minor(a.as_ref()).is_none(), smallest > 0.0);
        }
    }

    /// Matrix with one bad pair among more than [`MOST_INDICES`] indices.
    #[test]
    fn finds_bad_neighbours_in_a_large_matrix() {
        let n = MOST_INDICES + 8;
        let with = |coupling: f64| {
            Mat::from_fn(n, n, |i, j| match (i, j) {
                _ if i == j => 1.0,
                (5, 6) | (6, 5) => coupling,
                _ => 0.0,
            })
        };
        assert_eq!(non_positive_minor(with(0.99).as_ref()), None);
        assert_eq!(non_positive_minor(with(1.01).as_ref()), Some(6));
    }
}
