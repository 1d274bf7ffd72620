//! Proof that no mode was missed: eigenvalues below a shift, counted by Sylvester's law of inertia.
//!
//! The negative eigenvalues of K̂(i) − σM̂(i) are those of its eliminated interior and those of the Schur complement of
//! the face (Haynsworth). One real factor of K − σM serves every nodal diameter whose modes leave a gap at σ.

use faer::sparse::SparseColMat;
use faer::traits::ComplexField;
use faer::traits::ext::ComplexFieldExt;
use faer::{Mat, MatRef, Side};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::modes::Modes;
use super::tied::tied_schur;
use super::untied::{Tie, UntiedSector};
use crate::numerics::multifrontal::PartialFactor;

/// Eigenvalues below a shift.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ModeCount {
    /// σ, (rad/s)².
    pub shift: f64,
    /// How many lie below it, by inertia.
    pub below: usize,
    /// How many were found below it.
    pub found: usize,
}

/// Why modes could not be counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Uncountable {
    pub(super) harmonic: usize,
}

/// Smallest relative distance of a shift from an eigenvalue: closer, and round-off could decide on which side it is.
const MARGIN: f64 = 1e-6;
/// Largest growth of a factorisation without pivoting, relative to the largest entry: it leaves six digits, and the
/// margin asks for no more.
const GROWTH: f64 = 1e10;

/// Counts the eigenvalues of every nodal diameter in `found` below a shift that lies above its modes, with fixed
/// contact DOF.
pub(super) fn count_modes(
    untied: &UntiedSector,
    stiffness: &SparseColMat<usize, f64>,
    mass: &SparseColMat<usize, f64>,
    found: &[(Tie, &Modes)],
) -> Result<Vec<ModeCount>, Uncountable> {
    let ladders: Vec<Ladder> = found.iter().map(|(_, modes)| Ladder::new(modes)).collect();
    let mut counts: Vec<Option<ModeCount>> = vec![None; found.len()];
    while let Some(first) = counts.iter().position(Option::is_none) {
        let harmonic = found[first].0.harmonic;
        let waiting: Vec<usize> = (0..found.len()).filter(|&i| counts[i].is_none()).collect();
        let shift = best_shift(&ladders, &waiting).ok_or(Uncountable { harmonic })?;
        let terms = [(1.0, stiffness), (-shift, mass)];
        let factor = PartialFactor::new(&untied.analysis, &terms).map_err(|_| Uncountable { harmonic })?;
        let scale =
            |matrix: &SparseColMat<usize, f64>| matrix.val().iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if factor.growth() > GROWTH * (scale(stiffness) + shift * scale(mass)) {
            return Err(Uncountable { harmonic });
        }
        let served: Vec<(usize, usize)> =
            waiting.iter().filter_map(|&i| ladders[i].below(shift).map(|found| (i, found))).collect();
        let counted: Vec<(usize, ModeCount)> = served
            .par_iter()
            .map(|&(i, expected)| {
                let schur = tied_schur(untied, &factor, &terms, &found[i].0);
                let face = schur.submatrix(0, 0, untied.face(), untied.face());
                let negative = if UntiedSector::width(&found[i].0, 1) == 1 {
                    let real = Mat::from_fn(face.nrows(), face.ncols(), |i, j| face[(i, j)].re);
                    negative_eigenvalues(real.as_ref())
                } else {
                    negative_eigenvalues(face)
                };
                let below = factor.negative_pivots() + negative;
                (i, ModeCount { shift, below, found: expected })
            })
            .collect();
        counted.into_iter().for_each(|(i, count)| counts[i] = Some(count));
    }
    Ok(counts.into_iter().flatten().collect())
}

/// The eigenvalues known of one nodal diameter.
struct Ladder {
    /// Ascending, all that are located.
    values: Vec<f64>,
    /// How many of them must lie below a shift.
    wanted: usize,
}

impl Ladder {
    fn new(modes: &Modes) -> Self {
        let values = modes.values.iter().chain(&modes.beyond).copied().collect();
        Self { values, wanted: modes.values.len() }
    }

    /// Known eigenvalues below `shift`, if it lies clear of them, above the wanted ones and below the last.
    fn below(&self, shift: f64) -> Option<usize> {
        let below = self.values.partition_point(|&value| value < shift);
        let clear =
            |index: usize| self.values.get(index).is_some_and(|value| (value - shift).abs() > MARGIN * shift);
        (below >= self.wanted && below > 0 && clear(below - 1) && clear(below)).then_some(below)
    }

    /// Middles of the gaps a shift may lie in.
    fn shifts(&self) -> impl Iterator<Item = f64> + '_ {
        self.values[self.wanted.max(1) - 1..].windows(2).map(|pair| 0.5 * (pair[0] + pair[1]))
    }
}

/// The shift that serves most of the ladders that wait; of those, the one farthest from all their eigenvalues.
fn best_shift(ladders: &[Ladder], waiting: &[usize]) -> Option<f64> {
    let candidates = waiting.iter().flat_map(|&i| ladders[i].shifts());
    let rated = candidates.map(|shift| {
        let served: Vec<&Ladder> =
            waiting.iter().map(|&i| &ladders[i]).filter(|ladder| ladder.below(shift).is_some()).collect();
        let nearest = served
            .iter()
            .flat_map(|ladder| &ladder.values)
            .map(|value| (value / shift - 1.0).abs())
            .fold(f64::INFINITY, f64::min);
        (served.len(), nearest, shift)
    });
    rated
        .filter(|&(served, _, _)| served > 0)
        .max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(b.2.total_cmp(&a.2)))
        .map(|(_, _, shift)| shift)
}

/// Negative eigenvalues of a Hermitian matrix, from the blocks of its Bunch–Kaufman factor.
fn negative_eigenvalues<T: ComplexField<Real = f64>>(matrix: MatRef<'_, T>) -> usize {
    let factor = matrix.lblt(Side::Lower);
    let (diagonal, below) = (factor.B_diag().column_vector(), factor.B_subdiag().column_vector());
    let mut negative = 0;
    let mut i = 0;
    while i < matrix.nrows() {
        let (a, coupling) = (diagonal[i].real(), below[i].abs());
        if coupling == 0.0 {
            negative += usize::from(a < 0.0);
            i += 1;
        } else {
            let b = diagonal[i + 1].real();
            negative += if a * b < coupling * coupling {
                1
            } else if a < 0.0 {
                2
            } else {
                0
            };
            i += 2;
        }
    }
    negative
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::c64;

    #[test]
    fn inertia_of_an_indefinite_matrix() {
        // U diag(λ) Uᴴ with known signs; zero diagonal entries force 2 × 2 blocks.
        let n = 12;
        let start =
            Mat::from_fn(n, n, |i, j| c64::new(((i * 3 + j * j) as f64).sin(), ((i + 5 * j) as f64).cos()));
        let u = start.qr().compute_thin_Q();
        for negative in 0..=n {
            let scaled = Mat::from_fn(n, n, |i, j| {
                u[(i, j)] * (j as f64 + 1.0) * if j < negative { -1.0 } else { 1.0 }
            });
            assert_eq!(negative_eigenvalues((scaled * u.adjoint()).as_ref()), negative);
        }
        let swap =
            Mat::from_fn(4, 4, |i, j| c64::new(0.0, if i + j == 3 { i as f64 - j as f64 } else { 0.0 }));
        assert_eq!(negative_eigenvalues(swap.as_ref()), 2);
    }

    #[test]
    fn one_shift_serves_all_it_can() {
        let ladder = |values: &[f64], wanted| Ladder { values: values.to_vec(), wanted };
        let ladders =
            [ladder(&[1.0, 2.0, 4.0, 7.0], 2), ladder(&[1.5, 3.9, 8.0], 1), ladder(&[10.0, 20.0, 30.0], 2)];
        let shift = best_shift(&ladders, &[0, 1, 2]).unwrap();
        assert!(
            shift > 2.0
                && shift < 8.0
                && ladders[0].below(shift).is_some()
                && ladders[1].below(shift).is_some()
        );
        assert_eq!(best_shift(&ladders, &[2]), Some(25.0));
        assert_eq!(best_shift(&[ladder(&[1.0, 2.0], 2)], &[0]), None);
    }
}
