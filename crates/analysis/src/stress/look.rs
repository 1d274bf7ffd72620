//! Evaluation of places at all instants of all blades with the directions that stress them most; the rest is bounded.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par, c64};

use super::bounds::{Error, ROUNDING};
use super::cycle::{Bound, Weights};
use super::extremes::{Extremes, Moved};
use super::measure::Stress;
use super::metric::turned;
use super::reduced::{HarmonicStress, ReducedStress};
use super::sums::{LANES, Sums};
use super::trajectory::Path;

/// Number of places that are evaluated together: their waves stay in the second-level cache.
pub(super) const BATCH: usize = 8;

/// Bounds of a place from its evaluation, over all blades.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Upper bound of the von Mises stress.
    pub(super) largest: f64,
    /// Lower bound of the largest von Mises stress.
    pub(super) largest_at_least: f64,
    /// Upper bound of the measure of utilisation.
    pub(super) most: f64,
    /// Lower bound of the measure of utilisation.
    pub(super) most_at_least: f64,
}

/// Evaluation of places, prepared for a wheel at a speed.
pub(super) struct Look<'a> {
    fixed: &'a [Stress],
    arch: pulp::Arch,
    /// Divisor of stresses, so that their squares have room in single precision.
    scale: f64,
    moving: Vec<Moving<'a>>,
    /// Number of instants, padded to whole vectors.
    instants: usize,
    /// Real and imaginary part of e^{jisα}, `[blade][nodal diameter]`.
    turns: Vec<(f32, f32)>,
    blades: usize,
}

impl<'a> Look<'a> {
    /// Prepares the evaluation of the `paths` over `instants` of a wheel with `blades` that differ, of `around` in all.
    pub(super) fn new(
        stress: &'a ReducedStress,
        bounds: &[Bound],
        fixed: &'a [Stress],
        paths: &[Path],
        (blades, around): (usize, usize),
        instants: usize,
    ) -> Self {
        let scale = bounds.iter().map(|bound| bound.largest).fold(f64::MIN_POSITIVE, f64::max);
        let padded = instants.next_multiple_of(LANES);
        let turns = (0..blades).flat_map(|blade| {
            paths.iter().map(move |path| {
                let c64 { re, im } = turn(path.harmonic, blade, around);
                (re as f32, im as f32)
            })
        });
        Self {
            arch: rubmap_numerics::vectors::arch(),
            moving: paths.iter().map(|path| Moving::new(stress, path, (instants, padded), scale)).collect(),
            instants: padded,
            turns: turns.collect(),
            blades,
            fixed,
            scale,
        }
    }

    /// Evaluates some places, at most [`BATCH`], with the `weights` of each.
    pub(super) fn at(&self, places: &[usize], weights: &[Option<Weights>]) -> Vec<Seen> {
        let width = 2 * self.instants;
        let mut errors: Vec<Error> = places.iter().map(|&place| Error::rounded(&self.fixed[place])).collect();
        let waves: Vec<Vec<f32>> =
            self.moving.iter().map(|moving| moving.waves(places, &mut errors)).collect();
        let mut extremes = Vec::with_capacity(self.blades);
        let seen = |(at, (&place, weights)): (usize, (&usize, &Option<Weights>))| {
            let waves: Vec<&[f32]> =
                waves.iter().map(|waves| &waves[6 * width * at..][..6 * width]).collect();
            let error = &errors[at];
            let moved = Moved {
                fixed: self.fixed[place].map(|stress| (stress / self.scale) as f32),
                waves: &waves,
                instants: self.instants,
                turns: &self.turns,
                blades: self.blades,
                trace_error: (error.trace / self.scale) as f32,
            };
            moved.extremes(self.arch, &mut extremes);
            self.seen(&extremes, error, *weights)
        };
        places.iter().zip(weights).enumerate().map(seen).collect()
    }

    fn seen(&self, extremes: &[Extremes], error: &Error, weights: Option<Weights>) -> Seen {
        let mut seen = Seen { largest: 0.0, largest_at_least: 0.0, most: -1.0, most_at_least: -1.0 };
        let root = |square: f32| self.scale * f64::from(square.abs()).sqrt() * f64::from(square.signum());
        let error = error.von_mises;
        for blade in extremes {
            let largest = root(blade.largest);
            seen.largest = seen.largest.max(largest + error);
            seen.largest_at_least = seen.largest_at_least.max(largest - error);
            if let Some(weights) = weights {
                let highs = (root(blade.high_at_least) - error, root(blade.high_at_most) + error);
                let lows = (root(blade.low_at_least) - error, root(blade.low_at_most) + error);
                let (least, most) = weights.within(lows, highs);
                seen.most = seen.most.max(most);
                seen.most_at_least = seen.most_at_least.max(least);
            }
        }
        seen
    }
}

/// Nodal diameter that moves.
struct Moving<'a> {
    operator: &'a HarmonicStress,
    /// Directions as rows, `2·directions × 2·unknowns`, the directions padded.
    turned: Mat<f32>,
    /// Factors of the evaluated directions, `2·instants × 2·directions`: they give the real, then the imaginary part of w_i at all
    /// instants.
    drive: Mat<f32>,
    /// Sums over the directions that are not evaluated.
    sums: Sums,
    /// Norm |x̃|_G that all directions neglect.
    left: f64,
    /// Rounding error, relative to a norm.
    rounding: f64,
}

impl<'a> Moving<'a> {
    fn new(stress: &'a ReducedStress, path: &Path, (instants, padded): (usize, usize), scale: f64) -> Self {
        let looking = path.looking;
        let drive = Mat::from_fn(2 * padded, 2 * looking, |row, column| {
            // The last instant stands in for those that fill the last vector.
            let instant = (row % padded).min(instants - 1);
            let c64 { re, im } = path.course[(column % looking, instant)] / scale;
            (match (row / padded, column / looking) {
                (0, 0) => re,
                (0, _) => -im,
                (_, 0) => im,
                _ => re,
            }) as f32
        });
        let operator = &stress.harmonics[path.harmonic];
        let directions = path.reach.len().next_multiple_of(LANES);
        let terms = (operator.rows.nrows() + 2 * directions) as f64;
        let mut reach = path.reach.clone();
        reach[..looking].fill(0.0);
        Self {
            operator,
            turned: turned(path.directions.as_ref(), directions),
            drive,
            sums: Sums::new(&reach, directions),
            left: path.left,
            rounding: ROUNDING * terms * path.length(path.reach.len()),
        }
    }

    /// Waves w_i at some places, `[place][component][part][instant]`; adds the neglected rest to their `errors`.
    fn waves(&self, places: &[usize], errors: &mut [Error]) -> Vec<f32> {
        let rows = self.operator.of_places(places);
        let mut parts = vec![0.0f32; self.turned.nrows() * rows.ncols()];
        let into = MatMut::from_column_major_slice_mut(&mut parts, self.turned.nrows(), rows.ncols());
        matmul(into, Accum::Replace, &self.turned, &rows, 1.0, Par::Seq);
        for ((&place, parts), error) in
            places.iter().zip(parts.chunks_exact(6 * self.turned.nrows())).zip(errors)
        {
            let (norm, rest) = (&self.operator.norms[place], self.sums.of(parts).sizes);
            error.von_mises +=
                rest[0] + self.left * norm.von_mises_squared.sqrt() + self.rounding * norm.whole;
            error.trace += rest[1] + self.left * norm.trace_squared.sqrt() + self.rounding * norm.whole;
        }
        let parts = MatRef::from_column_major_slice(&parts, self.turned.nrows(), rows.ncols());
        let looking = self.drive.ncols() / 2;
        let mut waves = vec![0.0; self.drive.nrows() * rows.ncols()];
        let mut into = MatMut::from_column_major_slice_mut(&mut waves, self.drive.nrows(), rows.ncols());
        for (part, accumulate) in [Accum::Replace, Accum::Add].into_iter().enumerate() {
            let drive = self.drive.subcols(part * looking, looking);
            let parts = parts.subrows(part * self.turned.nrows() / 2, looking);
            matmul(into.as_mut(), accumulate, drive, parts, 1.0, Par::Seq);
        }
        waves
    }
}

/// Phase e^{jisα} of nodal diameter i at blade s.
pub(super) fn turn(harmonic: usize, blade: usize, around: usize) -> c64 {
    let angle = std::f64::consts::TAU * ((harmonic * blade) % around) as f64 / around as f64;
    c64::new(angle.cos(), angle.sin())
}
