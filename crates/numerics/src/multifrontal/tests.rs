use faer::Mat;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};

use super::analysis::postorder;
use super::*;
use crate::nested_dissection::nested_dissection;
use crate::panel::Panel;

/// Stiffness of a grid of springs, three unknowns a node, with a strong diagonal: positive definite.
fn grid(size: usize, shift: f64) -> SparseColMat<usize, f64> {
    let n = size * size;
    let mut triplets = Vec::new();
    for node in 0..n {
        let neighbours =
            [(node % size + 1 < size).then_some(node + 1), (node + size < n).then_some(node + size)];
        for a in 0..3 {
            triplets.push(Triplet::new(3 * node + a, 3 * node + a, 9.0 + (node % 7) as f64 * 0.1 - shift));
            for next in neighbours.into_iter().flatten() {
                for b in 0..3 {
                    let value = if a == b { -1.5 } else { 0.2 * (a + b) as f64 - 0.4 };
                    triplets.push(Triplet::new(3 * node + a, 3 * next + b, value));
                    triplets.push(Triplet::new(3 * next + b, 3 * node + a, value));
                }
            }
        }
    }
    SparseColMat::try_new_from_triplets(3 * n, 3 * n, &triplets).unwrap()
}

/// Matrix `a` with its leading rows in a postordered nested-dissection order.
fn ordered(a: &SparseColMat<usize, f64>, eliminated: usize) -> SparseColMat<usize, f64> {
    let n = a.nrows();
    let permute = |a: &SparseColMat<usize, f64>, order: &[usize]| {
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        let triplets: Vec<_> =
            a.triplet_iter().map(|t| Triplet::new(place[t.row], place[t.col], *t.val)).collect();
        SparseColMat::try_new_from_triplets(n, n, &triplets).unwrap()
    };
    let leading: Vec<_> = a
        .triplet_iter()
        .filter(|t| t.row < eliminated && t.col < eliminated)
        .map(|t| Triplet::new(t.row, t.col, *t.val))
        .collect();
    let leading =
        SparseColMat::<usize, f64>::try_new_from_triplets(eliminated, eliminated, &leading).unwrap();
    let group: Vec<usize> = (0..eliminated).map(|row| row / 3).collect();
    let mut order = nested_dissection(leading.symbolic(), &group);
    order.extend(eliminated..n);
    let a = permute(a, &order);
    permute(&a, &postorder(a.symbolic(), 0..eliminated))
}

fn blocks(a: &SparseColMat<usize, f64>, e: usize) -> (Mat<f64>, Mat<f64>) {
    let dense = a.to_dense();
    let n = a.nrows();
    (dense.submatrix(0, 0, e, e).to_owned(), dense.submatrix(e, 0, n - e, e).to_owned())
}

#[test]
fn leaves_the_schur_complement_and_solves() {
    for (size, boundary, shift) in [(1, 0, 0.0), (2, 3, 0.0), (9, 31, 0.0), (16, 57, 0.0), (9, 31, 7.3)] {
        let a = grid(size, shift);
        let e = a.nrows() - boundary;
        let a = ordered(&a, e);
        let analysis = Analysis::new(a.symbolic(), e);
        let factor = PartialFactor::new(&analysis, &[(0.25, &a), (0.75, &a)]).unwrap();
        let (inner, coupling) = blocks(&a, e);
        let lu = inner.partial_piv_lu();
        let schur = &coupling * lu.solve(coupling.transpose());
        for j in 0..boundary {
            for i in j..boundary {
                assert!((factor.schur()[(i, j)] + schur[(i, j)]).abs() < 1e-10, "{size} {boundary} {i} {j}");
            }
        }
        let below = inner.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let negative = below.iter().filter(|&&value| value < 0.0).count();
        let inertia = Inertia::new(&analysis, &[(1.0, &a)]).unwrap();
        assert_eq!(inertia.negative, negative);
        assert_eq!(negative > 0, shift > 0.0);
        assert!(inertia.growth < 1e6);
        assert!((&inertia.schur - factor.schur()).norm_max() < 1e-12);

        // Widths of a register, of several, and of more than one group of them.
        for width in [1, 3, 8, 24, 40, 61] {
            let given = Mat::from_fn(width, a.nrows(), |i, j| ((i + 2) as f64 * j as f64).sin());
            let mut x = Panel::zeros(width, a.nrows());
            (0..a.nrows())
                .for_each(|j| x.row_mut(j).iter_mut().zip(given.col(j).iter()).for_each(|(x, g)| *x = *g));
            factor.forward(&mut x);
            for (j, d) in factor.pivots().iter().enumerate() {
                x.row_mut(j).iter_mut().for_each(|x| *x /= d);
            }
            // What the boundary has become is S-free: x_F − A_FI A_II⁻¹ x_I.
            let reached = given.subcols(0, e) * lu.solve(coupling.transpose());
            for j in 0..boundary {
                for i in 0..width {
                    assert!((x.row(e + j)[i] - (given[(i, e + j)] - reached[(i, j)])).abs() < 1e-9);
                }
                x.row_mut(e + j).fill(0.0);
            }
            factor.backward(&mut x);
            let solution = lu.solve(given.subcols(0, e).transpose());
            for j in 0..e {
                for i in 0..width {
                    assert!((x.row(j)[i] - solution[(j, i)]).abs() < 1e-9, "{size} {boundary} {width}");
                }
            }
        }
    }
}

/// Solves where all rows are one front, wider than the columns that are packed together.
#[test]
fn solves_with_a_wide_front() {
    let (n, e) = (330, 301);
    let entry = |i: usize, j: usize| ((i + 1) * (j + 1)) as f64;
    let triplets: Vec<_> = (0..n)
        .flat_map(|i| (0..n).map(move |j| (i, j)))
        .map(|(i, j)| Triplet::new(i, j, entry(i, j).sin() + if i == j { 400.0 } else { 0.0 }))
        .collect();
    let a = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets).unwrap();
    let analysis = Analysis::new(a.symbolic(), e);
    let factor = PartialFactor::new(&analysis, &[(1.0, &a)]).unwrap();
    let (inner, coupling) = blocks(&a, e);
    let mut x = Panel::zeros(9, n);
    (0..e).for_each(|j| x.row_mut(j).iter_mut().enumerate().for_each(|(i, x)| *x = entry(i, j).cos()));
    factor.forward(&mut x);
    for (j, d) in factor.pivots().iter().enumerate() {
        x.row_mut(j).iter_mut().for_each(|x| *x /= d);
    }
    let solution = inner.partial_piv_lu().solve(Mat::from_fn(e, 9, |j, i| entry(i, j).cos()));
    let reached = &coupling * &solution;
    for j in e..n {
        (0..9).for_each(|i| assert!((x.row(j)[i] + reached[(j - e, i)]).abs() < 1e-9, "{j} {i}"));
        x.row_mut(j).fill(0.0);
    }
    factor.backward(&mut x);
    for j in 0..e {
        (0..9).for_each(|i| assert!((x.row(j)[i] - solution[(j, i)]).abs() < 1e-12, "{j} {i}"));
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let a = ordered(&grid(60, 0.0), 60 * 60 * 3 - 180);
    let analysis = Analysis::new(a.symbolic(), a.nrows() - 180);
    assert!(analysis.subtrees.len() > 4 && !analysis.top.is_empty());
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let factor = PartialFactor::new(&analysis, &[(1.0, &a)]).unwrap();
            let sum = |m: &Mat<f64>| {
                m.col_iter().flat_map(|c| c.iter().map(|v| v.to_bits()).collect::<Vec<_>>()).collect()
            };
            let schur: Vec<u64> = sum(factor.schur());
            (schur, factor.pivots().iter().map(|v| v.to_bits()).collect::<Vec<_>>())
        })
    };
    assert!(bits(1) == bits(3));
}

#[test]
fn a_zero_pivot_is_an_error() {
    let triplets = [Triplet::new(0, 0, 1.0), Triplet::new(1, 1, 0.0)];
    let a = SparseColMat::<usize, f64>::try_new_from_triplets(2, 2, &triplets).unwrap();
    let analysis = Analysis::new(a.symbolic(), 2);
    assert_eq!(PartialFactor::new(&analysis, &[(1.0, &a)]).unwrap_err(), Breakdown { row: 1 });
}
