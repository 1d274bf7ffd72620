//! What no instant of no blade exceeds, for every place, before any is looked at.
//!
//! ```text
//! σ_s(t) = σ₀ + Σ_i Re( e^{jisα} Σ_k a_ik c_ik(t) ) + rest,      a = S̃ U
//! ```
//!
//! Von Mises stress is a seminorm, so |σ_s(t) − σ₀| ≤ Σ_ik |a_ik| max|c_ik| + |S̃| |rest|.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, c64};

use super::cycle::{Bound, Sign};
use super::measure::{Stress, ellipse, trace, von_mises};
use super::reduced::ReducedStress;
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
    /// a of those directions, `2·directions × 6·places`, for every nodal diameter that moves: the real and the imaginary part of each.
    pub(super) parts: Vec<Mat<f32>>,
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
        let parts = paths.iter().map(|path| of_path(stress, path, &mut swings, &mut errors)).collect();
        let bound = |((fixed, swing), error): ((&Stress, &Error), &Error)| {
            let (size, swing, sway) =
                (von_mises(fixed), swing.von_mises + error.von_mises, swing.trace + error.trace);
            Bound { largest: size + swing, swing, sign: Sign::of(trace(fixed) - sway, trace(fixed) + sway) }
        };
        let rough = fixed.iter().zip(&swings).zip(&errors).map(bound).collect();
        Self { rough, errors, parts }
    }
}

/// What single precision does to a fixed stress.
fn rounded(fixed: &Stress) -> Error {
    let size = fixed.iter().map(|s| s.abs()).sum::<f64>() * ROUNDING;
    Error { von_mises: 3.0 * size, trace: size }
}

/// The parts of one nodal diameter; what it adds to the swings and the errors of all places.
fn of_path(stress: &ReducedStress, path: &Path, swings: &mut [Error], errors: &mut [Error]) -> Mat<f32> {
    let operator = &stress.harmonics[path.harmonic];
    let turned = parts_of(&path.directions);
    let terms = (operator.rows.nrows() + turned.ncols()) as f64;
    let rounding = ROUNDING * terms * path.directions_reach();
    let mut kept = Mat::<f32>::zeros(2 * path.looking, operator.rows.ncols());
    let mut all = Mat::<f32>::zeros(turned.ncols(), 6 * BATCH);
    for first in (0..stress.places()).step_by(BATCH) {
        let count = BATCH.min(stress.places() - first);
        let rows = operator.rows.subcols(6 * first, 6 * count);
        let mut all = all.as_mut().subcols_mut(0, 6 * count);
        matmul(all.as_mut(), Accum::Replace, turned.transpose(), rows, 1.0, Par::Seq);
        kept.as_mut().subcols_mut(6 * first, 6 * count).copy_from(all.as_ref().subrows(0, 2 * path.looking));
        for at in 0..count {
            let (place, parts) = (first + at, all.as_ref().subcols(6 * at, 6));
            let norm = &operator.norms[place];
            let error = &mut errors[place];
            error.von_mises += path.left * norm.von_mises + rounding * norm.whole;
            error.trace += (path.left + rounding) * norm.whole;
            for (k, &reach) in path.reach.iter().enumerate() {
                let [re, im] = direction(parts, k);
                let sum = if k < path.looking { &mut swings[place] } else { &mut errors[place] };
                sum.von_mises += reach * ellipse(&re, &im);
                sum.trace += reach * trace(&re).hypot(trace(&im));
            }
        }
    }
    kept
}

fn direction(parts: MatRef<'_, f32>, k: usize) -> [Stress; 2] {
    [2 * k, 2 * k + 1].map(|row| std::array::from_fn(|component| f64::from(parts[(row, component)])))
}

/// U for real products: Re and Im of `s·u` from the real and imaginary parts of s, a column each.
fn parts_of(directions: &Mat<c64>) -> Mat<f32> {
    Mat::from_fn(2 * directions.nrows(), 2 * directions.ncols(), |row, column| {
        let c64 { re, im } = directions[(row / 2, column / 2)];
        (match (column % 2, row % 2) {
            (0, 0) => re,
            (0, _) => -im,
            (_, 0) => im,
            _ => re,
        }) as f32
    })
}
