//! Measure G of directions of the path: how much they stress all places together.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par, c64};

use super::sums::{LANES, Sums};
use rubmap_numerics::dense::Dense;

/// Share of the mean of G's eigenvalues that is added to all of them, far above the rounding error of single precision.
const ADDED: f64 = 1e-4;

/// Number of places whose norms are computed together.
const BATCH: usize = 64;

/// Factor above the rounding error of a norm in single precision: G's largest eigenvalue over its least is below a million.
const ROUNDED_UP: f64 = 1.01;

/// Norm |x̃|_G of coordinates x̃.
#[derive(Debug, Clone)]
pub(super) struct Metric {
    /// Factor F of F Fᴴ = G = Σ aᴴ a + λ: over the rows a of all components of all places, and a little of the energy.
    pub(super) lower: Mat<c64>,
}

/// Upper bounds of the stress of a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Norm {
    /// Square of the largest von Mises stress for coordinates of measure 1.
    pub(super) von_mises_squared: f64,
    /// Square of the largest trace, three times the mean normal stress, for coordinates of measure 1.
    pub(super) trace_squared: f64,
    /// Largest von Mises stress or trace for coordinates of a unit of root energy.
    pub(super) whole: f64,
}

impl Metric {
    /// Measure of the columns of a nodal diameter, `2·unknowns × 6·places`.
    pub(super) fn of(rows: &Mat<f32>) -> Self {
        let mut products = Mat::<f32>::zeros(rows.nrows(), rows.nrows());
        matmul(products.as_mut(), Accum::Replace, rows, rows.transpose(), 1.0, Par::Seq);
        let of = |row: usize, column: usize| f64::from(products[(row, column)]);
        let unknowns = rows.nrows() / 2;
        let mut gram = Mat::from_fn(unknowns, unknowns, |k, l| {
            let (re, im) = ([2 * k, 2 * l], [2 * k + 1, 2 * l + 1]);
            c64::new(of(re[0], re[1]) + of(im[0], im[1]), of(re[0], im[1]) - of(im[0], re[1]))
        });
        let mean = (0..unknowns).map(|k| gram[(k, k)].re).sum::<f64>() / unknowns.max(1) as f64;
        (0..unknowns).for_each(|k| gram[(k, k)] += ADDED * mean);
        // Where nothing is stressed, energy alone orders as well.
        let lower = c64::lower_factor(gram.as_ref());
        Self { lower: lower.unwrap_or_else(|| Mat::identity(unknowns, unknowns)) }
    }

    /// Solves y = Fᴴ x̃ for the coordinates x̃ of the columns, in place.
    pub(super) fn coordinates(&self, y: MatMut<'_, c64>) {
        solve_upper_triangular_in_place(self.lower.adjoint(), y, Par::Seq);
    }

    /// Norms of all places.
    pub(super) fn norms(&self, rows: &Mat<f32>) -> Vec<Norm> {
        let unknowns = rows.nrows() / 2;
        let mut all = Mat::<c64>::identity(unknowns, unknowns);
        self.coordinates(all.as_mut());
        let padded = unknowns.next_multiple_of(LANES);
        let turned = turned(all.as_ref(), padded);
        let sums = Sums::new(&vec![1.0; unknowns], padded);
        let mut parts = vec![0.0f32; 12 * padded * BATCH];
        let mut norms = Vec::with_capacity(rows.ncols() / 6);
        for first in (0..rows.ncols()).step_by(6 * BATCH) {
            let batch = rows.subcols(first, (6 * BATCH).min(rows.ncols() - first));
            let parts = &mut parts[..2 * padded * batch.ncols()];
            let into = MatMut::from_column_major_slice_mut(parts, 2 * padded, batch.ncols());
            matmul(into, Accum::Replace, &turned, batch, 1.0, Par::Seq);
            for (place, parts) in parts.chunks_exact(12 * padded).enumerate() {
                let squares = sums.of(parts).squares;
                let whole = batch.subcols(6 * place, 6).squared_norm_l2();
                norms.push(Norm {
                    von_mises_squared: ROUNDED_UP * squares[0],
                    trace_squared: ROUNDED_UP * squares[1],
                    whole: (3.0 * f64::from(whole)).sqrt(),
                });
            }
        }
        norms
    }
}

/// Matrix that gives s·u for every column u of `directions`, from the real and imaginary parts of a row s: the real part of every product,
/// then the imaginary part, a row each, both padded with zeros to `padded` rows.
pub(super) fn turned(directions: MatRef<'_, c64>, padded: usize) -> Mat<f32> {
    Mat::from_fn(2 * padded, 2 * directions.nrows(), |row, column| {
        let k = row % padded;
        if k >= directions.ncols() {
            return 0.0;
        }
        let c64 { re, im } = directions[(column / 2, k)];
        (match (row / padded, column % 2) {
            (0, 0) => re,
            (0, _) => -im,
            (_, 0) => im,
            _ => re,
        }) as f32
    })
}
