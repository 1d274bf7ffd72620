use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::super::ContactOperator;
use super::super::active_set::ActiveSetSolver;
use super::super::factor::Lu;
use super::*;
use crate::fixed::fixed;

/// Dense W over all forces of all places.
struct Dense(DMatrix<f64>);

impl Dense {
    fn size(&self) -> usize {
        self.0.nrows() / 3
    }
}

impl DiscOperator for Dense {
    fn block(&self, i: usize, j: usize) -> Block {
        [0, 1, 2].map(|a| [0, 1, 2].map(|b| self.0[(3 * i + a, 3 * j + b)]))
    }

    fn gaps(&self, active: &[usize], forces: &[Forces], q: &[f64], gap: &mut [f64]) {
        for (i, (q, gap)) in q.iter().zip(gap).enumerate() {
            let moved = active.iter().zip(forces).map(|(&j, x)| dot(self.block(i, j)[0], *x));
            *gap = q + moved.sum::<f64>();
        }
    }
}

/// Operator AᵀA/n + ridge·I + S − Sᵀ from numbers of [−1, 1].
fn operator(places: usize, numbers: &[f64], ridge: f64, skew: f64) -> Dense {
    let n = 3 * places;
    let a = DMatrix::from_fn(n, n, |i, j| numbers[(31 * i + j) % numbers.len()]);
    let s = DMatrix::from_fn(n, n, |i, j| skew * numbers[(17 * i + 5 * j + 3) % numbers.len()]);
    Dense(a.transpose() * a / n as f64 + DMatrix::identity(n, n) * ridge + &s - s.transpose())
}

/// Forces of every place, in one vector.
fn spread(solver: &DiscSolver, places: usize) -> DVector<f64> {
    let mut x = DVector::zeros(3 * places);
    for (&i, forces) in solver.active().iter().zip(solver.forces()) {
        forces.iter().enumerate().for_each(|(a, f)| x[3 * i + a] = *f);
    }
    x
}

fn solve(solver: &mut DiscSolver, w: &Dense, mu: f64, known: &DVector<f64>) -> DVector<f64> {
    let q: Vec<_> = (0..w.size()).map(|i| known[3 * i]).collect();
    let free = |i: usize| [-known[3 * i + 1], -known[3 * i + 2]];
    solver.solve(w, mu, &q, free, 1e-14).unwrap();
    spread(solver, w.size())
}

/// Problem made from its solution: places that are open, stick, slide slowly and fast, as `kinds` has them.
fn made(w: &Dense, mu: f64, kinds: &[u32], numbers: &[f64]) -> (DVector<f64>, DVector<f64>) {
    let (mut x, mut y) = (DVector::zeros(3 * kinds.len()), DVector::zeros(3 * kinds.len()));
    for (i, (&kind, n)) in kinds.iter().zip(numbers.chunks_exact(4)).enumerate() {
        let (sin, cos) = (3.0 * n[0]).sin_cos();
        let lambda = 0.2 + n[1].abs();
        let (force, sliding) = match kind {
            0 => {
                y[3 * i] = 0.05 + n[1].abs();
                x[3 * i] = 0.0;
                y[3 * i + 1] = n[2];
                y[3 * i + 2] = n[3];
                continue;
            }
            1 => (0.95 * n[2].abs(), 0.0),
            2 => (1.0, 0.01 + 0.1 * n[3].abs()),
            _ => (1.0, 10.0 + n[3]),
        };
        x[3 * i] = lambda;
        x[3 * i + 1] = mu * lambda * force * cos;
        x[3 * i + 2] = mu * lambda * force * sin;
        y[3 * i + 1] = -sliding * cos;
        y[3 * i + 2] = -sliding * sin;
    }
    let known = y - &w.0 * &x;
    (known, x)
}

proptest! {
    #![proptest_config(fixed(256))]

    /// Problems made from their solutions, symmetric or not, are solved one after the other by one solver, whose start is then anywhere.
    #[test]
    fn finds_the_solutions_problems_were_made_from(
        places in 1usize..7,
        numbers in prop::collection::vec(-1.0f64..1.0, 359),
        kinds in prop::collection::vec(0u32..4, 24),
        others in prop::collection::vec(-1.0f64..1.0, 96),
        skew in prop::sample::select(vec![0.0, 0.2]),
        mu in prop::sample::select(vec![0.0, 0.02, 0.1]),
    ) {
        let w = operator(places, &numbers, 0.3, skew);
        let mut solver = DiscSolver::new(places);
        for (kinds, numbers) in kinds.chunks_exact(6).zip(others.chunks_exact(24)) {
            let (known, expected) = made(&w, mu, &kinds[..places], numbers);
            let found = solve(&mut solver, &w, mu, &known);
            // Round-off of forces of order one, over the least eigenvalue, 0.3.
            prop_assert!((&found - &expected).amax() < 1e-11, "{found} {expected}");
            for (forces, (sliding, sticks)) in
                solver.forces().iter().zip(solver.sliding().iter().zip(solver.sticks()))
            {
                let [lambda, a, b] = *forces;
                let s = sliding[0].hypot(sliding[1]);
                prop_assert!(lambda > 0.0 && a.hypot(b) <= mu * lambda * (1.0 + 1e-15));
                // Friction never gives.
                prop_assert!(a * sliding[0] + b * sliding[1] >= -1e-14);
                prop_assert!(!sticks || s < 1e-12, "{}", s);
            }
        }
    }

    /// Sweeps alone end where Newton's method does.
    #[test]
    fn sweeps_agree(
        places in 1usize..5,
        numbers in prop::collection::vec(-1.0f64..1.0, 359),
        known in prop::collection::vec(-1.0f64..1.0, 15),
        mu in 0.0f64..0.15,
    ) {
        let w = operator(places, &numbers, 0.5, 0.0);
        let known = DVector::from_fn(3 * places, |i, _| known[i]);
        let found = solve(&mut DiscSolver::new(places), &w, mu, &known);
        let mut x = vec![[0.0; 3]; places];
        for _ in 0..300 {
            for i in 0..places {
                let y = [0, 1, 2].map(|a| {
                    let others = (0..places).filter(|&j| j != i);
                    known[3 * i + a] + others.map(|j| dot(w.block(i, j)[a], x[j])).sum::<f64>()
                });
                x[i] = alone(&w.block(i, i), &y, mu).unwrap();
            }
        }
        for (i, x) in x.iter().enumerate() {
            for (a, x) in x.iter().enumerate() {
                prop_assert!((found[3 * i + a] - x).abs() < 1e-10, "{} {}", found[3 * i + a], x);
            }
        }
    }

    /// Forces without friction are those of the problem of the gaps.
    #[test]
    fn no_coefficient_is_no_friction(
        places in 1usize..7,
        numbers in prop::collection::vec(-1.0f64..1.0, 359),
        known in prop::collection::vec(-1.0f64..1.0, 21),
    ) {
        struct Normal<'a>(&'a Dense);
        impl ContactOperator for Normal<'_> {
            fn size(&self) -> usize {
                self.0.size()
            }
            fn entry(&self, i: usize, j: usize) -> f64 {
                self.0.0[(3 * i, 3 * j)]
            }
            fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
                let forces: Vec<_> = lambda.iter().map(|&l| [l, 0.0, 0.0]).collect();
                DiscOperator::gaps(self.0, active, &forces, q, gap);
            }
        }
        let w = operator(places, &numbers, 0.1, 0.0);
        let known = DVector::from_fn(3 * places, |i, _| known[i]);
        let q: Vec<_> = (0..places).map(|i| known[3 * i]).collect();
        let mut plain = ActiveSetSolver::<Lu>::new(places);
        plain.solve(&Normal(&w), &q, 1e-14).unwrap();
        let found = solve(&mut DiscSolver::new(places), &w, 0.0, &known);
        for i in 0..places {
            let expected = plain.active().iter().position(|&j| j == i).map_or(0.0, |at| plain.lambda()[at]);
            prop_assert!((found[3 * i] - expected).abs() < 1e-11);
            prop_assert!(found[3 * i + 1] == 0.0 && found[3 * i + 2] == 0.0);
        }
    }
}

/// A block that gives way alike in all directions is pressed by 1 and pushed by 0.2 along the plane: it sticks above a coefficient
/// of 0.2, below it slides by what friction leaves.
#[test]
fn a_block_on_a_plane_sticks_or_slides() {
    let w = Dense(DMatrix::identity(3, 3) * 2.0);
    for angle in [0.0f64, 0.7, 2.0, 3.5, 5.9] {
        let (sin, cos) = angle.sin_cos();
        let known = DVector::from_vec(vec![-2.0, -0.4 * cos, -0.4 * sin]);
        for mu in [0.05, 0.15, 0.25] {
            let mut solver = DiscSolver::new(1);
            let x = solve(&mut solver, &w, mu, &known);
            let tau = f64::min(mu, 0.2);
            assert!((x[0] - 1.0).abs() < 1e-15);
            assert!((x[1] - tau * cos).abs() < 1e-15 && (x[2] - tau * sin).abs() < 1e-15, "{x}");
            assert_eq!(solver.sticks(), [mu > 0.2]);
            let [a, b] = solver.sliding()[0];
            assert!((a.hypot(b) - (0.4 - 2.0 * tau)).abs() < 1e-15);
        }
    }
}

/// Friction along the plane presses in by more than the normal force lifts off above μ = W_nn/|W_nt| = 0.5. An open gap then has three
/// solutions: it stays open, it digs in and sticks, and it slides in between, where the determinant is negative. A start beside the sliding
/// solution does not end there.
#[test]
fn does_not_end_where_the_orientation_is_another() {
    let mut w = DMatrix::identity(6, 6);
    w.view_mut((3, 3), (2, 2)).copy_from(&DMatrix::from_row_slice(2, 2, &[1.0, -2.0, -2.0, 5.0]));
    let w = Dense(w);
    let mu = 0.6;
    // λ of the second place sliding at g = 0.1 + (1 − 2μ) λ = 0; it slides by 10 − (5μ − 2) λ.
    let lambda = 0.1 / (2.0 * mu - 1.0);
    let mut solver = DiscSolver::new(2);
    solver.last = vec![[1.0, 0.0, 0.0], [lambda * 1.001, mu * lambda, 0.0]];
    let known = DVector::from_vec(vec![-1.0, 0.0, 0.0, 0.1, -10.0, 0.0]);
    let found = solve(&mut solver, &w, mu, &known);
    assert_eq!(found[3], 0.0);
    // Pressed in, it can but stick.
    let known = DVector::from_vec(vec![-1.0, 0.0, 0.0, -0.1, -10.0, 0.0]);
    solve(&mut solver, &w, mu, &known);
    assert_eq!(solver.sticks(), [true, true]);
}

#[test]
fn keeps_what_lasts() {
    let w = operator(2, &(0..40).map(|i| f64::from(i).sin()).collect::<Vec<_>>(), 0.5, 0.0);
    let mut solver = DiscSolver::new(2);
    for step in 0..100 {
        let known = DVector::from_vec(vec![-1.0, -9.0, 0.1, -0.8, -9.0, 0.01 * f64::from(step)]);
        solve(&mut solver, &w, 0.1, &known);
    }
    // From the forces before, with their matrix.
    assert_eq!(solver.statistics().factorisations, 1);
    assert!(solver.statistics().candidates <= 600, "{:?}", solver.statistics());
}

/// Every problem is solved, whatever the coefficient, the conditioning of W and the start.
#[test]
fn random_problems_take_some_steps() {
    let mut seed = 88_172_645_463_325_252_u64;
    let mut next = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 12) as f64 / (1u64 << 51) as f64 - 1.0
    };
    let places = 6;
    for (mu, ridge) in [(0.1, 0.05), (0.3, 0.001), (1.0, 0.001)] {
        let (mut steps, mut factorisations, mut problems) = (0, 0, 0);
        for _ in 0..100 {
            let numbers: Vec<f64> = (0..359).map(|_| next()).collect();
            let w = operator(places, &numbers, ridge, 0.0);
            let mut solver = DiscSolver::new(places);
            for scale in [0.05, 0.3, 5.0] {
                let known = DVector::from_fn(3 * places, |row, _| {
                    if row % 3 == 0 { 0.5 * next() - 0.3 } else { scale * next() }
                });
                solve(&mut solver, &w, mu, &known);
            }
            steps += solver.statistics().candidates;
            factorisations += solver.statistics().factorisations;
            problems += solver.statistics().problems;
        }

        assert!(steps < 10 * problems && factorisations < 8 * problems);
    }
}
