//! Sparse Cholesky factorisation A = Pᵀ L Lᴴ P of positive definite matrices, real or Hermitian, nested-dissection
//! ordered.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SymbolicSupernodalCholesky};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef, Triplet};
use faer::traits::{
    ComplexField,
    math_utils::{is_finite, zero},
};
use faer::{Conj, MatMut, Par, Side};

use super::nested_dissection::nested_dissection;

/// Error: the matrix is not positive definite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite")]
pub struct NotPositiveDefinite;

/// Fill-reducing order and symbolic factor of one sparsity pattern, reused for every matrix with that pattern.
#[derive(Debug)]
pub struct SymbolicFactor {
    /// Order of elimination: `forward[new] = old`.
    forward: Vec<usize>,
    /// Inverse of the order: `inverse[old] = new`.
    inverse: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
}

impl SymbolicFactor {
    /// Orders and analyses `pattern` (square, symmetric in structure, both triangles).
    ///
    /// `group[row]` names the node a row belongs to: rows of one node are neighbours in the elimination order, and
    /// the ordering works on the much smaller graph of nodes.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, usize>, group: &[usize]) -> Self {
        let forward = nested_dissection(pattern, group);
        let mut inverse = vec![0; forward.len()];
        for (new, &old) in forward.iter().enumerate() {
            inverse[old] = new;
        }
        let permutation = PermRef::new_checked(&forward, &inverse, forward.len());
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Custom(permutation), params)
                .unwrap_or_else(|_| {
                    panic!("out of memory in the symbolic factorisation of {} rows", forward.len())
                });
        Self { forward, inverse, symbolic }
    }

    /// Number of rows and columns of the matrices this factor is for.
    pub fn size(&self) -> usize {
        self.forward.len()
    }

    /// Permutes to P A Pᵀ: `a` (same size, any pattern) with rows and columns in elimination order.
    pub fn permute<T: ComplexField>(&self, a: &SparseColMat<usize, T>) -> SparseColMat<usize, T> {
        let n = self.size();
        let triplets: Vec<_> = a
            .triplet_iter()
            .map(|t| Triplet::new(self.inverse[t.row], self.inverse[t.col], t.val.clone()))
            .collect();
        SparseColMat::try_new_from_triplets(n, n, &triplets).expect("a permutation keeps indices in range")
    }

    fn supernodal(&self) -> &SymbolicSupernodalCholesky<usize> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(raw) => raw,
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("the supernodal form was demanded"),
        }
    }
}

/// Numeric factor L of one matrix.
#[derive(Debug)]
pub struct SparseCholesky<'s, T> {
    symbolic: &'s SymbolicFactor,
    values: Vec<T>,
}

impl<'s, T: ComplexField> SparseCholesky<'s, T> {
    /// Factorises the symmetric or Hermitian matrix `a` (lower triangle read) whose pattern `symbolic` was made from.
    pub fn new(
        symbolic: &'s SymbolicFactor,
        a: &SparseColMat<usize, T>,
    ) -> Result<Self, NotPositiveDefinite> {
        let mut values = vec![zero::<T>(); symbolic.symbolic.len_val()];
        let scratch =
            symbolic.symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, faer::prelude::default());
        symbolic
            .symbolic
            .factorize_numeric_llt(
                &mut values,
                a.as_ref(),
                Side::Lower,
                faer::prelude::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                faer::prelude::default(),
            )
            .map_err(|_| NotPositiveDefinite)?;
        if values.iter().all(is_finite) { Ok(Self { symbolic, values }) } else { Err(NotPositiveDefinite) }
    }

    /// Pattern and order of this factor.
    pub fn symbolic(&self) -> &'s SymbolicFactor {
        self.symbolic
    }

    /// Solves x ← A⁻¹ x for every column of `x`, in the matrix's own row order.
    pub fn solve_in_place(&self, x: MatMut<'_, T>) {
        let mut permuted = self.gather(x.as_ref());
        self.lower_solve_in_place(permuted.as_mut());
        self.lower_adjoint_solve_in_place(permuted.as_mut());
        self.scatter(permuted.as_ref(), x);
    }

    /// Solves y ← L⁻¹ y, rows in elimination order.
    pub fn lower_solve_in_place(&self, y: MatMut<'_, T>) {
        let mut scratch = self.scratch(y.ncols());
        self.factor().l_solve_with_conj(Conj::No, y, Par::Seq, MemStack::new(&mut scratch));
    }

    /// Solves y ← L⁻ᴴ y, rows in elimination order.
    pub fn lower_adjoint_solve_in_place(&self, y: MatMut<'_, T>) {
        let mut scratch = self.scratch(y.ncols());
        self.factor().l_transpose_solve_with_conj(Conj::Yes, y, Par::Seq, MemStack::new(&mut scratch));
    }

    /// Brings rows of `x` into elimination order.
    fn gather(&self, x: faer::MatRef<'_, T>) -> faer::Mat<T> {
        faer::Mat::from_fn(x.nrows(), x.ncols(), |new, j| x[(self.symbolic.forward[new], j)].clone())
    }

    /// Brings rows of `y` from elimination order back into the matrix's own.
    pub fn scatter(&self, y: faer::MatRef<'_, T>, mut x: MatMut<'_, T>) {
        for j in 0..y.ncols() {
            for (new, &old) in self.symbolic.forward.iter().enumerate() {
                x[(old, j)] = y[(new, j)].clone();
            }
        }
    }

    fn factor(&self) -> SupernodalLltRef<'_, usize, T> {
        SupernodalLltRef::new(self.symbolic.supernodal(), &self.values)
    }

    fn scratch(&self, columns: usize) -> MemBuffer {
        MemBuffer::new(self.symbolic.supernodal().solve_in_place_scratch::<T>(columns, Par::Seq))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::{Mat, c64};

    /// Hermitian chain with complex couplings: diagonally dominant, so positive definite.
    fn chain(n: usize) -> SparseColMat<usize, c64> {
        let mut triplets = Vec::new();
        for i in 0..n {
            triplets.push(Triplet::new(i, i, c64::new(4.0 + i as f64 * 0.1, 0.0)));
            for (step, value) in [(1, c64::new(-1.0, 0.3)), (7, c64::new(0.2, -0.6))] {
                if i + step < n {
                    triplets.push(Triplet::new(i + step, i, value));
                    triplets.push(Triplet::new(i, i + step, value.conj()));
                }
            }
        }
        SparseColMat::try_new_from_triplets(n, n, &triplets).unwrap()
    }

    #[test]
    fn solves_what_it_factored() {
        for n in [1, 2, 9, 200] {
            let a = chain(n);
            let group: Vec<usize> = (0..n).map(|row| row / 3).collect();
            let symbolic = SymbolicFactor::new(a.symbolic(), &group);
            let factor = SparseCholesky::new(&symbolic, &a).unwrap();
            let expected = Mat::from_fn(n, 3, |i, j| c64::new((i + j) as f64 * 0.3 - 1.0, j as f64));
            let mut x = &a * &expected;
            factor.solve_in_place(x.as_mut());
            assert!((&x - &expected).norm_max() < 1e-12, "n = {n}");
        }
    }

    #[test]
    fn refuses_an_indefinite_matrix() {
        let triplets = [Triplet::new(0, 0, c64::new(1.0, 0.0)), Triplet::new(1, 1, c64::new(-1.0, 0.0))];
        let a = SparseColMat::try_new_from_triplets(2, 2, &triplets).unwrap();
        let symbolic = SymbolicFactor::new(a.symbolic(), &[0, 1]);
        assert_eq!(SparseCholesky::new(&symbolic, &a).unwrap_err(), NotPositiveDefinite);
    }
}
