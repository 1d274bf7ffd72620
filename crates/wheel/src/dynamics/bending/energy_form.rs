//! Energies of a blade that bends far beyond the quadratic ones, of third and fourth order in the coordinates of its sector.

use faer::{Mat, MatRef};
use pulp::Simd;

/// Largest number of coordinates of a sector.
pub const MOST_COORDINATES: usize = 8;

/// Largest number of products of the coordinates of a sector.
pub(crate) const MOST_PRODUCTS: usize = MOST_COORDINATES * (MOST_COORDINATES + 1) / 2;

/// Form Σ_ja B_ja x_j y_a + ½ Σ_ab A_ab y_a y_b of vectors x of coordinates and y of products. With p and q = pp it is the strain energy V, with
/// ṗ and q̇ the kinetic energy T, each beyond the quadratic one.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyForm {
    /// Number of coordinates.
    coordinates: usize,
    /// B, `[product][coordinate]`.
    cubic: Vec<f64>,
    /// A, `[product][product]`, symmetric.
    quartic: Vec<f64>,
    /// Coordinates of each product.
    products: Vec<(usize, usize)>,
}

/// Motion of a blade at an instant: coordinates, velocities and accelerations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<'a> {
    pub(crate) p: &'a [f64],
    pub(crate) velocity: &'a [f64],
    pub(crate) acceleration: &'a [f64],
}

/// Derivatives of a force by the acceleration, the velocity and the coordinates.
#[derive(Debug, Clone)]
pub(crate) struct Derivatives {
    pub(crate) by_acceleration: Mat<f64>,
    pub(crate) by_velocity: Mat<f64>,
    pub(crate) by_coordinates: Mat<f64>,
}

/// Index pairs (j, k), j ≤ k, of the products p_j p_k of so many coordinates, row by row.
pub fn products(coordinates: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..coordinates).flat_map(move |j| (j..coordinates).map(move |k| (j, k)))
}

impl EnergyForm {
    /// Form of B, `coordinates × products`, and A, `products × products` and symmetric.
    ///
    /// # Panics
    /// If their sizes do not belong together, or there are more than [`MOST_COORDINATES`].
    pub fn new(cubic: &Mat<f64>, quartic: &Mat<f64>) -> Self {
        let (coordinates, products) = (cubic.nrows(), products(cubic.nrows()).collect::<Vec<_>>());
        assert!(coordinates <= MOST_COORDINATES);
        assert_eq!([cubic.ncols(), quartic.nrows(), quartic.ncols()], [products.len(); 3]);
        let in_columns = |of: &Mat<f64>| of.col_iter().flat_map(|column| column.iter().copied()).collect();
        Self { coordinates, cubic: in_columns(cubic), quartic: in_columns(quartic), products }
    }

    /// Form without any coefficients.
    pub fn zero(coordinates: usize) -> Self {
        let count = products(coordinates).count();
        Self::new(&Mat::zeros(coordinates, count), &Mat::zeros(count, count))
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Coordinates of each product.
    pub(crate) fn products(&self) -> &[(usize, usize)] {
        &self.products
    }

    /// Strain energy V at `p`.
    pub fn energy(&self, p: &[f64]) -> f64 {
        let p = padded(p);
        self.values(pulp::Scalar, &p, &self.products_of(&p))
    }

    /// Kinetic energy T at `p` and the velocity ṗ.
    pub fn kinetic_energy(&self, p: &[f64], velocity: &[f64]) -> f64 {
        let mut rates = [0.0; MOST_PRODUCTS];
        for (rate, &(j, k)) in rates.iter_mut().zip(&self.products) {
            *rate = p[j] * velocity[k] + p[k] * velocity[j];
        }
        self.values(pulp::Scalar, &padded(velocity), &rates)
    }

    /// Force −∂V/∂p at `p`.
    pub fn force(&self, p: &[f64]) -> Vec<f64> {
        let p = padded(p);
        let mut force = [0.0; MOST_COORDINATES];
        self.add_forces(pulp::Scalar, &p, &p, &self.products_of(&p), &mut force);
        force[..self.coordinates].to_vec()
    }

    /// Force −d/dt ∂T/∂ṗ + ∂T/∂p in a motion.
    pub(crate) fn inertia_force(&self, motion: Motion<'_>) -> Vec<f64> {
        let mut force = [0.0; MOST_COORDINATES];
        let (p, acceleration) = (padded(motion.p), padded(motion.acceleration));
        self.add_forces(pulp::Scalar, &p, &acceleration, &self.second_rates(motion), &mut force);
        force[..self.coordinates].to_vec()
    }

    /// Second time derivatives q̈ of the products.
    fn second_rates(&self, Motion { p, velocity: v, acceleration: a }: Motion<'_>) -> [f64; MOST_PRODUCTS] {
        let mut rates = [0.0; MOST_PRODUCTS];
        for (rate, &(j, k)) in rates.iter_mut().zip(&self.products) {
            *rate = a[j] * p[k] + 2.0 * v[j] * v[k] + p[j] * a[k];
        }
        rates
    }

    /// Stiffness ∂²V/∂p² at `p`.
    pub fn stiffness(&self, p: &[f64]) -> Mat<f64> {
        let q = self.products_of(&padded(p));
        let curved = self.curved(p, &q);
        let slopes = self.slopes(p);
        let cubic = self.cubic_matrix() * &slopes;
        curved + &cubic + cubic.transpose() + slopes.transpose() * self.quartic_matrix() * &slopes
    }

    /// Derivatives of −[`Self::inertia_force`] in a motion.
    pub(crate) fn inertia_derivatives(&self, motion: Motion<'_>) -> Derivatives {
        let slopes = self.slopes(motion.p);
        let cubic = self.cubic_matrix();
        let by_rates = cubic + slopes.transpose() * self.quartic_matrix();
        let accelerated = &by_rates * self.slopes(motion.acceleration);
        Derivatives {
            by_acceleration: &by_rates * &slopes + slopes.transpose() * cubic.transpose(),
            by_velocity: 2.0 * (&by_rates * self.slopes(motion.velocity)),
            by_coordinates: self.curved(motion.acceleration, &self.second_rates(motion)) + accelerated,
        }
    }

    /// Matrix Σ_a (Bᵀx + A y)_a ∂²q_a/∂p².
    fn curved(&self, x: &[f64], y: &[f64]) -> Mat<f64> {
        let mut curved = Mat::zeros(self.coordinates, self.coordinates);
        let (cubic, quartic) = (self.cubic_matrix(), self.quartic_matrix());
        for (a, &(j, k)) in self.products.iter().enumerate() {
            let of_cubic: f64 = cubic.col(a).iter().zip(x).map(|(b, x)| b * x).sum();
            let slope = of_cubic + quartic.col(a).iter().zip(y).map(|(a, y)| a * y).sum::<f64>();
            curved[(j, k)] += slope;
            curved[(k, j)] += slope;
        }
        curved
    }

    /// ∂q/∂p at `p`, `products × coordinates`.
    fn slopes(&self, p: &[f64]) -> Mat<f64> {
        let mut slopes = Mat::zeros(self.products.len(), self.coordinates);
        for (a, &(j, k)) in self.products.iter().enumerate() {
            slopes[(a, j)] += p[k];
            slopes[(a, k)] += p[j];
        }
        slopes
    }

    fn cubic_matrix(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.cubic, self.coordinates, self.products.len())
    }

    fn quartic_matrix(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.quartic, self.products.len(), self.products.len())
    }

    /// Value of the form in each lane of `x` and `y`.
    #[inline(always)]
    pub(crate) fn values<S: Simd>(
        &self,
        simd: S,
        x: &[S::f64s; MOST_COORDINATES],
        y: &[S::f64s; MOST_PRODUCTS],
    ) -> S::f64s {
        let count = self.products.len();
        let mut value = simd.splat_f64s(0.0);
        for a in 0..count {
            let mut slope = simd.splat_f64s(0.0);
            for (&quartic, &yb) in self.quartic[a * count..][..count].iter().zip(y) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(0.5 * quartic), yb, slope);
            }
            for (&cubic, &x) in self.cubic[a * self.coordinates..][..self.coordinates].iter().zip(x) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(cubic), x, slope);
            }
            value = simd.mul_add_e_f64s(slope, y[a], value);
        }
        value
    }

    /// Adds −B y − (∂q/∂p)ᵀ (Bᵀx + A y) to the forces, in each lane: −∂V/∂p where x = p and y = q, the force of inertia where x = p̈ and y = q̈.
    #[inline(always)]
    pub(crate) fn add_forces<S: Simd>(
        &self,
        simd: S,
        p: &[S::f64s; MOST_COORDINATES],
        x: &[S::f64s; MOST_COORDINATES],
        y: &[S::f64s; MOST_PRODUCTS],
        force: &mut [S::f64s; MOST_COORDINATES],
    ) {
        let count = self.products.len();
        for (a, &(j, k)) in self.products.iter().enumerate() {
            let mut slope = simd.splat_f64s(0.0);
            for (&quartic, &yb) in self.quartic[a * count..][..count].iter().zip(y) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(quartic), yb, slope);
            }
            let cubic = &self.cubic[a * self.coordinates..][..self.coordinates];
            for ((&cubic, &x), force) in cubic.iter().zip(x).zip(&mut *force) {
                let cubic = simd.splat_f64s(cubic);
                slope = simd.mul_add_e_f64s(cubic, x, slope);
                *force = simd.negate_mul_add_e_f64s(cubic, y[a], *force);
            }
            force[j] = simd.negate_mul_add_e_f64s(slope, p[k], force[j]);
            force[k] = simd.negate_mul_add_e_f64s(slope, p[j], force[k]);
        }
    }

    /// Products q of the coordinates `p`.
    fn products_of(&self, p: &[f64; MOST_COORDINATES]) -> [f64; MOST_PRODUCTS] {
        let mut q = [0.0; MOST_PRODUCTS];
        for (q, &(j, k)) in q.iter_mut().zip(&self.products) {
            *q = p[j] * p[k];
        }
        q
    }
}

fn padded(p: &[f64]) -> [f64; MOST_COORDINATES] {
    let mut padded = [0.0; MOST_COORDINATES];
    padded[..p.len()].copy_from_slice(p);
    padded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(seed: usize) -> f64 {
        (seed as f64 * 12.9898).sin()
    }

    fn form(m: usize) -> EnergyForm {
        let count = products(m).count();
        EnergyForm::new(
            &Mat::from_fn(m, count, |i, a| noise(3 * i + 7 * a + 1)),
            &Mat::from_fn(count, count, |a, b| noise(a * b + a + b + 40)),
        )
    }

    /// Slope of a polynomial of fourth order at 0: exact.
    fn slope(at: impl Fn(f64) -> f64) -> f64 {
        let h = 0.1;
        (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
    }

    fn moved(p: &[f64], j: usize, by: f64) -> Vec<f64> {
        let mut moved = p.to_vec();
        moved[j] += by;
        moved
    }

    fn vector(m: usize, seed: usize) -> Vec<f64> {
        (0..m).map(|j| noise(j + seed)).collect()
    }

    #[test]
    fn force_and_stiffness_are_derivatives_of_the_energy() {
        for m in 1..5 {
            let (form, p) = (form(m), vector(m, 90));
            let (force, stiffness) = (form.force(&p), form.stiffness(&p));
            for j in 0..m {
                let expected = slope(|by| form.energy(&moved(&p, j, by)));
                assert!((force[j] + expected).abs() < 1e-12, "{m} {j}: {} {expected}", force[j]);
                for row in 0..m {
                    let expected = slope(|by| form.force(&moved(&p, j, by))[row]);
                    assert!((stiffness[(row, j)] + expected).abs() < 1e-11, "{m} {row} {j}");
                }
            }
        }
    }

    #[test]
    fn the_force_of_inertia_is_that_of_lagrange() {
        // p(t) = p + vt + at²/2: d/dt ∂T/∂ṗ at t = 0 by differences, of a polynomial in t and in each velocity.
        for m in 1..5 {
            let (form, [p, v, a]) = (form(m), [90, 130, 170].map(|seed| vector(m, seed)));
            let at = |t: f64| -> (Vec<f64>, Vec<f64>) {
                let p = (0..m).map(|j| p[j] + t * (v[j] + 0.5 * t * a[j])).collect();
                (p, (0..m).map(|j| v[j] + t * a[j]).collect())
            };
            let motion = Motion { p: &p, velocity: &v, acceleration: &a };
            let force = form.inertia_force(motion);
            let Derivatives { by_acceleration, by_velocity, by_coordinates } =
                form.inertia_derivatives(motion);
            for j in 0..m {
                let momentum = |t: f64| {
                    let (p, v) = at(t);
                    slope(|by| form.kinetic_energy(&p, &moved(&v, j, by)))
                };
                // The momentum is of fifth order in t, the difference exact to fourth: short steps.
                let h = 1e-3;
                let rate = (8.0 * (momentum(h) - momentum(-h)) - (momentum(2.0 * h) - momentum(-2.0 * h)))
                    / (12.0 * h);
                let expected = slope(|by| form.kinetic_energy(&moved(&p, j, by), &v)) - rate;
                assert!((force[j] / expected - 1.0).abs() < 1e-7, "{m} {j}: {} {expected}", force[j]);
                for row in 0..m {
                    let of = |motion: Motion<'_>| -form.inertia_force(motion)[row];
                    let expected = [
                        slope(|by| of(Motion { acceleration: &moved(&a, j, by), ..motion })),
                        slope(|by| of(Motion { velocity: &moved(&v, j, by), ..motion })),
                        slope(|by| of(Motion { p: &moved(&p, j, by), ..motion })),
                    ];
                    let found = [&by_acceleration, &by_velocity, &by_coordinates].map(|of| of[(row, j)]);
                    for (found, expected) in found.iter().zip(expected) {
                        assert!((found - expected).abs() < 1e-10, "{m} {row} {j}: {found} {expected}");
                    }
                }
            }
        }
    }
}
