//! What no instant of no blade exceeds, for every place, before any is followed.
//!
//! ```text
//! σ_s(t) = σ₀ + Σ_i Re( e^{jisα} Σ_k a_ik c_ik(t) ) + rest,      a = S̃ U
//! ```
//!
//! Von Mises stress is a seminorm, so |σ_s(t) − σ₀| ≤ Σ_ik |a_ik| max|c_ik| + |S̃| |rest|. Those places that this does not rule out are
//! looked at where it matters: at knots of the path. Between two knots the path is a straight line, on which a convex function is
//! largest at its ends, and what each direction strays from it. Before that, all blades at once: |σ_s(t) − σ₀| ≤ Σ_i |w_i(t)|, with
//! w_i(t) = Σ_k a_ik c_ik(t) of a nodal diameter, loses only the phases between nodal diameters.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par, c64};

use super::cycle::{Bound, Sign, Weights};
use super::measure::{Stress, ellipse, signed, trace, von_mises};
use super::reduced::ReducedStress;
use super::trajectory::Path;

/// Places that are looked at together.
pub(super) const BATCH: usize = 32;

/// Knots are added until the directions stray by no more than this share of what they reach.
const STRAY: f64 = 0.02;

/// Spacings of single precision per term of a sum, with room.
const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// Bounds of all places.
pub(super) struct Bounds<'a> {
    stress: &'a ReducedStress,
    fixed: &'a [Stress],
    /// a, `2·directions × 6·places`: real and imaginary part of every direction of every nodal diameter.
    parts: Mat<f32>,
    /// max|c_ik|.
    reach: Vec<f64>,
    /// How far c_ik strays between knots.
    strays: Vec<f64>,
    /// Per nodal diameter that moves: its place in the reduced stress, what its directions leave, and what rounding may have done.
    rests: Vec<(usize, f64, f64)>,
    /// `2·directions × (blades·knots)`: what each part is multiplied by.
    drive: Mat<f32>,
    /// Per nodal diameter `2·directions × 2·knots`: what gives real and imaginary part of w_i.
    waves: Vec<Mat<f32>>,
    knots: usize,
}

/// What knots say of a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Over all blades.
    pub(super) largest: f64,
    /// Of the measure of utilisation, if it has one.
    pub(super) most: f64,
    /// What the largest von Mises stress is at least.
    pub(super) largest_at_least: f64,
    /// What the measure is at least.
    pub(super) most_at_least: f64,
}

impl<'a> Bounds<'a> {
    /// Of the `paths` over so many `instants` of a wheel of which `blades` are told apart, `around` stand in all.
    pub(super) fn new(
        stress: &'a ReducedStress,
        fixed: &'a [Stress],
        paths: &[Path],
        (blades, around): (usize, usize),
        instants: usize,
    ) -> Self {
        let directions: usize = paths.iter().map(|path| path.bounding).sum();
        let mut parts = Mat::<f32>::zeros(2 * directions, 6 * stress.places());
        let (mut reach, mut rests) = (Vec::new(), Vec::new());
        for path in paths {
            let rows = &stress.harmonics[path.harmonic].rows;
            let turned = parts_of(path);
            let into = parts.subrows_mut(2 * reach.len(), turned.ncols());
            matmul(into, Accum::Replace, turned.transpose(), rows, 1.0, Par::Seq);
            let reached = path.reach();
            let terms = (rows.nrows() + 2 * directions) as f64;
            rests.push((path.harmonic, path.left, ROUNDING * terms * reached.iter().sum::<f64>()));
            reach.extend(reached);
        }
        let knots = knots(paths, instants);
        let strays = paths.iter().flat_map(|path| path.strays(&knots)).collect();
        let drive = drive(paths, &knots, (blades, around), directions);
        let waves = paths.iter().map(|path| wave(path, &knots)).collect();
        Self { stress, fixed, parts, reach, strays, rests, drive, waves, knots: knots.len() }
    }

    /// From the reach of all directions.
    pub(super) fn of(&self, place: usize) -> Bound {
        let fixed = &self.fixed[place];
        let (swing, sway) = self.sums(place, &self.reach);
        let middle = trace(fixed);
        Bound { largest: von_mises(fixed) + swing, swing, sign: Sign::of(middle - sway, middle + sway) }
    }

    /// From each nodal diameter at knots, of some places, at most [`BATCH`].
    pub(super) fn tighten(&self, places: &[usize]) -> Vec<Bound> {
        let mut sums = vec![(0.0f64, 0.0f64); places.len() * self.knots];
        let mut first = 0;
        for drive in &self.waves {
            let parts = Mat::from_fn(drive.nrows(), 6 * places.len(), |row, column| {
                self.parts[(first + row, 6 * places[column / 6] + column % 6)]
            });
            first += drive.nrows();
            let mut wave = Mat::<f32>::zeros(6 * places.len(), drive.ncols());
            matmul(wave.as_mut(), Accum::Replace, parts.transpose(), drive, 1.0, Par::Seq);
            for (at, (size, sway)) in sums.iter_mut().enumerate() {
                let (slot, knot) = (at / self.knots, at % self.knots);
                let [re, im] = [2 * knot, 2 * knot + 1].map(|column| -> Stress {
                    std::array::from_fn(|c| f64::from(wave[(6 * slot + c, column)]))
                });
                *size += ellipse(&re, &im);
                *sway += trace(&re).hypot(trace(&im));
            }
        }
        let bound = |(&place, sums): (&usize, &[(f64, f64)])| {
            let (error, stray) = self.sums(place, &self.strays);
            let swing = error + sums.iter().map(|sum| sum.0).fold(0.0, f64::max);
            let sway = stray + sums.iter().map(|sum| sum.1).fold(0.0, f64::max);
            let (fixed, middle) = (&self.fixed[place], trace(&self.fixed[place]));
            Bound { largest: von_mises(fixed) + swing, swing, sign: Sign::of(middle - sway, middle + sway) }
        };
        places.iter().zip(sums.chunks_exact(self.knots)).map(bound).collect()
    }

    /// Σ |a_ik| amount_ik and the rest, of von Mises stress and of the trace.
    fn sums(&self, place: usize, amounts: &[f64]) -> (f64, f64) {
        let (mut size, mut sway) = (0.0, 0.0);
        for (k, &amount) in amounts.iter().enumerate() {
            let [re, im] = self.direction(place, k);
            size += amount * ellipse(&re, &im);
            sway += amount * trace(&re).hypot(trace(&im));
        }
        for &(harmonic, left, rounding) in &self.rests {
            let norm = &self.stress.harmonics[harmonic].norms[place];
            size += left * norm.von_mises + rounding * norm.whole;
            sway += (left + rounding) * norm.whole;
        }
        (size, sway)
    }

    fn direction(&self, place: usize, k: usize) -> [Stress; 2] {
        [2 * k, 2 * k + 1].map(|row| std::array::from_fn(|c| f64::from(self.parts[(row, 6 * place + c)])))
    }

    /// What knots say of some places, at most [`BATCH`]; `weights` of each.
    pub(super) fn look(&self, places: &[usize], weights: &[Option<Weights>]) -> Vec<Seen> {
        let parts = Mat::from_fn(self.parts.nrows(), 6 * places.len(), |row, column| {
            self.parts[(row, 6 * places[column / 6] + column % 6)]
        });
        let mut moved = Mat::<f32>::zeros(6 * places.len(), self.drive.ncols());
        matmul(moved.as_mut(), Accum::Replace, parts.transpose(), &self.drive, 1.0, Par::Seq);
        let seen = |(slot, (&place, weights)): (usize, (&usize, &Option<Weights>))| {
            let (error, sway) = self.sums(place, &self.strays);
            // At the knots themselves nothing strays.
            let (error_there, sway_there) = self.sums(place, &[]);
            let fixed = &self.fixed[place];
            let at = |column: usize| -> Stress {
                std::array::from_fn(|c| fixed[c] + f64::from(moved[(6 * slot + c, column)]))
            };
            let mut seen = Seen { largest: 0.0, most: 0.0, largest_at_least: 0.0, most_at_least: 0.0 };
            for first in (0..self.drive.ncols()).step_by(self.knots) {
                let columns = first..first + self.knots;
                let mut middle = [0.0; 6];
                let (mut largest, mut ends, mut traces) = (0.0f64, EMPTY, EMPTY);
                for column in columns.clone() {
                    let stress = at(column);
                    middle.iter_mut().zip(&stress).for_each(|(sum, s)| *sum += s / self.knots as f64);
                    largest = largest.max(von_mises(&stress));
                    widen(&mut ends, signed(&stress));
                    widen(&mut traces, trace(&stress));
                }
                let from_middle = |column: usize| {
                    let stress = at(column);
                    von_mises(&std::array::from_fn(|c| stress[c] - middle[c]))
                };
                let swing = columns.map(from_middle).fold(0.0, f64::max);
                seen.largest = seen.largest.max(largest + error);
                seen.largest_at_least = seen.largest_at_least.max(largest - error_there);
                if let Some(weights) = weights {
                    let sign = Sign::of(traces.0 - sway, traces.1 + sway);
                    let bound = Bound { largest: largest + error, swing: swing + error, sign };
                    seen.most = seen.most.max(weights.most(&bound));
                    // Where the sign is doubtful at a knot its cycle says nothing.
                    if Sign::of(traces.0 - sway_there, traces.1 + sway_there) != Sign::Either {
                        let least = weights.least(ends.0, ends.1, error_there);
                        seen.most_at_least = seen.most_at_least.max(least);
                    }
                }
            }
            seen
        };
        places.iter().zip(weights).enumerate().map(seen).collect()
    }
}

const EMPTY: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

fn widen(ends: &mut (f64, f64), value: f64) {
    *ends = (ends.0.min(value), ends.1.max(value));
}

/// U for real products: Re and Im of `s·u` from the real and imaginary parts of s, a column each.
fn parts_of(path: &Path) -> Mat<f32> {
    Mat::from_fn(2 * path.directions.nrows(), 2 * path.bounding, |row, column| {
        let c64 { re, im } = path.directions[(row / 2, column / 2)];
        (match (column % 2, row % 2) {
            (0, 0) => re,
            (0, _) => -im,
            (_, 0) => im,
            _ => re,
        }) as f32
    })
}

/// Instants between which all paths are nearly straight, the first and the last among them.
fn knots(paths: &[Path], instants: usize) -> Vec<usize> {
    let norm = |values: Vec<f64>| values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let reached: f64 = paths.iter().map(|path| norm(path.reach())).sum();
    let mut intervals = 8;
    loop {
        let last = instants.saturating_sub(1);
        if intervals >= last {
            return (0..instants).collect();
        }
        let knots: Vec<usize> = (0..=intervals).map(|knot| knot * last / intervals).collect();
        let strays: f64 = paths.iter().map(|path| norm(path.strays(&knots))).sum();
        if strays <= STRAY * reached {
            return knots;
        }
        intervals += intervals / 2;
    }
}

fn drive(paths: &[Path], knots: &[usize], (blades, around): (usize, usize), directions: usize) -> Mat<f32> {
    let mut drive = Mat::zeros(2 * directions, blades * knots.len());
    let mut first = 0;
    for path in paths {
        for blade in 0..blades {
            let turn = turn(path.harmonic, blade, around);
            for (knot, &instant) in knots.iter().enumerate() {
                for k in 0..path.bounding {
                    let value = turn * path.course[(k, instant)];
                    let column = blade * knots.len() + knot;
                    drive[(2 * (first + k), column)] = value.re as f32;
                    drive[(2 * (first + k) + 1, column)] = -value.im as f32;
                }
            }
        }
        first += path.bounding;
    }
    drive
}

/// Columns of Re w and Im w of a nodal diameter at each knot.
fn wave(path: &Path, knots: &[usize]) -> Mat<f32> {
    Mat::from_fn(2 * path.bounding, 2 * knots.len(), |row, column| {
        let c64 { re, im } = path.course[(row / 2, knots[column / 2])];
        (match (row % 2, column % 2) {
            (0, 0) => re,
            (0, _) => im,
            (_, 0) => -im,
            _ => re,
        }) as f32
    })
}

/// e^{jisα}
pub(super) fn turn(harmonic: usize, blade: usize, around: usize) -> c64 {
    let angle = std::f64::consts::TAU * ((harmonic * blade) % around) as f64 / around as f64;
    c64::new(angle.cos(), angle.sin())
}
