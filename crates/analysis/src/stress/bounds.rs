//! Upper bounds of the stress of every place over all instants and blades, computed before any place is evaluated.
//!
//! ```text
//! σ_s(t) = σ₀ + Σ_i Re( e^{jisα} Σ_k a_ik c_ik(t) ) + rest,      a = S̃ U
//! ```
//!
//! Von Mises stress is a seminorm, so |σ_s(t) − σ₀| ≤ Σ_ik |a_ik| max|c_ik| + |S̃|_G |rest|_G, with few directions k, those with most
//! stress. The share of |S̃|²_G in these directions is subtracted in the bound of the rest.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, Par};

use super::cycle::{Bound, Sign};
use super::measure::{Stress, trace, von_mises};
use super::metric::turned;
use super::reduced::ReducedStress;
use super::sums::{LANES, Sums};
use super::trajectory::Path;

/// Number of places whose directions are computed together.
const BATCH: usize = 64;

/// Rounding error in single precision per term of a sum, relative, with a margin.
pub(super) const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// Upper bound of the stress that is neglected.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Error {
    /// Bound of the von Mises stress.
    pub(super) von_mises: f64,
    /// Bound of three times the mean normal stress.
    pub(super) trace: f64,
}

/// Bounds of all places, for the `paths` of a wheel under `fixed` stress.
pub(super) fn bounds(stress: &ReducedStress, fixed: &[Stress], paths: &[Path]) -> Vec<Bound> {
    let mut swings: Vec<Error> = fixed.iter().map(Error::rounded).collect();
    for path in paths {
        add(stress, path, &mut swings);
    }
    let bound = |(fixed, Error { von_mises: swing, trace: sway }): (&Stress, Error)| Bound {
        largest: von_mises(fixed) + swing,
        swing,
        sign: Sign::of(trace(fixed) - sway, trace(fixed) + sway),
    };
    fixed.iter().zip(swings).map(bound).collect()
}

impl Error {
    /// Rounding error of a fixed stress in single precision.
    pub(super) fn rounded(fixed: &Stress) -> Self {
        let size = fixed.iter().map(|s| s.abs()).sum::<f64>() * ROUNDING;
        Self { von_mises: 3.0 * size, trace: size }
    }
}

/// Adds the contribution of one nodal diameter to the swings of all places.
fn add(stress: &ReducedStress, path: &Path, swings: &mut [Error]) {
    let operator = &stress.harmonics[path.harmonic];
    let padded = path.bounding.next_multiple_of(LANES);
    let turned = turned(path.directions.subcols(0, path.bounding), padded);
    let rounding = ROUNDING * operator.rows.nrows() as f64 * path.length(path.bounding);
    let sums = Sums::new(&path.reach[..path.bounding], padded);
    let mut parts = vec![0.0f32; 12 * padded * BATCH];
    for first in (0..stress.places()).step_by(BATCH) {
        let count = BATCH.min(stress.places() - first);
        let rows = operator.rows.subcols(6 * first, 6 * count);
        let parts = &mut parts[..12 * padded * count];
        let into = MatMut::from_column_major_slice_mut(parts, 2 * padded, 6 * count);
        matmul(into, Accum::Replace, &turned, rows, 1.0, Par::Seq);
        let of_batch = parts.chunks_exact(12 * padded).zip(&operator.norms[first..]);
        for ((parts, norm), swing) in of_batch.zip(&mut swings[first..]) {
            let found = sums.of(parts);
            let left = |all: f64, taken: f64| (all - taken).max(0.0).sqrt() * path.left_by_bounding;
            let rounded = rounding * norm.whole;
            swing.von_mises += found.sizes[0] + left(norm.von_mises_squared, found.squares[0]) + rounded;
            swing.trace += found.sizes[1] + left(norm.trace_squared, found.squares[1]) + rounded;
        }
    }
}
