//! Strain energy of third and fourth order in the coordinates of a sector.

use faer::Mat;
use pulp::Simd;

/// Largest number of coordinates of a sector.
pub const MOST_COORDINATES: usize = 8;

/// Largest number of their products.
const MOST_PRODUCTS: usize = MOST_COORDINATES * (MOST_COORDINATES + 1) / 2;

/// Energy V = Σ_ja B_ja p_j q_a + ½ Σ_ab A_ab q_a q_b of the products q of the coordinates p.
#[derive(Debug, Clone, PartialEq)]
pub struct Potential {
    /// Number of coordinates.
    coordinates: usize,
    /// B, `[product][coordinate]`.
    cubic: Vec<f64>,
    /// A, `[product][product]`, symmetric.
    quartic: Vec<f64>,
    /// Coordinates of each product.
    products: Vec<(usize, usize)>,
}

/// Products p_j p_k of so many coordinates, j ≤ k, in their order.
pub fn products(coordinates: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..coordinates).flat_map(move |j| (j..coordinates).map(move |k| (j, k)))
}

impl Potential {
    /// Potential of B, `coordinates × products`, and A, `products × products` and symmetric.
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

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Energy V at `p`.
    pub fn energy(&self, p: &[f64]) -> f64 {
        self.energies(pulp::Scalar, &padded(p))
    }

    /// Force −∂V/∂p at `p`.
    pub fn force(&self, p: &[f64]) -> Vec<f64> {
        self.forces(pulp::Scalar, &padded(p))[..self.coordinates].to_vec()
    }

    /// Stiffness ∂²V/∂p² at `p`.
    pub fn stiffness(&self, p: &[f64]) -> Mat<f64> {
        let (m, count) = (self.coordinates, self.products.len());
        let q = self.products_of(pulp::Scalar, &padded(p));
        let mut stiffness = Mat::zeros(m, m);
        // ∂q_a/∂p has two entries, or one twice.
        let slopes = |a: usize| {
            let (j, k) = self.products[a];
            [(j, p[k]), (k, p[j])]
        };
        for (a, &(j, k)) in self.products.iter().enumerate() {
            let cubic = &self.cubic[a * m..][..m];
            let quartic = &self.quartic[a * count..][..count];
            let of_cubic: f64 = cubic.iter().zip(p).map(|(b, p)| b * p).sum();
            let slope = of_cubic + quartic.iter().zip(&q).map(|(a, q)| a * q).sum::<f64>();
            stiffness[(j, k)] += slope;
            stiffness[(k, j)] += slope;
            for (row, by) in slopes(a) {
                for (column, &cubic) in cubic.iter().enumerate() {
                    stiffness[(row, column)] += by * cubic;
                    stiffness[(column, row)] += by * cubic;
                }
                for (b, &quartic) in quartic.iter().enumerate() {
                    for (column, other) in slopes(b) {
                        stiffness[(row, column)] += by * quartic * other;
                    }
                }
            }
        }
        stiffness
    }

    /// Energy V of each lane of the coordinates `p`.
    #[inline(always)]
    pub(crate) fn energies<S: Simd>(&self, simd: S, p: &[S::f64s; MOST_COORDINATES]) -> S::f64s {
        let q = self.products_of(simd, p);
        let count = self.products.len();
        let mut energy = simd.splat_f64s(0.0);
        for a in 0..count {
            let mut slope = simd.splat_f64s(0.0);
            for (&quartic, &qb) in self.quartic[a * count..][..count].iter().zip(&q) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(0.5 * quartic), qb, slope);
            }
            for (&cubic, &p) in self.cubic[a * self.coordinates..][..self.coordinates].iter().zip(p) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(cubic), p, slope);
            }
            energy = simd.mul_add_e_f64s(slope, q[a], energy);
        }
        energy
    }

    /// Force −∂V/∂p of each lane of the coordinates `p`.
    #[inline(always)]
    pub(crate) fn forces<S: Simd>(
        &self,
        simd: S,
        p: &[S::f64s; MOST_COORDINATES],
    ) -> [S::f64s; MOST_COORDINATES] {
        let q = self.products_of(simd, p);
        let count = self.products.len();
        let mut force = [simd.splat_f64s(0.0); MOST_COORDINATES];
        for (a, &(j, k)) in self.products.iter().enumerate() {
            let mut slope = simd.splat_f64s(0.0);
            for (&quartic, &qb) in self.quartic[a * count..][..count].iter().zip(&q) {
                slope = simd.mul_add_e_f64s(simd.splat_f64s(quartic), qb, slope);
            }
            let cubic = &self.cubic[a * self.coordinates..][..self.coordinates];
            for ((&cubic, &p), force) in cubic.iter().zip(p).zip(&mut force) {
                let cubic = simd.splat_f64s(cubic);
                slope = simd.mul_add_e_f64s(cubic, p, slope);
                *force = simd.negate_mul_add_e_f64s(cubic, q[a], *force);
            }
            force[j] = simd.negate_mul_add_e_f64s(slope, p[k], force[j]);
            force[k] = simd.negate_mul_add_e_f64s(slope, p[j], force[k]);
        }
        force
    }

    #[inline(always)]
    fn products_of<S: Simd>(&self, simd: S, p: &[S::f64s; MOST_COORDINATES]) -> [S::f64s; MOST_PRODUCTS] {
        let mut q = [simd.splat_f64s(0.0); MOST_PRODUCTS];
        for (q, &(j, k)) in q.iter_mut().zip(&self.products) {
            *q = simd.mul_f64s(p[j], p[k]);
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

    #[test]
    fn force_and_stiffness_are_derivatives_of_the_energy() {
        let noise = |seed: usize| (seed as f64 * 12.9898).sin();
        for m in 1..5 {
            let of_products = products(m).count();
            let potential = Potential::new(
                &Mat::from_fn(m, of_products, |i, a| noise(3 * i + 7 * a + 1)),
                &Mat::from_fn(of_products, of_products, |a, b| noise(a * b + a + b + 40)),
            );
            let p: Vec<f64> = (0..m).map(|j| noise(j + 90)).collect();
            let force = potential.forces(pulp::Scalar, &padded(&p));
            for j in 0..m {
                let at = |by: f64| {
                    let mut moved = p.clone();
                    moved[j] += by;
                    potential.energy(&moved)
                };
                // Exact for a polynomial of fourth order.
                let h = 0.1;
                let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
                assert!((force[j] + slope).abs() < 1e-12, "{m} {j}: {} {slope}", force[j]);
            }
            let stiffness = potential.stiffness(&p);
            for column in 0..m {
                let at = |by: f64| {
                    let mut moved = p.clone();
                    moved[column] += by;
                    potential.force(&moved)
                };
                let h = 0.1;
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|steps| at(steps * h));
                for row in 0..m {
                    let slope = (8.0 * (c[row] - b[row]) - (d[row] - a[row])) / (12.0 * h);
                    assert!((stiffness[(row, column)] + slope).abs() < 1e-11, "{m} {row} {column}");
                }
            }
        }
    }
}
