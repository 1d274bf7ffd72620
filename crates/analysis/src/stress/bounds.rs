//! What no instant of no blade exceeds, for every place, before any is looked at.
//!
//! ```text
//! σ_s(t) = σ₀ + Σ_i Re( e^{jisα} Σ_k a_ik c_ik(t) ) + rest,      a = S̃ U
//! ```
//!
//! Von Mises stress is a seminorm, so |σ_s(t) − σ₀| ≤ Σ_ik |a_ik| max|c_ik| + |S̃| |rest|.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, Par};

use super::cycle::{Bound, Sign};
use super::measure::{Stress, trace, von_mises};
use super::reduced::ReducedStress;
use super::sums::{LANES, Sums};
use super::trajectory::Path;

/// Places whose directions are computed together.
const BATCH: usize = 64;

/// Spacings of single precision per term of a sum, with room.
const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// Bounds of all places.
pub(super) struct Bounds {
    /// Of the whole path.
    pub(super) rough: Vec<Bound>,
    /// What the directions by which places are looked at leave, and what rounding may have done.
    pub(super) errors: Vec<Error>,
}

/// No more than this is left out.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Error {
    /// Of von Mises stress.
    pub(super) von_mises: f64,
    /// Of three times the mean normal stress.
    pub(super) trace: f64,
}

impl Bounds {
    /// Of the `paths` of a wheel under `fixed` stress.
    pub(super) fn new(stress: &ReducedStress, fixed: &[Stress], paths: &[Path]) -> Self {
        let mut swings = vec![Error::default(); fixed.len()];
        let mut errors: Vec<Error> = fixed.iter().map(rounded).collect();
        for path in paths {
            add(stress, path, &mut swings, &mut errors);
        }
        let bound = |((fixed, swing), error): ((&Stress, &Error), &Error)| {
            let (size, swing, sway) =
                (von_mises(fixed), swing.von_mises + error.von_mises, swing.trace + error.trace);
            Bound { largest: size + swing, swing, sign: Sign::of(trace(fixed) - sway, trace(fixed) + sway) }
        };
        let rough = fixed.iter().zip(&swings).zip(&errors).map(bound).collect();
        Self { rough, errors }
    }
}

impl Error {
    fn add(&mut self, other: Self) {
        self.von_mises += other.von_mises;
        self.trace += other.trace;
    }
}

/// What single precision does to a fixed stress.
fn rounded(fixed: &Stress) -> Error {
    let size = fixed.iter().map(|s| s.abs()).sum::<f64>() * ROUNDING;
    Error { von_mises: 3.0 * size, trace: size }
}

/// Adds what one nodal diameter does to the swings and the errors of all places.
fn add(stress: &ReducedStress, path: &Path, swings: &mut [Error], errors: &mut [Error]) {
    let operator = &stress.harmonics[path.harmonic];
    let padded = path.reach.len().next_multiple_of(LANES);
    let turned = path.turned(path.reach.len(), padded);
    let terms = (operator.rows.nrows() + 2 * padded) as f64;
    let rounding = ROUNDING * terms * path.length();
    let sums = Sums::new(path, padded);
    let mut parts = vec![0.0f32; 12 * padded * BATCH];
    for first in (0..stress.places()).step_by(BATCH) {
        let count = BATCH.min(stress.places() - first);
        let rows = operator.rows.subcols(6 * first, 6 * count);
        let parts = &mut parts[..12 * padded * count];
        let into = MatMut::from_column_major_slice_mut(parts, 2 * padded, 6 * count);
        matmul(into, Accum::Replace, &turned, rows, 1.0, Par::Seq);
        let of_batch = parts.chunks_exact(12 * padded);
        for ((parts, norm), (swing, error)) in
            of_batch.zip(&operator.norms[first..]).zip(swings[first..].iter_mut().zip(&mut errors[first..]))
        {
            let [looked, left] = sums.of(parts);
            swing.add(looked);
            error.add(left);
            error.von_mises += path.left * norm.von_mises + rounding * norm.whole;
            error.trace += (path.left + rounding) * norm.whole;
        }
    }
}
