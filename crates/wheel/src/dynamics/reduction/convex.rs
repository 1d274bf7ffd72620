//! Lowest frequencies of the full sector between the given speeds, from its modes at them.
//!
//! Where K is linear in Ω², so are the matrices between two speeds convex sums: with s = (Ω/Ω1)²
//!
//! ```text
//! K(Ω) = (1 − s) K(0) + s K(Ω1) ≥ s K(Ω1)        rᴴ K(Ω)⁻¹ r ≤ rᴴ K(Ω1)⁻¹ r / s
//! ```
//!
//! Modes at the given speeds span those between them but for little, which inverse iterations with the factor at Ω1 supply; the same factor
//! bounds the error by the residual r. If no mode is missing at rest and at Ω1, that none is missing between follows from the sum of the
//! lowest m eigenvalues, the least trace of K on m directions, which is concave in s: where the first m − 1 of the computed ρ are
//! eigenvalues, all others lie above ρ_m − (Σρ − (1 − s) Σλ(0) − s Σλ(Ω1)). Where this is not conclusive, there is no result.

use faer::prelude::Reborrow;
use faer::sparse::SparseColMat;
use faer::{Mat, Scale, c64};

use super::modes::Modes;
use super::sector_factor::{SectorFactor, join, split};
use super::tied_factor::TiedFactor;
use super::untied::UntiedSector;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::orthonormal::orthonormal_basis;

/// Number of inverse iterations before giving up.
const ITERATIONS: usize = 6;
/// Singular value, as a share of the largest, below which a direction counts as round-off of the others.
const INDEPENDENT: f64 = 1e-5;

/// Pencils at some speeds between rest and the last one.
pub(super) struct Convex<'a> {
    pub(super) untied: &'a UntiedSector,
    pub(super) mass: &'a SparseColMat<usize, f64>,
    /// Stiffness K(0) and K(Ω1).
    pub(super) stiffness: [&'a SparseColMat<usize, f64>; 2],
    /// Factor of K(Ω1).
    pub(super) factor: &'a SectorFactor<'a>,
    /// Shares s = (Ω/Ω1)² of each speed.
    pub(super) shares: [f64; 2],
}

/// Directions in which modes are sought, with their images.
struct Trial {
    vectors: Mat<c64>,
    /// Images K(0) x and K(Ω1) x.
    stiffness: [Mat<c64>; 2],
    /// Image M x.
    mass: Mat<c64>,
}

impl Convex<'_> {
    /// Lowest eigenvalues, `count` of them, of one nodal diameter at each speed, from the full sector's modes at rest, between and at Ω1,
    /// of which there are more. The error of each in the norm of K(Ω)⁻¹, relative to Kx, is at most `tolerance`; its square is that of the
    /// eigenvalue. `None` where they are not proven.
    pub(super) fn lowest(
        &self,
        tied: &TiedFactor,
        known: [&Modes; 3],
        count: usize,
        tolerance: f64,
    ) -> [Option<Vec<f64>>; 2] {
        let most = known.iter().map(|modes| modes.values.len()).min().unwrap_or(0);
        if most <= count {
            return [None, None];
        }
        let mut trial = self.trial(tied, known[0].vectors.clone());
        for modes in &known[1..] {
            trial.extend(self.trial(tied, modes.vectors.clone()));
        }
        self.shares.map(|share| {
            let (values, exact) = self.converged(tied, &mut trial, share, most, count, tolerance)?;
            let ends = [&*known[0].values, &*known[2].values];
            complete(&values[..most.min(exact + 1)], ends, share, count, tolerance)
                .then(|| values[..count].to_vec())
        })
    }

    /// Lowest Ritz values, `most` of them, with the stiffness at `share`, once the first `count` are as exact as they must be, and the
    /// number of the first that are.
    fn converged(
        &self,
        tied: &TiedFactor,
        trial: &mut Trial,
        share: f64,
        most: usize,
        count: usize,
        tolerance: f64,
    ) -> Option<(Vec<f64>, usize)> {
        for _ in 0..ITERATIONS {
            let coefficients = trial.ritz(share, most)?;
            let vectors = &trial.vectors * &coefficients;
            let kx = &trial.stiffness[0] * (&coefficients * Scale(c64::new(1.0 - share, 0.0)))
                + &trial.stiffness[1] * (&coefficients * Scale(c64::new(share, 0.0)));
            let mx = &trial.mass * &coefficients;
            let energy: Vec<f64> = (0..most).map(|m| (vectors.col(m).adjoint() * kx.col(m)).re).collect();
            let quotient = |m: usize| energy[m] / (vectors.col(m).adjoint() * mx.col(m)).re;
            let values: Vec<f64> = (0..most).map(quotient).collect();
            let residuals = Mat::from_fn(kx.nrows(), most - 1, |i, m| kx[(i, m)] - mx[(i, m)] * values[m]);
            let mut loads = split(tied, residuals.as_ref());
            self.factor.half(&mut loads);
            let halves = join(&loads);
            let exact =
                |m: usize| halves.col(m).squared_norm_l2() / share <= tolerance * tolerance * energy[m];
            let doubtful: Vec<usize> = (0..count).filter(|&m| !exact(m)).collect();
            if doubtful.is_empty() {
                let exact = (0..most - 1).take_while(|&m| exact(m)).count();
                return Some((values, exact));
            }
            let halves = Mat::from_fn(halves.nrows(), doubtful.len(), |i, m| halves[(i, doubtful[m])]);
            let mut loads = split(tied, halves.as_ref());
            self.factor.half_adjoint(&mut loads);
            trial.extend(self.trial(tied, join(&loads)));
        }
        None
    }

    /// Directions of unit mass along `vectors`.
    fn trial(&self, tied: &TiedFactor, mut vectors: Mat<c64>) -> Trial {
        let mut mass = self.untied.product(self.mass, &tied.tie, vectors.as_ref());
        for (mut x, mut mx) in vectors.col_iter_mut().zip(mass.col_iter_mut()) {
            // Of different lengths, the short ones would be taken for round-off.
            let square = (x.rb().adjoint() * mx.rb()).re;
            let scale = Scale(c64::new(if square > 0.0 { square.sqrt().recip() } else { 0.0 }, 0.0));
            x *= scale;
            mx *= scale;
        }
        let stiffness = self.stiffness.map(|k| self.untied.product(k, &tied.tie, vectors.as_ref()));
        Trial { vectors, stiffness, mass }
    }
}

impl Trial {
    fn extend(&mut self, more: Self) {
        let [at_rest, at_speed] = &mut self.stiffness;
        let pairs = [
            (&mut self.vectors, &more.vectors),
            (at_rest, &more.stiffness[0]),
            (at_speed, &more.stiffness[1]),
            (&mut self.mass, &more.mass),
        ];
        for (all, more) in pairs {
            let known = all.ncols();
            all.resize_with(all.nrows(), known + more.ncols(), |i, j| more[(i, j - known)]);
        }
    }

    /// Coefficients of the `count` lowest Ritz vectors.
    fn ritz(&self, share: f64, count: usize) -> Option<Mat<c64>> {
        let gram = |images: &Mat<c64>| self.vectors.adjoint() * images;
        let m = gram(&self.mass);
        let k = gram(&self.stiffness[0]) * Scale(c64::new(1.0 - share, 0.0))
            + gram(&self.stiffness[1]) * Scale(c64::new(share, 0.0));
        let size = self.vectors.ncols();
        let basis = orthonormal_basis(Mat::identity(size, size).as_ref(), m.as_ref(), INDEPENDENT)?;
        let project = |matrix: &Mat<c64>| basis.adjoint() * matrix * &basis;
        let pairs = Dense::generalised_eigenpairs(project(&k).as_ref(), project(&m).as_ref()).ok()?;
        let found = pairs.values.len() >= count && pairs.values[0] > 0.0;
        found.then(|| &basis * pairs.vectors.subcols(0, count))
    }
}

/// Whether no eigenvalue is missing among the `count` lowest of `values`, all but the last of which are eigenvalues, given those at rest
/// and at Ω1; all to the square of `tolerance`.
fn complete(values: &[f64], ends: [&[f64]; 2], share: f64, count: usize, tolerance: f64) -> bool {
    (count + 1..=values.len()).any(|m| {
        let sum = |values: &[f64]| values[..m].iter().sum::<f64>();
        let least = (1.0 - tolerance * tolerance) * ((1.0 - share) * sum(ends[0]) + share * sum(ends[1]));
        values[m - 1] - (sum(values) - least) > values[count - 1]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight lines in s, whose end values are the eigenvalues summed.
    fn lines(slopes: &[(f64, f64)], share: f64) -> Vec<f64> {
        let mut values: Vec<f64> = slopes.iter().map(|(a, b)| a + share * (b - a)).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    #[test]
    fn a_missing_eigenvalue_is_seen() {
        let all = [(1.0, 1.5), (2.0, 2.2), (3.0, 3.3), (4.0, 4.1), (5.0, 5.2), (6.0, 6.1)];
        let ends = [lines(&all, 0.0), lines(&all, 1.0)];
        for share in [1.0 / 16.0, 9.0 / 16.0] {
            let found = lines(&all, share);
            assert!(complete(&found[..5], [&ends[0], &ends[1]], share, 4, 1e-4));
            for missing in 0..4 {
                let mut found = found.clone();
                found.remove(missing);
                assert!(!complete(&found, [&ends[0], &ends[1]], share, 4, 1e-4), "{share} {missing}");
            }
        }
    }

    /// Values beyond the last but one may be mixtures with a missing eigenvalue: they prove nothing.
    #[test]
    fn values_that_are_no_eigenvalues_prove_nothing() {
        let low = [0.1, 0.2, 0.3, 0.4];
        let truth = [&low[..], &[1.0], &[1.1; 6], &[10.0]].concat();
        let found = [&low[..], &[1.1; 6], &[1.2, 10.0]].concat();
        // Ten are exact, the eleventh is not: the twelfth must not be asked.
        assert!(!complete(&found[..11], [&truth, &truth], 0.5, 10, 1e-4));
        assert!(complete(&found, [&truth, &truth], 0.5, 10, 1e-4));
    }
}
