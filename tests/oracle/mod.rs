//! Literal dense scheme of the paper (Eqs 8–10) on the whole reduced wheel: the slow truth of tests and the baseline of
//! benchmarks. Nothing here is shared with the production step but the reduced matrices it starts from: physical
//! contact DOF of all sectors, dense products, nalgebra's factorisations, and an iterative complementarity solver.

pub(crate) mod cyclic;
pub(crate) mod heights;
pub(crate) mod plain;
pub(crate) mod schemes;

use std::f64::consts::TAU;
use std::ops::Range;

use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector, DVectorView};
use rubmap::dynamics::casing::Casing;
use rubmap::dynamics::reduction::ReducedWheel;

/// Real matrices of the whole reduced wheel: contact DOF of sector 0, 1, … first, then the modal coordinates of
/// all nodal diameters.
pub(crate) struct DenseWheel {
    pub(crate) mass: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    contact_dofs: usize,
    sectors: usize,
}

impl DenseWheel {
    pub(crate) fn new(reduced: &ReducedWheel, speed_rad_s: f64, stiffening: bool) -> Self {
        let harmonics = |of: &dyn Fn(usize) -> Mat<c64>| -> DMatrix<f64> {
            let blocks: Vec<_> =
                (0..reduced.harmonics.len()).map(|i| real_form(&of(i), i, reduced.sectors)).collect();
            recompose(&blocks, reduced)
        };
        Self {
            mass: harmonics(&|i| reduced.harmonics[i].mass.clone()),
            stiffness: harmonics(&|i| reduced.harmonics[i].stiffness.at(speed_rad_s, stiffening)),
            contact_dofs: reduced.contact_dofs(),
            sectors: reduced.sectors,
        }
    }

    /// Damping matrix D with the same ratio for every mode: 2ζ M Φ diag(ω) Φᵀ M.
    pub(crate) fn modal_damping(&self, ratio: f64) -> DMatrix<f64> {
        let lower = self.mass.clone().cholesky().expect("M_r is positive definite").l();
        let half = lower.solve_lower_triangular(&self.stiffness).unwrap();
        let standard = lower.solve_lower_triangular(&half.transpose()).unwrap();
        let eigen = ((&standard + standard.transpose()) * 0.5).symmetric_eigen();
        let omega = DMatrix::from_diagonal(&eigen.eigenvalues.map(|l| 2.0 * ratio * l.max(0.0).sqrt()));
        let scaled = &lower * &eigen.eigenvectors;
        &scaled * omega * scaled.transpose()
    }

    pub(crate) fn size(&self) -> usize {
        self.mass.nrows()
    }
}

/// Real form of a Hermitian Y: on x = a + jb as a real symmetric matrix on (a, b); single harmonics are real already.
fn real_form(y: &Mat<c64>, harmonic: usize, sectors: usize) -> DMatrix<f64> {
    let n = y.nrows();
    if harmonic == 0 || 2 * harmonic == sectors {
        return DMatrix::from_fn(n, n, |i, j| y[(i, j)].re);
    }
    DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        let value = y[(i % n, j % n)];
        match (i < n, j < n) {
            (true, true) | (false, false) => value.re,
            (true, false) => -value.im,
            (false, true) => value.im,
        }
    })
}

/// Whole matrix of Eq. 7: block diagonal over the harmonics, contact DOF turned from harmonics to sectors.
fn recompose(blocks: &[DMatrix<f64>], reduced: &ReducedWheel) -> DMatrix<f64> {
    let sectors = reduced.sectors;
    let n_b = reduced.contact_dofs();
    let total: usize = blocks.iter().map(DMatrix::nrows).sum();
    let mut diagonal = DMatrix::zeros(total, total);
    // Rows of `turn`: harmonic coordinates; columns: contact DOF by sector, then modal coordinates.
    let mut turn = DMatrix::zeros(total, total);
    let (mut row, mut modal) = (0, sectors * n_b);
    for (i, block) in blocks.iter().enumerate() {
        let size = block.nrows();
        diagonal.view_mut((row, row), (size, size)).copy_from(block);
        let single = i == 0 || 2 * i == sectors;
        let parts = if single { 1 } else { 2 };
        let n = size / parts;
        for part in 0..parts {
            for local in 0..n {
                let at = row + part * n + local;
                if local < n_b {
                    for s in 0..sectors {
                        let angle = TAU * (i * s % sectors) as f64 / sectors as f64;
                        let weight = match (single, part) {
                            (true, _) => angle.cos() / (sectors as f64).sqrt(),
                            (false, 0) => (2.0 / sectors as f64).sqrt() * angle.cos(),
                            (false, _) => -(2.0 / sectors as f64).sqrt() * angle.sin(),
                        };
                        turn[(at, s * n_b + local)] = weight;
                    }
                } else {
                    turn[(at, modal)] = 1.0;
                    modal += 1;
                }
            }
        }
        row += size;
    }
    turn.transpose() * diagonal * turn
}

/// Constraint matrix C_N: a column per contact node of the wheel, its outward normal.
fn constraints(wheel: &DenseWheel, reduced: &ReducedWheel) -> DMatrix<f64> {
    let nodes = reduced.contact.len();
    let mut constraints = DMatrix::zeros(wheel.size(), wheel.sectors * nodes);
    for s in 0..wheel.sectors {
        for (k, node) in reduced.contact.iter().enumerate() {
            let first = s * wheel.contact_dofs + 3 * k;
            for d in 0..3 {
                constraints[(first + d, s * nodes + k)] = node.normal[d];
            }
        }
    }
    constraints
}

/// Scheme of Eqs 8–10, step by step, with complementarity over all contact nodes.
pub(crate) struct DenseScheme {
    predict_now: DMatrix<f64>,
    predict_before: DMatrix<f64>,
    /// Response A⁻¹ C_N.
    response: DMatrix<f64>,
    /// DOF and components of every node's outward normal, sector by sector.
    normals: Vec<(Range<usize>, [f64; 3])>,
    delassus: DMatrix<f64>,
    now: DVector<f64>,
    before: DVector<f64>,
    next: DVector<f64>,
    gap: DVector<f64>,
    /// Contact forces of the last step, sector by sector.
    pub(crate) lambda: DVector<f64>,
    contact_nodes: usize,
    pub(crate) contact_steps: u64,
}

impl DenseScheme {
    pub(crate) fn new(wheel: &DenseWheel, damping: &DMatrix<f64>, reduced: &ReducedWheel, h: f64) -> Self {
        let a = &wheel.mass / (h * h) + damping / (2.0 * h);
        let a = a.cholesky().expect("M/h² + D/2h is positive definite");
        let nodes = reduced.contact.len();
        let constraints = constraints(wheel, reduced);
        let mut normals = Vec::new();
        for s in 0..wheel.sectors {
            for (k, node) in reduced.contact.iter().enumerate() {
                let first = s * wheel.contact_dofs + 3 * k;
                normals.push((first..first + 3, node.normal));
            }
        }
        let response = a.solve(&constraints);
        Self {
            predict_now: a.solve(&(&wheel.mass * (2.0 / (h * h)) - &wheel.stiffness)),
            predict_before: a.solve(&(damping / (2.0 * h) - &wheel.mass / (h * h))),
            delassus: constraints.transpose() * &response,
            response,
            now: DVector::zeros(wheel.size()),
            before: DVector::zeros(wheel.size()),
            next: DVector::zeros(wheel.size()),
            gap: DVector::zeros(wheel.sectors * nodes),
            lambda: DVector::zeros(wheel.sectors * nodes),
            normals,
            contact_nodes: nodes,
            contact_steps: 0,
        }
    }

    /// Takes one step; `free_gap[sector·nodes + node]` is c − p at its end, `solve(W, g_p, λ)` the contact solver.
    pub(crate) fn step(
        &mut self,
        free_gap: &[f64],
        solve: impl FnOnce(&DMatrix<f64>, &DVector<f64>, &mut DVector<f64>),
    ) {
        let mut next = std::mem::take(&mut self.next);
        next.gemv(1.0, &self.predict_before, &self.before, 0.0);
        next.gemv(1.0, &self.predict_now, &self.now, 1.0);
        for (pair, (dofs, normal)) in self.normals.iter().enumerate() {
            let outward: f64 = dofs.clone().zip(normal).map(|(dof, n)| n * next[dof]).sum();
            self.gap[pair] = free_gap[pair] - outward;
        }
        if self.gap.iter().any(|&g| g < 0.0) {
            solve(&self.delassus, &self.gap, &mut self.lambda);
            next.gemv(-1.0, &self.response, &self.lambda, 1.0);
            self.contact_steps += 1;
        } else {
            self.lambda.fill(0.0);
        }
        self.next = std::mem::replace(&mut self.before, std::mem::replace(&mut self.now, next));
    }

    /// Contact DOF of one node of one sector.
    pub(crate) fn contact_displacement(&self, sector: usize, node: usize) -> DVectorView<'_, f64> {
        self.now.rows((sector * self.contact_nodes + node) * 3, 3)
    }
}

/// Solves for contact by projected Gauss–Seidel to the last digit: slow, short, and unlike the production solver.
pub(crate) fn gauss_seidel(w: &DMatrix<f64>, gap: &DVector<f64>, lambda: &mut DVector<f64>) {
    lambda.fill(0.0);
    for _ in 0..100_000 {
        let mut change: f64 = 0.0;
        let mut scale: f64 = 0.0;
        for i in 0..gap.len() {
            let g = gap[i] + w.column(i).dot(lambda);
            let solved = (lambda[i] - g / w[(i, i)]).max(0.0);
            change = change.max((solved - lambda[i]).abs());
            scale = scale.max(solved);
            lambda[i] = solved;
        }
        if change <= 1e-15 * scale {
            return;
        }
    }
    panic!("Gauss–Seidel did not converge");
}

/// Free gaps c − p at every node of every sector, literally, after `revolutions`; negative revolutions turn the other way.
pub(crate) fn free_gaps(casing: &Casing, reduced: &ReducedWheel, revolutions: f64) -> Vec<f64> {
    let mut gaps = Vec::new();
    for s in 0..reduced.sectors {
        for (k, node) in reduced.contact.iter().enumerate() {
            let angle = node.position[1] + TAU * (s as f64 / reduced.sectors as f64 + revolutions);
            let p = casing.restriction.as_ref().map_or(0.0, |shape| heights::height(shape, angle, k));
            let x = (revolutions.abs() / casing.ramp_revolutions).min(1.0);
            gaps.push(casing.clearance[k] - p * x * x * (3.0 - 2.0 * x));
        }
    }
    gaps
}
