//! Independent, plain eigenvalue routines for small models: dense where possible, subspace iteration otherwise.

use std::collections::HashMap;
use std::f64::consts::PI;

use faer::linalg::solvers::{Llt, Solve};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side, c64};
use rubmap::package::raw::{RawMatrix, RawPackage};

/// Dense matrix with both triangles.
pub(crate) fn dense(matrix: &RawMatrix) -> Mat<f64> {
    let mut full = Mat::zeros(matrix.size, matrix.size);
    for &(r, c, v) in &matrix.entries {
        full[(r as usize, c as usize)] += v;
        if r != c {
            full[(c as usize, r as usize)] += v;
        }
    }
    full
}

/// Eigenvalues ω² of K x = ω² M x, all of them, ascending: Cholesky of M, then the standard problem.
pub(crate) fn dense_eigenvalues(stiffness: &RawMatrix, mass: &RawMatrix) -> Vec<f64> {
    let factor = dense(mass).llt(Side::Lower).expect("mass is positive definite");
    let l = factor.L();
    let mut a = dense(stiffness);
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(l, a.as_mut(), faer::Par::Seq);
    let mut a = a.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(l, a.as_mut(), faer::Par::Seq);
    a.self_adjoint_eigenvalues(Side::Lower).expect("converges")
}

/// Hermitian matrix of nodal diameter `i`: `u_high = u_low e^{jiα}` (docs/method.md, From a sector to harmonic matrices), both triangles.
pub(crate) fn harmonic(package: &RawPackage, matrix: &RawMatrix, i: usize) -> SparseColMat<usize, c64> {
    let alpha = 2.0 * PI / package.manifest.sectors as f64;
    let rows: HashMap<(u64, u8), usize> =
        package.dofs.iter().enumerate().map(|(row, d)| ((d.node, d.component), row)).collect();
    let low_of: HashMap<u64, u64> = package.manifest.cyclic.iter().map(|&[low, high]| (high, low)).collect();
    let turn = c64::new((alpha * i as f64).cos(), (alpha * i as f64).sin());
    let tie: Vec<(usize, c64)> = package
        .dofs
        .iter()
        .enumerate()
        .map(|(row, d)| match low_of.get(&d.node) {
            Some(&low) => (rows[&(low, d.component)], turn),
            None => (row, c64::new(1.0, 0.0)),
        })
        .collect();
    let own = package.dofs.len() - package.dofs.iter().filter(|d| low_of.contains_key(&d.node)).count();
    let mut triplets = Vec::new();
    for &(r, c, v) in &matrix.entries {
        let ((a, ta), (b, tb)) = (tie[r as usize], tie[c as usize]);
        let value = ta.conj() * tb * v;
        triplets.push(Triplet::new(a, b, value));
        if r != c {
            triplets.push(Triplet::new(b, a, value.conj()));
        }
    }
    SparseColMat::try_new_from_triplets(own, own, &triplets).expect("own rows come first")
}

/// Lowest `count` eigenvalues ω² of a Hermitian pencil with positive definite K, by subspace iteration; `None` if K has no Cholesky factor.
pub(crate) fn lowest(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    count: usize,
) -> Option<Vec<f64>> {
    let factor = k.sp_cholesky(Side::Lower).ok()?;
    let n = k.nrows();
    let width = (count + 8).min(n);
    // The start is pseudo-random and fixed.
    let mut state = 1u64;
    let mut x = Mat::from_fn(n, width, |_, _| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        c64::new((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5, 0.0)
    });
    let mut last = vec![0.0; count];
    for _ in 0..200 {
        let mx = m * &x;
        let y = factor.solve(&mx);
        // Ritz values θ = 1/ω² of K⁻¹ M in the K inner product: yᴴ K y = yᴴ M x.
        let b = y.adjoint() * &mx;
        let my = m * &y;
        let a = y.adjoint() * &my;
        let l: Llt<c64> = b.llt(Side::Lower).ok()?;
        let mut s = a;
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(l.L(), s.as_mut(), faer::Par::Seq);
        let mut s = s.adjoint().to_owned();
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(l.L(), s.as_mut(), faer::Par::Seq);
        let eigen = s.self_adjoint_eigen(Side::Lower).ok()?;
        let mut w = eigen.U().to_owned();
        faer::linalg::triangular_solve::solve_upper_triangular_in_place(
            l.L().adjoint(),
            w.as_mut(),
            faer::Par::Seq,
        );
        x = &y * &w;
        let values: Vec<f64> =
            (0..count).map(|j| 1.0 / eigen.S().column_vector()[width - 1 - j].re).collect();
        let change = values.iter().zip(&last).map(|(v, l)| ((v - l) / v).abs()).fold(0.0, f64::max);
        last = values;
        if change < 1e-11 {
            return Some(last);
        }
    }
    None
}

/// Lowest eigenvalues of a real symmetric pencil, as [`lowest`].
pub(crate) fn lowest_real(k: &RawMatrix, m: &RawMatrix, count: usize) -> Option<Vec<f64>> {
    let complex = |matrix: &RawMatrix| {
        let mut triplets = Vec::new();
        for &(r, c, v) in &matrix.entries {
            triplets.push(Triplet::new(r as usize, c as usize, c64::new(v, 0.0)));
            if r != c {
                triplets.push(Triplet::new(c as usize, r as usize, c64::new(v, 0.0)));
            }
        }
        SparseColMat::try_new_from_triplets(matrix.size, matrix.size, &triplets).expect("indices in range")
    };
    lowest(&complex(k), &complex(m), count)
}

/// Frequencies √ω²/2π, Hz.
pub(crate) fn hertz(eigenvalues: &[f64]) -> Vec<f64> {
    eigenvalues.iter().map(|v| v.max(0.0).sqrt() / (2.0 * PI)).collect()
}
