//! Floquet multipliers: the eigenvalues of the derivative of the map at a periodic motion, by which what disturbs it grows from one
//! passage to the next.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::matrix_free::LinOp;
use faer::matrix_free::eigen::{PartialEigenParams, partial_eigen, partial_eigen_scratch};
use faer::{Col, Mat, MatMut, MatRef, Par, c64};

use super::tangent::Tangent;

/// Numbers of a state up to which all multipliers are found at once.
const DENSE: usize = 300;

/// Residual, relative to the vector, at which a multiplier counts as found.
const FOUND: f64 = 1e-9;

/// Restarts of the search for the largest.
const RESTARTS: usize = 60;

/// A multiplier with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Multiplier {
    /// μ; of a complex pair both are listed.
    pub value: c64,
    /// ‖T v − μ v‖ / ‖v‖.
    pub residual: f64,
    /// Share of every nodal diameter in what grows, by energy.
    pub shares: Vec<f64>,
}

/// Up to `count` multipliers, the largest first; fewer where they did not converge.
pub fn multipliers(tangent: &Tangent<'_>, count: usize) -> Vec<Multiplier> {
    let size = tangent.size();
    let (values, vectors) = if size <= DENSE { all(tangent) } else { largest(tangent, count) };
    let mut found: Vec<_> =
        values.iter().enumerate().map(|(j, &value)| multiplier(tangent, value, vectors.col(j))).collect();
    found.sort_by(|a, b| b.value.norm().total_cmp(&a.value.norm()));
    found.truncate(count);
    found
}

fn all(tangent: &Tangent<'_>) -> (Vec<c64>, Mat<c64>) {
    let mut matrix = Mat::<f64>::identity(tangent.size(), tangent.size());
    tangent.apply(matrix.as_mut());
    match matrix.eigen() {
        Ok(pairs) => (pairs.S().column_vector().iter().copied().collect(), pairs.U().to_owned()),
        Err(_) => (Vec::new(), Mat::zeros(tangent.size(), 0)),
    }
}

fn largest(tangent: &Tangent<'_>, count: usize) -> (Vec<c64>, Mat<c64>) {
    let size = tangent.size();
    let params = PartialEigenParams {
        min_dim: 4 * count,
        max_dim: 8 * count,
        max_restarts: RESTARTS,
        ..Default::default()
    };
    let mut memory = MemBuffer::new(partial_eigen_scratch(tangent, count, Par::Seq, params));
    let (mut values, mut vectors) = (vec![c64::ZERO; count], Mat::zeros(size, count));
    // All unknowns alike: none of them is left out.
    let start = Col::from_fn(size, |_| 1.0 / (size as f64).sqrt());
    let info = partial_eigen(
        vectors.as_mut(),
        &mut values,
        tangent,
        start.as_ref(),
        FOUND,
        Par::Seq,
        MemStack::new(&mut memory),
        params,
    );
    values.truncate(info.n_converged_eigen);
    (values, vectors)
}

fn multiplier(tangent: &Tangent<'_>, value: c64, vector: faer::ColRef<'_, c64>) -> Multiplier {
    let size = tangent.size();
    let mut mapped = Mat::from_fn(size, 2, |i, part| if part == 0 { vector[i].re } else { vector[i].im });
    tangent.apply(mapped.as_mut());
    let left = |i: usize| c64::new(mapped[(i, 0)], mapped[(i, 1)]) - value * vector[i];
    let squared = |of: &dyn Fn(usize) -> c64| (0..size).map(|i| of(i).norm_sqr()).sum::<f64>();
    let whole = squared(&|i| vector[i]);
    Multiplier {
        value,
        residual: (squared(&left) / whole).sqrt(),
        shares: tangent.shares(|i| vector[i].norm_sqr()).into_iter().map(|share| share / whole).collect(),
    }
}

impl LinOp<f64> for Tangent<'_> {
    fn apply_scratch(&self, _: usize, _: Par) -> StackReq {
        StackReq::EMPTY
    }

    fn nrows(&self) -> usize {
        self.size()
    }

    fn ncols(&self) -> usize {
        self.size()
    }

    fn apply(&self, mut out: MatMut<'_, f64>, rhs: MatRef<'_, f64>, _: Par, _: &mut MemStack) {
        // Column by column, whatever the layout of what is asked for.
        let mut states = rhs.to_owned();
        Tangent::apply(self, states.as_mut());
        out.copy_from(states);
    }

    fn conj_apply(&self, out: MatMut<'_, f64>, rhs: MatRef<'_, f64>, par: Par, stack: &mut MemStack) {
        LinOp::apply(self, out, rhs, par, stack);
    }
}
