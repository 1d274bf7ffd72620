//! Reduction the plain way: every nodal diameter and speed a complex sparse factorisation of its own, modes by faer's
//! single-vector Lanczos (or densely), products by faer. The slow truth of tests and the baseline of the benchmark. Of
//! the production code it uses the complex sparse Cholesky factor, and no more.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::matrix_free::LinOp;
use faer::matrix_free::eigen::{
    PartialEigenParams, partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch,
};
use faer::sparse::SparseColMat;
use faer::{Col, Mat, MatMut, MatRef, Par, Side, c64};
use rubmap::dynamics::sector::SectorModel;
use rubmap::numerics::sparse_cholesky::{SparseCholesky, SymbolicFactor};

use super::cyclic::{HarmonicMatrix, Partition, harmonic_matrix};

/// Reduced matrices of one nodal diameter, contact DOF first.
pub(crate) struct PlainHarmonic {
    pub(crate) mass: Mat<c64>,
    /// Stiffness at each given speed.
    pub(crate) stiffness: Vec<Mat<c64>>,
    /// Eigenvalues λ of the fixed-interface modes at each given speed.
    pub(crate) eigenvalues: Vec<Vec<f64>>,
}

/// Solver by which modes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Solver {
    Dense,
    Lanczos,
}

/// Reduces one nodal diameter; directions of the joint basis below `tolerance` are dropped.
pub(crate) fn reduce(
    sector: &SectorModel,
    harmonic: usize,
    count: usize,
    tolerance: f64,
    solver: Solver,
) -> PlainHarmonic {
    let partition =
        Partition::new(sector.own_dofs(), sector.contact.iter().flat_map(|node| node.dofs).collect());
    let build = |matrix| harmonic_matrix(matrix, harmonic, sector.sectors, &partition);
    let mass = build(&sector.mass);
    let stiffness: Vec<HarmonicMatrix> = sector.stiffness.iter().map(build).collect();
    let (n_i, n_b) = (partition.internal.len(), partition.contact.len());
    let nodes: Vec<usize> = partition.internal.iter().map(|&dof| sector.node_of_dof[dof]).collect();
    let count = count.min(n_i);
    let mut joint = Mat::zeros(n_i, count * stiffness.len());
    let mut static_modes = Mat::zeros(n_i, n_b);
    let mut eigenvalues = Vec::new();
    for (index, k) in stiffness.iter().enumerate() {
        let symbolic = SymbolicFactor::new(k.internal.symbolic(), &compress(&nodes));
        let factor = SparseCholesky::new(&symbolic, &k.internal).unwrap();
        if index == 0 {
            static_modes = k.coupling.to_dense() * faer::Scale(c64::new(-1.0, 0.0));
            factor.solve_in_place(static_modes.as_mut());
        }
        let (values, vectors) = match solver {
            Solver::Dense => dense_modes(k, &mass, count),
            Solver::Lanczos => lanczos_modes(&symbolic, &factor, &mass.internal, count),
        };
        eigenvalues.push(values);
        joint.subcols_mut(index * count, count).copy_from(&vectors);
    }
    let gram = joint.adjoint() * (&mass.internal * &joint);
    let eigen = gram.self_adjoint_eigen(Side::Lower).unwrap();
    let sizes: Vec<f64> = eigen.S().column_vector().iter().map(|s| s.re).collect();
    let largest = sizes.iter().fold(0.0f64, |m, &s| m.max(s));
    let kept: Vec<usize> = (0..sizes.len()).filter(|&c| sizes[c] > tolerance * tolerance * largest).collect();
    let scaled =
        Mat::from_fn(sizes.len(), kept.len(), |i, j| eigen.U()[(i, kept[j])] / sizes[kept[j]].sqrt());
    let modes = &joint * scaled;
    let project = |y: &HarmonicMatrix| project(y, &static_modes, &modes);
    PlainHarmonic { mass: project(&mass), stiffness: stiffness.iter().map(project).collect(), eigenvalues }
}

/// Projected matrix Υ̂ᴴ Ŷ Υ̂, Υ̂ = [I 0; Ψ_s Ψ*].
fn project(y: &HarmonicMatrix, static_modes: &Mat<c64>, modes: &Mat<c64>) -> Mat<c64> {
    let (n_b, r) = (static_modes.ncols(), modes.ncols());
    let inner = &y.internal * static_modes + y.coupling.to_dense();
    let contact =
        y.contact.to_dense() + y.coupling.adjoint() * static_modes + static_modes.adjoint() * &inner;
    let mixed = inner.adjoint() * modes;
    let modal = modes.adjoint() * (&y.internal * modes);
    Mat::from_fn(n_b + r, n_b + r, |i, j| match (i < n_b, j < n_b) {
        (true, true) => contact[(i, j)],
        (true, false) => mixed[(i, j - n_b)],
        (false, true) => mixed[(j, i - n_b)].conj(),
        (false, false) => modal[(i - n_b, j - n_b)],
    })
}

fn dense_modes(k: &HarmonicMatrix, mass: &HarmonicMatrix, count: usize) -> (Vec<f64>, Mat<c64>) {
    let lower = mass.internal.to_dense().llt(Side::Lower).unwrap().L().to_owned();
    let n = lower.nrows();
    let mut standard = k.internal.to_dense();
    let solve = |matrix: &mut Mat<c64>| {
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(
            lower.as_ref(),
            matrix.as_mut(),
            Par::Seq,
        );
    };
    solve(&mut standard);
    let mut standard = standard.adjoint().to_owned();
    solve(&mut standard);
    let scale = standard.norm_max();
    let unit = Mat::from_fn(n, n, |i, j| (standard[(i, j)] + standard[(j, i)].conj()) * (0.5 / scale));
    let eigen = unit.self_adjoint_eigen(Side::Lower).unwrap();
    let mut vectors = eigen.U().subcols(0, count).to_owned();
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(
        lower.adjoint(),
        vectors.as_mut(),
        Par::Seq,
    );
    ((0..count).map(|m| eigen.S().column_vector()[m].re * scale).collect(), vectors)
}

/// Operator y ↦ L⁻¹ M L⁻ᴴ y, with M in elimination order, scaled to norm one for the solver's absolute tolerance.
struct ShiftInvert<'a> {
    factor: &'a SparseCholesky<'a, c64>,
    mass: SparseColMat<usize, c64>,
    scale: f64,
}

impl std::fmt::Debug for ShiftInvert<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("ShiftInvert")
    }
}

impl LinOp<c64> for ShiftInvert<'_> {
    fn apply_scratch(&self, _columns: usize, _par: Par) -> StackReq {
        StackReq::EMPTY
    }

    fn nrows(&self) -> usize {
        self.mass.nrows()
    }

    fn ncols(&self) -> usize {
        self.mass.ncols()
    }

    fn apply(&self, mut out: MatMut<'_, c64>, rhs: MatRef<'_, c64>, _par: Par, _stack: &mut MemStack) {
        let mut x = rhs.to_owned();
        self.factor.lower_adjoint_solve_in_place(x.as_mut());
        let mut image = &self.mass * &x;
        self.factor.lower_solve_in_place(image.as_mut());
        out.copy_from(image * faer::Scale(c64::new(self.scale, 0.0)));
    }

    fn conj_apply(&self, _out: MatMut<'_, c64>, _rhs: MatRef<'_, c64>, _par: Par, _stack: &mut MemStack) {
        unreachable!("a Hermitian eigensolver does not ask for it")
    }
}

fn lanczos_modes(
    symbolic: &SymbolicFactor,
    factor: &SparseCholesky<'_, c64>,
    mass: &SparseColMat<usize, c64>,
    count: usize,
) -> (Vec<f64>, Mat<c64>) {
    let n = mass.nrows();
    let mut operator = ShiftInvert { factor, mass: symbolic.permute(mass), scale: 1.0 };
    let start = Col::from_fn(n, |i| c64::new(((i * 7919 % 10007) as f64 / 10007.0) - 0.5, 0.0));
    let mut probe = start.as_mat().to_owned();
    // A few power steps give the norm.
    for _ in 0..3 {
        let mut image = Mat::zeros(n, 1);
        operator.apply(image.as_mut(), probe.as_ref(), Par::Seq, MemStack::new(&mut []));
        operator.scale *= probe.norm_l2() / image.norm_l2();
        probe = image;
    }
    let params = PartialEigenParams { max_dim: 2 * count + 20, ..faer::prelude::default() };
    let scratch = partial_self_adjoint_eigen_scratch(&operator, count, Par::Seq, params);
    let mut vectors = Mat::zeros(n, count);
    let mut values = vec![c64::new(0.0, 0.0); count];
    let info = partial_self_adjoint_eigen(
        vectors.as_mut(),
        &mut values,
        &operator,
        start.as_ref(),
        1e-9,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        params,
    );
    assert!(info.n_converged_eigen >= count, "{} of {count} modes converged", info.n_converged_eigen);
    let theta: Vec<f64> = values.iter().map(|value| value.re / operator.scale).collect();
    factor.lower_adjoint_solve_in_place(vectors.as_mut());
    let mut modes = Mat::zeros(n, count);
    factor.scatter(vectors.as_ref(), modes.as_mut());
    for (m, theta) in theta.iter().enumerate() {
        modes.col_mut(m).iter_mut().for_each(|value| *value /= theta.sqrt());
    }
    (theta.iter().map(|theta| 1.0 / theta).collect(), modes)
}

/// Renumbers arbitrary labels to 0, 1, 2 … in order of appearance.
fn compress(labels: &[usize]) -> Vec<usize> {
    let mut known = std::collections::HashMap::new();
    labels
        .iter()
        .map(|&label| {
            let next = known.len();
            *known.entry(label).or_insert(next)
        })
        .collect()
}
