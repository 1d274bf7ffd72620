//! Floquet multipliers: the eigenvalues of the derivative of the map at a periodic motion, by which disturbances grow from one map to the next.

use faer::{Mat, c64};

use super::tangent::Tangent;
use rubmap_numerics::arnoldi;
use rubmap_numerics::dense::{Eigenpair, real_eigenpairs};

/// Size of a state up to which all multipliers are found at once.
const DENSE: usize = 100;

/// Share of every unknown, relative to the largest of the hint, in the vector that the search begins with.
const EVENLY: f64 = 1e-3;

/// Residual, relative to the value, at which the leading pair counts as found; the others are found to ten times as much.
const TOLD: f64 = 1e-3;

/// Residual, relative to the distance from neutral growth |μ| = 1, at which the leading pair counts as found.
const CERTAIN: f64 = 0.05;

/// Largest number of products in the search for the largest multipliers.
pub const MOST_PRODUCTS: usize = 200;

/// Floquet multiplier with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Multiplier {
    /// Multiplier μ; of a complex pair both are listed.
    pub value: c64,
    /// Residual ‖T v − μ v‖ / ‖v‖.
    pub residual: f64,
    /// Share of every nodal diameter in the growing disturbance, by energy.
    pub shares: Vec<f64>,
    /// Growing disturbance, as a state.
    pub vector: Vec<c64>,
}

/// Largest multipliers, `count` or one more, as far as they were found, with their residuals. `hint`: a state with a share of the
/// disturbance that grows most.
pub fn multipliers(tangent: &Tangent<'_>, count: usize, hint: &[f64]) -> Vec<Multiplier> {
    let size = tangent.size();
    if size == 0 {
        return Vec::new();
    }
    let pairs = if size <= DENSE { all(tangent) } else { largest(tangent, count, hint) };
    let mut found: Vec<_> = pairs.into_iter().map(|(value, v)| multiplier(tangent, value, v)).collect();
    found.sort_by(|a, b| b.value.norm().total_cmp(&a.value.norm()));
    let half = found.get(count).is_some_and(|next| next.value == found[count - 1].value.conj());
    found.truncate(count + usize::from(half));
    found
}

fn all(tangent: &Tangent<'_>) -> Vec<(c64, Vec<c64>)> {
    let mut matrix = Mat::<f64>::identity(tangent.size(), tangent.size());
    tangent.apply(matrix.as_mut());
    let pairs = real_eigenpairs(matrix.as_ref()).unwrap_or_default();
    pairs.into_iter().map(|Eigenpair { value, vector }| (value, vector)).collect()
}

fn largest(tangent: &Tangent<'_>, count: usize, hint: &[f64]) -> Vec<(c64, Vec<c64>)> {
    // And all unknowns alike: none of them is left out.
    let scale = hint.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let start: Vec<f64> = hint.iter().map(|x| x / scale + EVENLY).collect();
    let product = |x: &[f64]| {
        let mut image = x.to_vec();
        tangent.follow(&mut image);
        image
    };
    let enough = |place: usize, value: c64, residual: f64| {
        let told = TOLD * value.norm();
        residual <= if place < 2 { told.min(CERTAIN * (1.0 - value.norm()).abs()) } else { 10.0 * told }
    };
    let found = arnoldi::largest(product, &start, count, MOST_PRODUCTS, enough);
    found.into_iter().map(|pair| (pair.value, pair.vector)).collect()
}

fn multiplier(tangent: &Tangent<'_>, value: c64, vector: Vec<c64>) -> Multiplier {
    let image = image(tangent, &vector);
    let left: Vec<c64> = vector.iter().zip(&image).map(|(v, image)| image - value * v).collect();
    let whole = squared(&vector);
    let shares = tangent.shares(|i| vector[i].norm_sqr()).into_iter().map(|share| share / whole).collect();
    Multiplier { value, residual: (squared(&left) / whole).sqrt(), shares, vector }
}

fn image(tangent: &Tangent<'_>, vector: &[c64]) -> Vec<c64> {
    let mut parts =
        Mat::from_fn(vector.len(), 2, |i, part| if part == 0 { vector[i].re } else { vector[i].im });
    tangent.apply(parts.as_mut());
    (0..vector.len()).map(|i| c64::new(parts[(i, 0)], parts[(i, 1)])).collect()
}

fn squared(vector: &[c64]) -> f64 {
    vector.iter().map(|value| value.norm_sqr()).sum()
}
