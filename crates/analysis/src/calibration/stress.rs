//! Computing time of stress at a speed: the product that bounds every place, and as much again for the rest of the search.

use std::time::Instant;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Size of the measured product: unknowns of a nodal diameter, places, and directions padded to whole vectors.
const UNKNOWNS: usize = 80;
const PLACES: usize = 500;
const DIRECTIONS: usize = 64;

/// Ratio of the time of stress to that of the product, for a wheel of which every other nodal diameter moves: with the directions
/// themselves, the evaluation of some places and those that are followed (`cargo bench --bench stress`).
const SEARCH: f64 = 2.0;

const ROUNDS: usize = 5;

/// Computing time per real number of the stress of a reduction, s, on the calling thread.
pub(super) fn measure() -> f64 {
    let numbers = |rows: usize, columns: usize| {
        Mat::<f32>::from_fn(rows, columns, |i, j| ((7 * i + 3 * j) % 11) as f32 - 5.0)
    };
    let (directions, rows) = (numbers(2 * UNKNOWNS, 2 * DIRECTIONS), numbers(2 * UNKNOWNS, 6 * PLACES));
    let mut parts = Mat::<f32>::zeros(2 * DIRECTIONS, 6 * PLACES);
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        matmul(parts.as_mut(), Accum::Replace, directions.transpose(), &rows, 1.0, Par::Seq);
        best = best.min(start.elapsed().as_secs_f64());
    }
    SEARCH * best / (rows.nrows() * rows.ncols()) as f64
}
