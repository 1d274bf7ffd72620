use proptest::prelude::*;

use super::active_set::ActiveSetSolver;
use super::branches::BranchSolver;
use super::factor::{Cholesky, Factor, Lu};
use super::law::BilinearLaw;
use super::{ComplementarityError, ContactOperator};
use crate::fixed::fixed;

struct Dense(Vec<Vec<f64>>);

impl ContactOperator for Dense {
    fn size(&self) -> usize {
        self.0.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self.0[i][j]
    }

    fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
        for ((row, q), gap) in self.0.iter().zip(q).zip(gap) {
            *gap = q + active.iter().zip(lambda).map(|(&j, l)| row[j] * l).sum::<f64>();
        }
    }
}

/// Reference solution: tries every subset of up to 10 indices.
fn enumerate(w: &Dense, q: &[f64]) -> Vec<f64> {
    let n = q.len();
    for set in 0..1usize << n {
        let active: Vec<_> = (0..n).filter(|i| set >> i & 1 == 1).collect();
        let block = nalgebra::DMatrix::from_fn(active.len(), active.len(), |a, b| w.0[active[a]][active[b]]);
        let rhs = nalgebra::DVector::from_fn(active.len(), |a, _| -q[active[a]]);
        let solved = if set == 0 { Some(rhs) } else { block.lu().solve(&rhs) };
        let Some(solved) = solved else { continue };
        let mut lambda = vec![0.0; n];
        for (a, &i) in active.iter().enumerate() {
            lambda[i] = solved[a];
        }
        let gap = |i: usize| q[i] + (0..n).map(|j| w.0[i][j] * lambda[j]).sum::<f64>();
        if lambda.iter().all(|&l| l >= -1e-9) && (0..n).all(|i| gap(i) >= -1e-9) {
            return lambda;
        }
    }
    unreachable!("a P-matrix has a solution for every q")
}

/// Matrix AᵀA + ridge·I from the leading `n × n` part of a 7 × 7 matrix A.
fn definite(n: usize, a: &[f64], ridge: f64) -> Dense {
    let dot = |i: usize, j: usize| (0..n).map(|k| a[7 * k + i] * a[7 * k + j]).sum::<f64>();
    Dense((0..n).map(|i| (0..n).map(|j| dot(i, j) + if i == j { ridge } else { 0.0 }).collect()).collect())
}

/// Adds S − Sᵀ of a 7 × 7 matrix S.
fn skewed(mut w: Dense, s: &[f64]) -> Dense {
    for (i, row) in w.0.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry += s[7 * i + j] - s[7 * j + i];
        }
    }
    w
}

/// Forces λ of every index.
fn spread(active: &[usize], forces: &[f64], n: usize) -> Vec<f64> {
    let mut lambda = vec![0.0; n];
    for (&i, &l) in active.iter().zip(forces) {
        lambda[i] = l;
    }
    lambda
}

/// Solves a sequence of problems with one solver, so that warm starts from unrelated sets are tried too.
fn check<F: Factor>(w: &Dense, qs: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    let n = w.size();
    let mut solver = ActiveSetSolver::<F>::new(n);
    for q in qs.chunks_exact(7) {
        let q = &q[..n];
        solver.solve(w, q, 1e-13).unwrap();
        let lambda = spread(solver.active(), solver.lambda(), n);
        for (&l, &gap) in lambda.iter().zip(solver.gap()) {
            prop_assert!(l >= 0.0 && gap >= -1e-9);
            // λg = 0, to the round-off of W λ.
            prop_assert!((l * gap).abs() < 1e-10 * (1.0 + l * l));
        }
        let expected = enumerate(w, q);
        for (found, expected) in lambda.iter().zip(&expected) {
            prop_assert!((found - expected).abs() < tolerance, "{lambda:?} {expected:?}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(fixed(256))]

    /// Matrices from well conditioned to nearly singular, q of both signs.
    #[test]
    fn symmetric_problems_agree_with_enumeration(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        ridge in prop::sample::select(vec![1.0, 1e-2, 1e-5]),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        check::<Cholesky>(&definite(n, &a, ridge), &qs, 1e-7 / ridge)?;
    }

    /// Matrices with a skew part of any size: with a positive definite symmetric part they stay P-matrices.
    #[test]
    fn non_symmetric_problems_agree_with_enumeration(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        skew in prop::collection::vec(-3.0f64..3.0, 49),
        ridge in prop::sample::select(vec![1.0, 1e-2]),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        check::<Lu>(&skewed(definite(n, &a, ridge), &skew), &qs, 1e-7 / ridge)?;
    }

    /// Factors of both kinds give the same answer without a skew part, in the same pivoting steps.
    #[test]
    fn factors_agree_on_symmetric_problems(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        let w = definite(n, &a, 0.1);
        let (mut cholesky, mut lu) = (ActiveSetSolver::<Cholesky>::new(n), ActiveSetSolver::<Lu>::new(n));
        for q in qs.chunks_exact(7) {
            cholesky.solve(&w, &q[..n], 1e-13).unwrap();
            lu.solve(&w, &q[..n], 1e-13).unwrap();
            prop_assert_eq!(cholesky.active(), lu.active());
            prop_assert_eq!(cholesky.statistics(), lu.statistics());
            for (a, b) in cholesky.lambda().iter().zip(lu.lambda()) {
                // The condition of W is below 100.
                prop_assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{} {}", a, b);
            }
        }
    }
}

#[test]
fn keeps_a_lasting_contact_factored() {
    let w = Dense(vec![vec![2.0, -0.5], vec![-0.5, 1.0]]);
    let mut solver = ActiveSetSolver::<Cholesky>::new(2);
    for step in 0..100 {
        solver.solve(&w, &[-1.0 - 0.01 * f64::from(step), -0.5], 1e-14).unwrap();
        assert_eq!(solver.active(), [0, 1]);
    }
    assert_eq!(solver.statistics().factorisations, 1);
}

/// Matrices with a minor that is zero or negative are refused, symmetric or not.
#[test]
fn refuses_what_is_no_p_matrix() {
    for coupling in [2.0, 3.0] {
        let symmetric = Dense(vec![vec![1.0, coupling], vec![coupling, 4.0]]);
        let error = ActiveSetSolver::<Cholesky>::new(2).solve(&symmetric, &[-1.0, -4.0], 1e-14).unwrap_err();
        assert_eq!(error, ComplementarityError::NotPositiveDefinite { active: 2 });
        let other = Dense(vec![vec![1.0, 2.0 * coupling], vec![0.5 * coupling, 4.0]]);
        let error = ActiveSetSolver::<Lu>::new(2).solve(&other, &[-1.0, -4.0], 1e-14).unwrap_err();
        assert_eq!(error, ComplementarityError::NotPMatrix { active: 2 });
    }
}

/// Reference solution: tries every combination of branches (0: no force, 1 and 2: the slopes, 3: the stop).
fn enumerate_branches(w: &Dense, laws: &[BilinearLaw], q: &[f64]) -> Vec<f64> {
    let n = q.len();
    let branch = |combination: usize, i: usize| combination >> (2 * i) & 3;
    for combination in 0..1usize << (2 * n) {
        // Rows: λ = 0; λ + s (Wλ + q + x0) = λ(x0) with x = −(q + Wλ); −(q + Wλ) = stop.
        let row = |i: usize| {
            let law = &laws[i];
            let (own, share, right) = match branch(combination, i) {
                0 => (1.0, 0.0, 0.0),
                1 => (1.0, law.slopes[0], -law.slopes[0] * (q[i] + law.start)),
                2 => {
                    let knee = law.slopes[0] * (law.knee - law.start);
                    (1.0, law.slopes[1], knee - law.slopes[1] * (q[i] + law.knee))
                }
                _ => (0.0, 1.0, -q[i] - law.stop),
            };
            ((0..n).map(move |j| f64::from(i == j) * own + share * w.0[i][j]), right)
        };
        let matrix = nalgebra::DMatrix::from_fn(n, n, |i, j| row(i).0.clone().nth(j).unwrap());
        let right = nalgebra::DVector::from_fn(n, |i, _| row(i).1);
        let Some(lambda) = matrix.lu().solve(&right) else { continue };
        let holds = |i: usize| {
            let (law, l) = (&laws[i], lambda[i]);
            let x = -(q[i] + (0..n).map(|j| w.0[i][j] * lambda[j]).sum::<f64>());
            let within = |low: f64, high: f64| x >= low - 1e-9 && x <= high + 1e-9;
            l >= -1e-9
                && match branch(combination, i) {
                    0 => x <= law.start + 1e-9,
                    1 => within(law.start, law.knee),
                    2 => within(law.knee, law.stop),
                    _ => l >= law.force(law.stop) - 1e-9,
                }
        };
        if (0..n).all(holds) {
            return lambda.iter().copied().collect();
        }
    }
    unreachable!("monotone laws and a P-matrix have a solution for every q")
}

fn check_branches<F: Factor>(w: &Dense, laws: &[BilinearLaw], qs: &[f64]) -> Result<(), TestCaseError> {
    let n = w.size();
    let mut solver = BranchSolver::<F>::new(n);
    for q in qs.chunks_exact(7) {
        let q = &q[..n];
        solver.solve(w, |i| laws[i], q, 1e-13).unwrap();
        let lambda = spread(solver.active(), solver.lambda(), n);
        let expected = enumerate_branches(w, laws, q);
        for (i, (found, expected)) in lambda.iter().zip(&expected).enumerate() {
            // The enumeration's own tolerance over the least eigenvalue, 0.1, of W.
            prop_assert!((found - expected).abs() < 1e-6, "{lambda:?} {expected:?}");
            let x = -solver.gap()[i];
            prop_assert!(*found >= 0.0 && x <= laws[i].stop + 1e-11);
            prop_assert!(x > laws[i].stop - 1e-11 || (laws[i].force(x) - found).abs() < 1e-9);
        }
    }
    Ok(())
}

/// Laws with steep and gentle slopes, softening and stiffening; every branch but the stop may have no length.
fn laws() -> impl Strategy<Value = Vec<BilinearLaw>> {
    let length = || prop_oneof![Just(0.0), 0.0f64..0.3];
    let law = (length(), length(), length(), 0.1f64..20.0, 0.1f64..20.0);
    let law = law.prop_map(|(start, first, second, rising, after)| BilinearLaw {
        start,
        knee: start + first,
        stop: start + first + second,
        slopes: [rising, after],
    });
    prop::collection::vec(law, 4)
}

proptest! {
    #![proptest_config(fixed(256))]

    #[test]
    fn yielding_obstacles_agree_with_enumeration(
        n in 1usize..5,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        skew in prop::collection::vec(-2.0f64..2.0, 49),
        laws in laws(),
        qs in prop::collection::vec(-1.0f64..0.5, 28),
    ) {
        check_branches::<Cholesky>(&definite(n, &a, 0.1), &laws[..n], &qs)?;
        check_branches::<Lu>(&skewed(definite(n, &a, 0.1), &skew), &laws[..n], &qs)?;
    }

    /// An obstacle that stops at its surface, whatever its slopes, is rigid; one with steep slopes nearly.
    #[test]
    fn stiff_obstacles_are_rigid(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        skew in prop::collection::vec(-2.0f64..2.0, 49),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        let w = skewed(definite(n, &a, 0.1), &skew);
        let rigid = BilinearLaw { start: 0.0, knee: 0.0, stop: 0.0, slopes: [1.0, 1.0] };
        let steep = BilinearLaw { start: 0.0, knee: 1e-10, stop: 1.0, slopes: [1e9, 1e8] };
        let mut truth = ActiveSetSolver::<Lu>::new(n);
        let (mut stopped, mut yielding) = (BranchSolver::<Lu>::new(n), BranchSolver::<Lu>::new(n));
        for q in qs.chunks_exact(7) {
            let q = &q[..n];
            truth.solve(&w, q, 1e-13).unwrap();
            stopped.solve(&w, |_| rigid, q, 1e-13).unwrap();
            yielding.solve(&w, |_| steep, q, 1e-13).unwrap();
            let expected = spread(truth.active(), truth.lambda(), n);
            let of = |solver: &BranchSolver<Lu>| spread(solver.active(), solver.lambda(), n);
            for ((expected, stopped), yielding) in expected.iter().zip(of(&stopped)).zip(of(&yielding)) {
                prop_assert!((expected - stopped).abs() < 1e-9, "{} {}", expected, stopped);
                // x of a force of order ten is 1e-7, over the least eigenvalue 0.1.
                prop_assert!((expected - yielding).abs() < 1e-5, "{} {}", expected, yielding);
            }
        }
    }
}
