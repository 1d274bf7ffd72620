//! Proof that no mode was missed: eigenvalues below a shift, counted by Sylvester's law of inertia.
//!
//! The negative eigenvalues of K̂(i) − σM̂(i) are those of its eliminated interior and those of the Schur complement of
//! the face (Haynsworth). One real factor of K − σM serves every nodal diameter whose modes leave a gap at σ.

use faer::sparse::SparseColMat;
use faer::{Mat, c64};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::modes::{LOCATED, Modes};
use super::tied_factor::tied_schur;
use super::untied::{Tie, UntiedSector};
use rubmap_numerics::dense::Dense;
use rubmap_numerics::multifrontal::Inertia;

/// Number of eigenvalues below a shift.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ModeCount {
    /// Shift σ, (rad/s)².
    pub shift: f64,
    /// Number of eigenvalues below the shift, by inertia; as many were found.
    pub below: usize,
}

/// Proof that the modes stored are the lowest, none missed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Completeness {
    /// Modes are all the modes there are.
    Whole,
    /// Modes below a shift are as many as the eigenvalues counted there.
    Counted(ModeCount),
    /// Modes without proof: at no shift that was found does inertia decide.
    Unproven,
}

/// Verdict of a count on one nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    Complete(ModeCount),
    /// Count that differs from the modes found.
    Missed,
    Uncountable,
}

/// Smallest relative distance of a shift from a wanted eigenvalue; from one that is only located, twice the accuracy of its place.
const MARGIN: f64 = 1e-6;
/// Number of factorisations that may break down or grow before the rest stays uncounted.
const MOST_FAILURES: usize = 3;

/// Counts the eigenvalues of every nodal diameter in `found` below a shift that lies above its modes, with fixed
/// contact DOF.
pub(super) fn count_modes(
    untied: &UntiedSector,
    stiffness: &SparseColMat<usize, f64>,
    mass: &SparseColMat<usize, f64>,
    found: &[(Tie, &Modes)],
) -> Vec<Verdict> {
    let ladders: Vec<Ladder> = found.iter().map(|(_, modes)| Ladder::new(modes)).collect();
    let mut verdicts: Vec<Option<Verdict>> = vec![None; found.len()];
    let mut failed: Vec<f64> = Vec::new();
    while failed.len() < MOST_FAILURES {
        let waiting: Vec<usize> = (0..found.len()).filter(|&i| verdicts[i].is_none()).collect();
        let Some(shift) = best_shift(&ladders, &waiting, &failed) else { break };
        let terms = [(1.0, stiffness), (-shift, mass)];
        let served: Vec<(usize, usize)> =
            waiting.iter().filter_map(|&i| ladders[i].below(shift).map(|below| (i, below))).collect();
        let Some(inertia) = Inertia::new(&untied.analysis, &terms).ok().filter(|inertia| {
            // Round-off moves an eigenvalue by xᴴEx, ‖E‖ a few times ε times the growth.
            let error = 16.0 * f64::EPSILON * inertia.growth;
            served.iter().all(|&(i, _)| error * largest_square(found[i].1) < ladders[i].distance(shift))
        }) else {
            failed.push(shift);
            continue;
        };
        let counted: Vec<(usize, Verdict)> = served
            .par_iter()
            .map(|&(i, expected)| {
                let below = inertia.negative + negative_on_face(untied, &inertia.schur, &terms, &found[i].0);
                let complete = below == expected;
                (i, if complete { Verdict::Complete(ModeCount { shift, below }) } else { Verdict::Missed })
            })
            .collect();
        counted.into_iter().for_each(|(i, verdict)| verdicts[i] = Some(verdict));
    }
    verdicts.into_iter().map(|verdict| verdict.unwrap_or(Verdict::Uncountable)).collect()
}

/// Number of negative eigenvalues of the face's Schur complement.
fn negative_on_face(
    untied: &UntiedSector,
    eliminated: &Mat<f64>,
    terms: &[(f64, &SparseColMat<usize, f64>)],
    tie: &Tie,
) -> usize {
    let schur = tied_schur(untied, eliminated, terms, tie);
    let face = schur.submatrix(0, 0, untied.face(), untied.face());
    if UntiedSector::is_real(tie) {
        let real = Mat::from_fn(face.nrows(), face.ncols(), |i, j| face[(i, j)].re);
        f64::negative_eigenvalues(real.as_ref())
    } else {
        c64::negative_eigenvalues(face)
    }
}

/// Largest ‖x‖² of the mass-normalised modes.
fn largest_square(modes: &Modes) -> f64 {
    modes.vectors.col_iter().map(|x| x.squared_norm_l2()).fold(0.0, f64::max)
}

/// Eigenvalues known of one nodal diameter.
struct Ladder {
    /// Eigenvalues that are located, ascending.
    values: Vec<f64>,
    /// Number of eigenvalues that must lie below a shift.
    wanted: usize,
}

impl Ladder {
    fn new(modes: &Modes) -> Self {
        let values = modes.values.iter().chain(&modes.beyond).copied().collect();
        Self { values, wanted: modes.values.len() }
    }

    /// Number of known eigenvalues below `shift`, if it lies clear of them, above the wanted ones and below the last.
    fn below(&self, shift: f64) -> Option<usize> {
        let below = self.values.partition_point(|&value| value < shift);
        let clear = |index: usize| {
            let margin = if index < self.wanted { MARGIN } else { 2.0 * LOCATED };
            self.values.get(index).is_some_and(|value| (value - shift).abs() > margin * shift)
        };
        (below >= self.wanted && below > 0 && clear(below - 1) && clear(below)).then_some(below)
    }

    /// Distance from `shift` to the nearest known eigenvalue.
    fn distance(&self, shift: f64) -> f64 {
        self.values.iter().map(|value| (value - shift).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Middles of the gaps a shift may lie in.
    fn shifts(&self) -> impl Iterator<Item = f64> + '_ {
        self.values[self.wanted.max(1) - 1..].windows(2).map(|pair| 0.5 * (pair[0] + pair[1]))
    }
}

/// Shift that serves most of the ladders that wait, none of `failed`; of several, the one farthest from all their eigenvalues.
fn best_shift(ladders: &[Ladder], waiting: &[usize], failed: &[f64]) -> Option<f64> {
    let candidates =
        waiting.iter().flat_map(|&i| ladders[i].shifts()).filter(|shift| !failed.contains(shift));
    let rated = candidates.map(|shift| {
        let served: Vec<&Ladder> =
            waiting.iter().map(|&i| &ladders[i]).filter(|ladder| ladder.below(shift).is_some()).collect();
        let nearest = served.iter().map(|ladder| ladder.distance(shift)).fold(f64::INFINITY, f64::min);
        (served.len(), nearest / shift, shift)
    });
    rated
        .filter(|&(served, _, _)| served > 0)
        .max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(b.2.total_cmp(&a.2)))
        .map(|(_, _, shift)| shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_shift_serves_all_it_can() {
        let ladder = |values: &[f64], wanted| Ladder { values: values.to_vec(), wanted };
        let ladders =
            [ladder(&[1.0, 2.0, 4.0, 7.0], 2), ladder(&[1.5, 3.9, 8.0], 1), ladder(&[10.0, 20.0, 30.0], 2)];
        let shift = best_shift(&ladders, &[0, 1, 2], &[]).unwrap();
        assert!(
            shift > 2.0
                && shift < 8.0
                && ladders[0].below(shift).is_some()
                && ladders[1].below(shift).is_some()
        );
        assert_eq!(best_shift(&ladders, &[2], &[]), Some(25.0));
        assert_eq!(best_shift(&ladders, &[2], &[25.0]), None);
        assert_eq!(best_shift(&[ladder(&[1.0, 2.0], 2)], &[0], &[]), None);
    }
}
