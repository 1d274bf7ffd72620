use proptest::prelude::*;

use super::active_set::ActiveSetSolver;
use super::factor::{Cholesky, Factor, Lu};
use super::{ComplementarityError, ContactOperator};

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

/// Literal truth: tries every subset of up to 10 indices.
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

/// AᵀA + ridge·I from the leading `n × n` part of a 7 × 7 matrix A.
fn definite(n: usize, a: &[f64], ridge: f64) -> Dense {
    let dot = |i: usize, j: usize| (0..n).map(|k| a[7 * k + i] * a[7 * k + j]).sum::<f64>();
    Dense((0..n).map(|i| (0..n).map(|j| dot(i, j) + if i == j { ridge } else { 0.0 }).collect()).collect())
}

/// λ of every index.
fn spread<F: Factor>(solver: &ActiveSetSolver<F>, n: usize) -> Vec<f64> {
    let mut lambda = vec![0.0; n];
    for (&i, &l) in solver.active().iter().zip(solver.lambda()) {
        lambda[i] = l;
    }
    lambda
}

/// A sequence of problems shares one solver, so warm starts from unrelated sets are tried too.
fn check<F: Factor>(w: &Dense, qs: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    let n = w.size();
    let mut solver = ActiveSetSolver::<F>::new(n);
    for q in qs.chunks_exact(7) {
        let q = &q[..n];
        solver.solve(w, q, 1e-13).unwrap();
        let lambda = spread(&solver, n);
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
    /// From well conditioned to nearly singular, q of both signs.
    #[test]
    fn symmetric_problems_agree_with_enumeration(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        ridge in prop::sample::select(vec![1.0, 1e-2, 1e-5]),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        check::<Cholesky>(&definite(n, &a, ridge), &qs, 1e-7 / ridge)?;
    }

    /// A skew part of any size leaves a matrix with a positive definite symmetric part a P-matrix.
    #[test]
    fn non_symmetric_problems_agree_with_enumeration(
        n in 1usize..7,
        a in prop::collection::vec(-1.0f64..1.0, 49),
        skew in prop::collection::vec(-3.0f64..3.0, 49),
        ridge in prop::sample::select(vec![1.0, 1e-2]),
        qs in prop::collection::vec(-1.0f64..1.0, 28),
    ) {
        let mut w = definite(n, &a, ridge);
        for (i, row) in w.0.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += skew[7 * i + j] - skew[7 * j + i];
            }
        }
        check::<Lu>(&w, &qs, 1e-7 / ridge)?;
    }

    /// Without a skew part both factors give the same answer in the same pivoting steps.
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

/// A minor that is zero or negative has no place in a P-matrix, symmetric or not.
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
