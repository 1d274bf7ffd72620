//! Strain energy of an element that moves far: Green–Lagrange strain, linear elastic material (St. Venant–Kirchhoff).
//!
//! ```text
//! H = ∂u/∂x     E = ½ (H + Hᵀ + HᵀH)     S = λ tr(E) 1 + 2μ E
//! V(u) = ∫ ½ S : E dV     f_a = ∂V/∂u_a = ∫ (1 + H) S ∇N_a dV     V(u + t d) = Σ_k c_k t^k, k = 0 … 4, exactly
//! ```
//!
//! Integrals are sums over the points of the stiffness, so that the quadratic part of V is ½ uᵀK u to round-off.
//!
//! Incompatible modes are α = R u + β: they follow the nodes as in the stiffness (R of [`crate::integrals`]), and β is their own
//! non-linear part. In (u, β) the quadratic part of V is ½ uᵀK u + ½ βᵀK_αα β, without a mixed term.

use nalgebra::{Cholesky, Const, DMatrix, Matrix3, SMatrix, SVector, Vector3};

use crate::element::ElementKind;
use crate::gradients::{Gradients, Recovery};
use crate::material::Lame;

/// Number of incompatible modes (bubble functions) of an element; each has a vector as its coefficient.
pub const BUBBLES: usize = 3;

/// Element with the gradients of its functions.
#[derive(Debug)]
pub struct GreenLagrange {
    constants: Lame,
    gradients: Gradients,
    bubbles: Option<Box<Bubbles>>,
}

/// Incompatible modes of an element.
#[derive(Debug)]
struct Bubbles {
    recovery: Recovery,
    /// Factor of K_αα; none where it is not definite, as in [`Gradients::recovery`].
    factor: Option<Cholesky<f64, Const<9>>>,
}

impl GreenLagrange {
    /// Element of these node positions; it must be whole ([`crate::defect`]).
    pub fn of(kind: ElementKind, positions: &[[f64; 3]], constants: Lame) -> Self {
        let gradients = Gradients::of(kind, positions);
        let bubbles = kind.has_bubbles().then(|| {
            let elastic = gradients.elastic(constants);
            let entry = |row: usize, column: usize| elastic[(row / 3, column / 3)][(row % 3, column % 3)];
            let k_aa = SMatrix::<f64, 9, 9>::from_fn(|i, j| entry(24 + i, 24 + j));
            Box::new(Bubbles { recovery: Gradients::recovery(&elastic), factor: k_aa.cholesky() })
        });
        Self { constants, gradients, bubbles }
    }

    /// Whether the element has incompatible modes.
    pub fn has_bubbles(&self) -> bool {
        self.bubbles.is_some()
    }

    /// Bytes of an element of this kind.
    pub fn bytes(kind: ElementKind) -> usize {
        let bubbles = if kind.has_bubbles() { BUBBLES } else { 0 };
        let vectors = crate::rule::points(kind).len() * (kind.nodes() + bubbles);
        size_of::<Self>() + vectors * size_of::<Vector3<f64>>() + bubbles / BUBBLES * size_of::<Bubbles>()
    }

    /// Values of all functions for displacements of the nodes and, where the element has incompatible modes, their β.
    pub fn values(&self, nodes: &[Vector3<f64>], beta: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        let mut values = nodes.to_vec();
        if let Some(bubbles) = &self.bubbles {
            let alpha = bubbles.recovery * SVector::<f64, 24>::from_fn(|d, _| nodes[d / 3][d % 3]);
            values.extend((0..BUBBLES).map(|b| alpha.fixed_rows::<3>(3 * b) + beta[b]));
        }
        values
    }

    /// Energy of the linear strain, ½ uᵀK u.
    pub fn linear_energy(&self, values: &[Vector3<f64>]) -> f64 {
        let at = |h: Matrix3<f64>| {
            let strain = (h + h.transpose()) * 0.5;
            0.5 * self.product(&strain, &strain)
        };
        self.points().map(|(gradients, volume)| volume * at(gradient(values, gradients))).sum()
    }

    /// Strain energy V under Green–Lagrange strain.
    pub fn energy(&self, values: &[Vector3<f64>]) -> f64 {
        let at = |h: Matrix3<f64>| {
            let strain = strain(&h);
            0.5 * self.product(&strain, &strain)
        };
        self.points().map(|(gradients, volume)| volume * at(gradient(values, gradients))).sum()
    }

    /// Derivatives of V by the displacements of the nodes, through R as well, and behind them those by β.
    pub fn force(&self, values: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        let nominal = |h: Matrix3<f64>| {
            let stress = self.stress(&strain(&h));
            stress + h * stress
        };
        let mut force = self.against(values, nominal);
        self.add_through_bubbles(&mut force);
        force
    }

    /// Part of second order of the force, on the nodes and by β: G(a, b), symmetric, so that G(u, u) is the part of [`Self::force`] at u that is
    /// quadratic in u.
    pub fn second_order_force(&self, a: &[Vector3<f64>], b: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        let mut force = vec![Vector3::zeros(); a.len()];
        for (gradients, volume) in self.points() {
            let (a, b) = (gradient(a, gradients), gradient(b, gradients));
            let symmetric = |h: Matrix3<f64>| (h + h.transpose()) * 0.5;
            let nominal = self.stress(&(symmetric(a.transpose() * b) * 0.5))
                + (a * self.stress(&symmetric(b)) + b * self.stress(&symmetric(a))) * 0.5;
            for (force, gradient) in force.iter_mut().zip(gradients) {
                *force += nominal * gradient * volume;
            }
        }
        self.add_through_bubbles(&mut force);
        force
    }

    /// Parts of third and fourth order of V(Σ p_j u_j) for the shapes u: B and A of Σ_ja B_ja p_j q_a + ½ Σ_ab A_ab q_a q_b, q the products
    /// p_j p_k in the order (0, 0), (0, 1), …, (1, 1), ….
    pub fn energy_products(&self, shapes: &[Vec<Vector3<f64>>]) -> (DMatrix<f64>, DMatrix<f64>) {
        let pairs: Vec<_> = (0..shapes.len()).flat_map(|j| (j..shapes.len()).map(move |k| (j, k))).collect();
        let mut cubic = DMatrix::zeros(shapes.len(), pairs.len());
        let mut quartic = DMatrix::zeros(pairs.len(), pairs.len());
        for (gradients, volume) in self.points() {
            let h: Vec<_> = shapes.iter().map(|shape| gradient(shape, gradients)).collect();
            let of_pair = |&(j, k): &(usize, usize)| {
                let product = h[j].transpose() * h[k];
                if j == k { product * 0.5 } else { (product + product.transpose()) * 0.5 }
            };
            let strains: Vec<_> = pairs.iter().map(of_pair).collect();
            for (a, strain) in strains.iter().enumerate() {
                let stress = self.stress(strain) * volume;
                for (j, h) in h.iter().enumerate() {
                    cubic[(j, a)] += stress.dot(h);
                }
                for (b, other) in strains.iter().enumerate() {
                    quartic[(a, b)] += stress.dot(other);
                }
            }
        }
        (cubic, quartic)
    }

    /// Adds to a force on all functions what acts on the nodes through the incompatible modes.
    fn add_through_bubbles(&self, force: &mut [Vector3<f64>]) {
        let Some(bubbles) = &self.bubbles else { return };
        let nodes = force.len() - BUBBLES;
        let of_alpha = SVector::<f64, 9>::from_fn(|d, _| force[nodes + d / 3][d % 3]);
        let through = bubbles.recovery.tr_mul(&of_alpha);
        for (node, force) in force[..nodes].iter_mut().enumerate() {
            *force += through.fixed_rows::<3>(3 * node);
        }
    }

    /// Linear part K u of the force on the nodes, for values whose β is zero.
    pub fn linear_force(&self, values: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        self.against(values, |h| self.stress(&((h + h.transpose()) * 0.5)))
    }

    /// Coefficients of V(u + t d) in powers of t, from 0 to 4.
    pub fn line(&self, values: &[Vector3<f64>], along: &[Vector3<f64>]) -> [f64; 5] {
        let mut sums = [0.0; 5];
        for (gradients, volume) in self.points() {
            let (h, d) = (gradient(values, gradients), gradient(along, gradients));
            let mixed = d + h.transpose() * d;
            let e = [strain(&h), (mixed + mixed.transpose()) * 0.5, d.transpose() * d * 0.5];
            let product = |i: usize, j: usize| self.product(&e[i], &e[j]);
            let of_point = [
                0.5 * product(0, 0),
                product(0, 1),
                0.5 * product(1, 1) + product(0, 2),
                product(1, 2),
                0.5 * product(2, 2),
            ];
            sums.iter_mut().zip(of_point).for_each(|(sum, part)| *sum += volume * part);
        }
        sums
    }

    /// Solution K_αα⁻¹ f for a force on β; zero where K_αα is not definite or there are no incompatible modes.
    pub fn solve_bubbles(&self, force: &[Vector3<f64>]) -> [Vector3<f64>; BUBBLES] {
        let factor = self.bubbles.as_ref().and_then(|bubbles| bubbles.factor.as_ref());
        let Some(factor) = factor else { return [Vector3::zeros(); BUBBLES] };
        let solved = factor.solve(&SVector::<f64, 9>::from_fn(|d, _| force[d / 3][d % 3]));
        std::array::from_fn(|b| solved.fixed_rows::<3>(3 * b).into())
    }

    /// Forces `∫ P ∇N_a dV` on all functions, where `nominal` gives the nominal stress P at a displacement gradient.
    fn against(
        &self,
        values: &[Vector3<f64>],
        nominal: impl Fn(Matrix3<f64>) -> Matrix3<f64>,
    ) -> Vec<Vector3<f64>> {
        let mut force = vec![Vector3::zeros(); values.len()];
        for (gradients, volume) in self.points() {
            let nominal = nominal(gradient(values, gradients)) * volume;
            for (force, gradient) in force.iter_mut().zip(gradients) {
                *force += nominal * gradient;
            }
        }
        force
    }

    fn stress(&self, strain: &Matrix3<f64>) -> Matrix3<f64> {
        let Lame { lambda, mu } = self.constants;
        Matrix3::from_diagonal_element(lambda * strain.trace()) + strain * (2.0 * mu)
    }

    fn points(&self) -> impl Iterator<Item = (&[Vector3<f64>], f64)> {
        let Gradients { at_points, volumes } = &self.gradients;
        at_points.iter().map(Vec::as_slice).zip(volumes.iter().copied())
    }

    /// Product `λ tr(a) tr(b) + 2μ a : b` of symmetric strains.
    fn product(&self, a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
        let Lame { lambda, mu } = self.constants;
        lambda * a.trace() * b.trace() + 2.0 * mu * a.dot(b)
    }
}

/// Displacement gradient `H = Σ u_a ∇N_aᵀ`.
fn gradient(values: &[Vector3<f64>], gradients: &[Vector3<f64>]) -> Matrix3<f64> {
    let mut h = Matrix3::zeros();
    for (u, g) in values.iter().zip(gradients) {
        h += u * g.transpose();
    }
    h
}

fn strain(h: &Matrix3<f64>) -> Matrix3<f64> {
    (h + h.transpose() + h.transpose() * h) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrals::stiffness;
    use crate::material::lame_constants;
    use crate::rule::points;
    use crate::shape::derivatives;

    const E: f64 = 114e3;
    const NU: f64 = 0.34;

    /// Numbers without structure between −1 and 1.
    fn noise(seed: usize) -> f64 {
        2.0 * (((seed as f64 + 1.0) * 12.9898).sin() * 43_758.545).rem_euclid(1.0) - 1.0
    }

    fn noisy(count: usize, size: f64, seed: usize) -> Vec<Vector3<f64>> {
        (0..count).map(|a| Vector3::from_fn(|d, _| size * noise(seed + 7 * a + 31 * d))).collect()
    }

    /// Crooked element of a kind: its natural coordinates, stretched and disturbed.
    fn crooked(kind: ElementKind) -> Vec<[f64; 3]> {
        let nodes = crate::topology::Topology::of(kind).nodes();
        let place = |(a, xi): (usize, &crate::natural::Natural)| {
            std::array::from_fn(|d| (2.0 + d as f64) * xi[d] + 0.05 * noise(100 + 3 * a + d))
        };
        nodes.iter().enumerate().map(place).collect()
    }

    /// Energy written out: deformation gradient, strain, and the elasticity tensor with four indices.
    fn literal(kind: ElementKind, positions: &[[f64; 3]], u: &[Vector3<f64>]) -> f64 {
        let (lambda, mu) = (E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU)));
        let delta = |i: usize, j: usize| f64::from(u8::from(i == j));
        let mut energy = 0.0;
        for point in points(kind) {
            let dn = derivatives(kind, point.xi);
            let (mut dx, mut dy) = (Matrix3::<f64>::zeros(), Matrix3::<f64>::zeros());
            for (a, dn) in dn.iter().enumerate() {
                for i in 0..3 {
                    for j in 0..3 {
                        dx[(i, j)] += positions[a][i] * dn[j];
                        dy[(i, j)] += (positions[a][i] + u[a][i]) * dn[j];
                    }
                }
            }
            let f = dy * dx.try_inverse().unwrap();
            let mut strain = [[0.0; 3]; 3];
            for (i, row) in strain.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry = 0.5 * ((0..3).map(|k| f[(k, i)] * f[(k, j)]).sum::<f64>() - delta(i, j));
                }
            }
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        for l in 0..3 {
                            let c = lambda * delta(i, j) * delta(k, l)
                                + mu * (delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k));
                            energy += 0.5 * c * strain[i][j] * strain[k][l] * point.weight * dx.determinant();
                        }
                    }
                }
            }
        }
        energy
    }

    fn elements() -> impl Iterator<Item = (ElementKind, Vec<[f64; 3]>, GreenLagrange)> {
        ElementKind::ALL.into_iter().map(|kind| {
            let positions = crooked(kind);
            let element = GreenLagrange::of(kind, &positions, lame_constants(E, NU));
            (kind, positions, element)
        })
    }

    #[test]
    fn energy_is_that_of_full_green_lagrange_strain_written_out() {
        for (kind, positions, element) in elements() {
            for size in [1e-3, 0.3, 1.0] {
                let u = noisy(kind.nodes(), size, 5);
                let bubbles = if element.has_bubbles() { BUBBLES } else { 0 };
                // Incompatible modes at rest leave the functions of the nodes alone.
                let values: Vec<_> = u.iter().copied().chain(vec![Vector3::zeros(); bubbles]).collect();
                let (found, expected) = (element.energy(&values), literal(kind, &positions, &u));
                assert!((found / expected - 1.0).abs() < 1e-8, "{kind:?} {size}: {found} {expected}");
            }
        }
    }

    #[test]
    fn quadratic_part_is_the_stiffness_and_has_no_mixed_term() {
        for (kind, positions, element) in elements() {
            let u = noisy(kind.nodes(), 0.3, 5);
            let k = stiffness(kind, &positions, lame_constants(E, NU));
            let pairs = (0..u.len()).flat_map(|a| (0..u.len()).map(move |b| (a, b)));
            let expected = 0.5 * pairs.map(|(a, b)| u[a].dot(&(k[(a, b)] * u[b]))).sum::<f64>();
            let (still, beta) = ([Vector3::zeros(); BUBBLES], noisy(BUBBLES, 0.1, 70));
            let values = element.values(&u, &still);
            let origin = vec![Vector3::zeros(); values.len()];
            assert!((element.linear_energy(&values) / expected - 1.0).abs() < 1e-10, "{kind:?}");
            assert!((element.line(&origin, &values)[2] / expected - 1.0).abs() < 1e-10, "{kind:?}");
            let work: f64 = element.linear_force(&values).iter().zip(&u).map(|(f, u)| f.dot(u)).sum();
            assert!((0.5 * work / expected - 1.0).abs() < 1e-10, "{kind:?}");
            if element.has_bubbles() {
                let none = vec![Vector3::zeros(); u.len()];
                let both = element.linear_energy(&element.values(&u, &beta));
                let alone = element.linear_energy(&element.values(&none, &beta));
                assert!((both / (expected + alone) - 1.0).abs() < 1e-10, "{kind:?}");
            }
        }
    }

    #[test]
    fn force_and_line_are_derivatives_of_the_energy() {
        for (kind, _, element) in elements() {
            let (u, beta) = (noisy(kind.nodes(), 0.3, 5), noisy(BUBBLES, 0.1, 70));
            let (du, dbeta) = (noisy(kind.nodes(), 0.2, 900), noisy(BUBBLES, 0.1, 990));
            let (values, along) = (element.values(&u, &beta), element.values(&du, &dbeta));
            let line = element.line(&values, &along);
            for t in [-1.0, 0.5, 2.0] {
                let moved: Vec<_> = values.iter().zip(&along).map(|(u, d)| u + d * t).collect();
                let quartic = line.iter().rev().fold(0.0, |sum, c| sum * t + c);
                let energy = element.energy(&moved);
                assert!((quartic / energy - 1.0).abs() < 1e-8, "{kind:?} {t}: {quartic} {energy}");
            }
            let given = if element.has_bubbles() { &dbeta[..] } else { &[] };
            let force = element.force(&values);
            let work: f64 = force.iter().zip(du.iter().chain(given)).map(|(f, d)| f.dot(d)).sum();
            assert!((work / line[1] - 1.0).abs() < 1e-8, "{kind:?}: {work} {}", line[1]);
            if element.has_bubbles() {
                let still = [Vector3::zeros(); BUBBLES];
                let along =
                    element.values(&vec![Vector3::zeros(); u.len()], &element.solve_bubbles(&force[8..]));
                let step = element.linear_energy(&along);
                let work: f64 = (along[8..].iter().zip(&force[8..])).map(|(a, f)| a.dot(f)).sum();
                assert!((2.0 * step / work - 1.0).abs() < 1e-8, "{kind:?}");
                assert_eq!(element.values(&u, &still).len(), 8 + BUBBLES);
            }
        }
    }

    #[test]
    fn parts_of_second_order_are_those_of_force_and_energy() {
        for (kind, _, element) in elements() {
            let bubbles = if element.has_bubbles() { BUBBLES } else { 0 };
            let shapes: Vec<Vec<Vector3<f64>>> = [5, 300]
                .map(|seed| element.values(&noisy(kind.nodes(), 0.3, seed), &noisy(bubbles, 0.1, seed + 70)))
                .into();
            let combine = |p: &[f64; 2]| -> Vec<Vector3<f64>> {
                shapes[0].iter().zip(&shapes[1]).map(|(a, b)| a * p[0] + b * p[1]).collect()
            };
            // The even part of the force is its quadratic one.
            let p = [0.7, -1.3];
            let (ahead, back) = (element.force(&combine(&p)), element.force(&combine(&p.map(|p| -p))));
            let g = |j: usize, k: usize| element.second_order_force(&shapes[j], &shapes[k]);
            let (g00, g01, g10, g11) = (g(0, 0), g(0, 1), g(1, 0), g(1, 1));
            let size = ahead.iter().map(|f| f.norm()).fold(0.0, f64::max);
            for i in 0..ahead.len() {
                let found = g00[i] * p[0] * p[0] + (g01[i] + g10[i]) * p[0] * p[1] + g11[i] * p[1] * p[1];
                assert!((found - (ahead[i] + back[i]) * 0.5).norm() < 1e-9 * size, "{kind:?} {i}");
                assert!((g01[i] - g10[i]).norm() < 1e-9 * size, "{kind:?} {i}");
            }
            let (cubic, quartic) = element.energy_products(&shapes);
            let q = [p[0] * p[0], p[0] * p[1], p[1] * p[1]];
            let third: f64 = (0..6).map(|at| cubic[(at / 3, at % 3)] * p[at / 3] * q[at % 3]).sum();
            let fourth: f64 = (0..9).map(|at| 0.5 * quartic[(at / 3, at % 3)] * q[at / 3] * q[at % 3]).sum();
            let origin = vec![Vector3::zeros(); shapes[0].len()];
            let [_, _, _, c3, c4] = element.line(&origin, &combine(&p));
            assert!((third / c3 - 1.0).abs() < 1e-8, "{kind:?}: {third} {c3}");
            assert!((fourth / c4 - 1.0).abs() < 1e-8, "{kind:?}: {fourth} {c4}");
        }
    }

    #[test]
    fn a_rigid_turn_costs_nothing_and_a_stretch_as_much_as_in_closed_form() {
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        for (kind, positions, element) in elements() {
            let moved = |f: &Matrix3<f64>| -> Vec<Vector3<f64>> {
                let values = positions.iter().map(|&x| f * Vector3::from(x) - Vector3::from(x));
                let bubbles = if element.has_bubbles() { BUBBLES } else { 0 };
                values.chain(vec![Vector3::zeros(); bubbles]).collect()
            };
            let volume: f64 = element.gradients.volumes.iter().sum();
            let scale = E * volume;
            assert!(element.energy(&moved(turn.matrix())).abs() < 1e-12 * scale, "{kind:?}");
            // Stretches 1.2, 0.9, 1.05, turned: E = ½ (s² − 1) along the axes.
            let strain = [1.2, 0.9, 1.05].map(|s: f64| 0.5 * (s * s - 1.0));
            let Lame { lambda, mu } = lame_constants(E, NU);
            let sum: f64 = strain.iter().sum();
            let expected =
                volume * (0.5 * lambda * sum * sum + mu * strain.iter().map(|e| e * e).sum::<f64>());
            let stretched = turn.matrix() * Matrix3::from_diagonal(&Vector3::new(1.2, 0.9, 1.05));
            let found = element.energy(&moved(&stretched));
            assert!((found / expected - 1.0).abs() < 1e-10, "{kind:?}: {found} {expected}");
        }
    }
}
