//! Centrifugal stiffening K(Ω) = K0 + Ω²K1 + Ω⁴K2 through the given speeds (docs/method.md, Centrifugal stiffening; Eq. 3).

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::sector::{CyclicMatrix, SectorModel};
use rubmap_numerics::matrix_serde;

/// Polynomial of one Hermitian matrix through three speeds 0 < Ω_a < Ω_b, by divided differences in x = Ω². For Ω_a = Ω_b/2 these are the
/// paper's formulae.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StiffnessPolynomial {
    /// Coefficients K0, then K1 and K2 where the model has stiffening.
    #[serde(with = "matrix_serde::list")]
    pub coefficients: Vec<Mat<c64>>,
}

impl StiffnessPolynomial {
    /// Fits `stiffness`, the matrices at `speeds_rad_s`: one (no stiffening) or three.
    pub fn fit(stiffness: Vec<Mat<c64>>, speeds_rad_s: &[f64]) -> Self {
        let [_, a, b] = *speeds_rad_s else {
            return Self { coefficients: stiffness };
        };
        let (xa, xb) = (a * a, b * b);
        let [k0, ka, kb]: [Mat<c64>; 3] =
            stiffness.try_into().unwrap_or_else(|_| unreachable!("one stiffness per speed"));
        let slope_a = Mat::from_fn(k0.nrows(), k0.ncols(), |i, j| (ka[(i, j)] - k0[(i, j)]) / xa);
        let slope_b = Mat::from_fn(k0.nrows(), k0.ncols(), |i, j| (kb[(i, j)] - k0[(i, j)]) / xb);
        let k2 = Mat::from_fn(k0.nrows(), k0.ncols(), |i, j| (slope_b[(i, j)] - slope_a[(i, j)]) / (xb - xa));
        let k1 = Mat::from_fn(k0.nrows(), k0.ncols(), |i, j| slope_a[(i, j)] - k2[(i, j)] * xa);
        Self { coefficients: vec![k0, k1, k2] }
    }

    /// Stiffness K(Ω), or K0 where `stiffening` is off.
    pub fn at(&self, speed_rad_s: f64, stiffening: bool) -> Mat<c64> {
        let x = speed_rad_s * speed_rad_s;
        match (self.coefficients.as_slice(), stiffening) {
            ([k0, k1, k2], true) => {
                Mat::from_fn(k0.nrows(), k0.ncols(), |i, j| k0[(i, j)] + (k1[(i, j)] + k2[(i, j)] * x) * x)
            }
            (coefficients, _) => coefficients[0].clone(),
        }
    }
}

/// Terms of K(Ω) of the full sector as a sum over its given matrices: weights of the polynomial in Ω² through them.
pub(super) fn stiffness_terms(sector: &SectorModel, speed_rad_s: f64) -> Vec<(f64, &CyclicMatrix)> {
    let x: Vec<f64> = sector.speeds_rad_s.iter().map(|speed| speed * speed).collect();
    let at = speed_rad_s * speed_rad_s;
    let weight =
        |i: usize| (0..x.len()).filter(|&j| j != i).map(|j| (at - x[j]) / (x[i] - x[j])).product::<f64>();
    sector.stiffness.iter().enumerate().map(|(i, matrix)| (weight(i), matrix)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(seed: f64) -> Mat<c64> {
        let entry =
            |i: usize, j: usize| c64::new((seed + (i * j) as f64).sin(), seed * (i as f64 - j as f64));
        Mat::from_fn(6, 6, |i, j| entry(i, j) + entry(j, i).conj())
    }

    #[test]
    fn reproduces_the_given_matrices_to_round_off() {
        let omega = 5000.0;
        let given = [matrix(1.0), matrix(2.0), matrix(3.0)];
        let fit = StiffnessPolynomial::fit(given.to_vec(), &[0.0, omega / 2.0, omega]);
        for (k, speed) in given.iter().zip([0.0, omega / 2.0, omega]) {
            // Three terms of up to 16 |K| cancel to K.
            assert!((fit.at(speed, true) - k).norm_max() < 1e-14 * 16.0 * 6.0);
        }
        let paper_k1 = Mat::from_fn(6, 6, |i, j| {
            (given[1][(i, j)] * 16.0 - given[2][(i, j)] - given[0][(i, j)] * 15.0) / (3.0 * omega * omega)
        });
        let paper_k2 = Mat::from_fn(6, 6, |i, j| {
            (given[2][(i, j)] - given[1][(i, j)] * 4.0 + given[0][(i, j)] * 3.0) * 4.0 / (3.0 * omega.powi(4))
        });
        assert!((&fit.coefficients[1] - paper_k1).norm_max() * omega.powi(2) < 1e-12);
        assert!((&fit.coefficients[2] - paper_k2).norm_max() * omega.powi(4) < 1e-12);
    }
}
