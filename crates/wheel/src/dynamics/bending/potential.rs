//! Strain energy of third and fourth order in the coordinates of a sector.

use faer::Mat;

/// Energy V = Σ_ja B_ja p_j q_a + ½ Σ_ab A_ab q_a q_b of the products q of the coordinates p.
#[derive(Debug, Clone, PartialEq)]
pub struct Potential {
    /// B, `coordinates × products`.
    cubic: Mat<f64>,
    /// A, `products × products`, symmetric.
    quartic: Mat<f64>,
}

/// Products p_j p_k of so many coordinates, j ≤ k, in their order.
pub fn products(coordinates: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..coordinates).flat_map(move |j| (j..coordinates).map(move |k| (j, k)))
}

impl Potential {
    /// Potential of these B and A.
    ///
    /// # Panics
    /// If their sizes do not belong together.
    pub fn new(cubic: Mat<f64>, quartic: Mat<f64>) -> Self {
        let of_products = products(cubic.nrows()).count();
        assert_eq!([cubic.ncols(), quartic.nrows(), quartic.ncols()], [of_products; 3]);
        Self { cubic, quartic }
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.cubic.nrows()
    }

    /// Energy V at `p`.
    pub fn energy(&self, p: &[f64]) -> f64 {
        let q = || products(p.len()).map(|(j, k)| p[j] * p[k]);
        let mut energy = 0.0;
        for (a, qa) in q().enumerate() {
            let cubic: f64 = p.iter().zip(self.cubic.col_as_slice(a)).map(|(p, cubic)| cubic * p).sum();
            let quartic: f64 = q().zip(self.quartic.col_as_slice(a)).map(|(qb, quartic)| quartic * qb).sum();
            energy += qa * (cubic + 0.5 * quartic);
        }
        energy
    }

    /// Adds the force −∂V/∂p at `p` to `force`. `scratch` holds two numbers for each product.
    #[inline]
    pub(crate) fn add_force(&self, p: &[f64], force: &mut [f64], scratch: &mut [f64]) {
        let (q, y) = scratch.split_at_mut(scratch.len() / 2);
        for (q, (j, k)) in q.iter_mut().zip(products(p.len())) {
            *q = p[j] * p[k];
        }
        y.fill(0.0);
        for (b, &qb) in q.iter().enumerate() {
            let column = self.quartic.col_as_slice(b);
            for (y, a) in y.iter_mut().zip(column) {
                *y += a * qb;
            }
        }
        for (a, (y, &qa)) in y.iter_mut().zip(&*q).enumerate() {
            let column = self.cubic.col_as_slice(a);
            for ((p, cubic), force) in p.iter().zip(column).zip(&mut *force) {
                *y += cubic * p;
                *force -= cubic * qa;
            }
        }
        for (y, (j, k)) in y.iter().zip(products(p.len())) {
            force[j] -= y * p[k];
            force[k] -= y * p[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_the_derivative_of_the_energy() {
        let noise = |seed: usize| (seed as f64 * 12.9898).sin();
        for m in 1..5 {
            let of_products = products(m).count();
            let potential = Potential::new(
                Mat::from_fn(m, of_products, |i, a| noise(3 * i + 7 * a + 1)),
                Mat::from_fn(of_products, of_products, |a, b| noise(a * b + a + b + 40)),
            );
            let p: Vec<f64> = (0..m).map(|j| noise(j + 90)).collect();
            let mut force = vec![0.0; m];
            potential.add_force(&p, &mut force, &mut vec![0.0; 2 * of_products]);
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
        }
    }
}
