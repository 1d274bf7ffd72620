//! One real factor of the untied sector, and what each nodal diameter adds to it: a small dense factor.
//!
//! With the interior eliminated once, K_II = L D Lᵀ, a nodal diameter's stiffness over (interior, low face) is
//!
//! ```text
//! K̂(i) = L̂ L̂ᴴ      L̂ = [ L D^½        0    ]      S(i) = Tᴴ (K_FF − K_FI K_II⁻¹ K_IF) T = L_S L_Sᴴ
//!                       [ Tᴴ L_F D^½   L_S  ]
//! ```
//!
//! Only the sum of both faces' own blocks enters S, so it does not matter which of them carries it, nor that neither
//! is definite on its own.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::prelude::ReborrowMut;
use faer::sparse::SparseColMat;
use faer::traits::ComplexField;
use faer::{Mat, MatMut, MatRef, Par, c64};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::untied::{Tie, UntiedSector};
use crate::numerics::multifrontal::PartialFactor;
use crate::numerics::sparse_product::symmetric_product;

/// Why a stiffness has no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotPositiveDefinite;

/// The factor of the untied sector's interior at one stiffness.
pub(super) struct SectorFactor<'a> {
    untied: &'a UntiedSector,
    factor: PartialFactor<'a>,
    /// D^−½
    scale: Vec<f64>,
}

/// L_S of one nodal diameter: low face first, contact DOF last.
pub(super) struct TiedFactor {
    pub(super) tie: Tie,
    /// Lower triangle, (face + contact)².
    lower: Mat<c64>,
    /// Whether the contact DOF may be free: the stiffness is positive definite with them too.
    pub(super) free: bool,
}

/// Vectors of one nodal diameter on their way through the sparse factor.
pub(super) struct Load<'a> {
    pub(super) tied: &'a TiedFactor,
    /// Tied vectors, over (interior, face) or (interior, face, contact).
    pub(super) vectors: Mat<c64>,
}

/// Real vectors solved together: enough for level-3 speed, few enough to share among threads.
const GROUP: usize = 24;

impl<'a> SectorFactor<'a> {
    /// Eliminates the interior of `stiffness` (untied). Fails where K_II is not positive definite.
    pub(super) fn new(
        untied: &'a UntiedSector,
        stiffness: &SparseColMat<usize, f64>,
    ) -> Result<Self, NotPositiveDefinite> {
        let factor =
            PartialFactor::new(&untied.analysis, &[(1.0, stiffness)]).map_err(|_| NotPositiveDefinite)?;
        if factor.negative_pivots() > 0 {
            return Err(NotPositiveDefinite);
        }
        let scale = factor.pivots().iter().map(|d| 1.0 / d.sqrt()).collect();
        Ok(Self { untied, factor, scale })
    }

    /// Factors S(i). Fails where the stiffness with fixed contact DOF is not positive definite.
    pub(super) fn tie(
        &self,
        stiffness: &SparseColMat<usize, f64>,
        harmonic: usize,
    ) -> Result<TiedFactor, NotPositiveDefinite> {
        let tie = self.untied.tie(harmonic);
        let mut lower = tied_schur(self.untied, &self.factor, &[(1.0, stiffness)], &tie);
        let f = self.untied.face();
        let (mut face, _, mut coupling, mut contact) = lower.as_mut().split_at_mut(f, f);
        cholesky(face.rb_mut(), &tie)?;
        // L_bf = S_bf L_ff⁻ᴴ
        solve_lower_triangular_in_place(
            face.as_ref().conjugate(),
            coupling.rb_mut().transpose_mut(),
            Par::Seq,
        );
        let update = &coupling * coupling.as_ref().adjoint();
        contact -= &update;
        let free = cholesky(contact.rb_mut(), &tie).is_ok();
        Ok(TiedFactor { tie, lower, free })
    }

    /// x ← L̂⁻ᴴ y for every load.
    pub(super) fn half_adjoint(&self, loads: &mut [Load<'_>]) {
        let groups = self.through(loads, |mut panel| {
            self.scale_interior(panel.rb_mut());
            self.factor.backward(panel);
        });
        self.collect_interior(loads, groups);
    }

    /// y ← L̂⁻¹ M̂ L̂⁻ᴴ y for every load, with `mass` untied.
    pub(super) fn apply(&self, mass: &SparseColMat<usize, f64>, loads: &mut [Load<'_>]) {
        let groups = self.through(loads, |mut panel| {
            self.scale_interior(panel.rb_mut());
            self.factor.backward(panel.rb_mut());
            let product = symmetric_product(mass, panel.as_ref());
            panel.copy_from(&product);
            self.factor.forward(panel.rb_mut());
            self.scale_interior(panel);
        });
        for (range, panel) in groups {
            let mut first = 0;
            for load in &mut loads[range] {
                let width = UntiedSector::width(&load.tied.tie, load.vectors.ncols());
                let rows = load.vectors.nrows();
                load.vectors = self.untied.fold(&load.tied.tie, panel.subrows(first, width), rows);
                load.tied.solve(load.vectors.as_mut(), self.untied.interior());
                first += width;
            }
        }
    }

    /// Whether the matrix of every nodal diameter is positive definite, contact DOF included, seen without factoring
    /// each: with S(i) = A + B e^{jiα} + Bᵀ e^{−jiα}, ‖S(i) − S(0)‖ ≤ 4 ‖B‖, and little reaches from face to face
    /// through a mass. `false` says nothing.
    pub(super) fn surely_definite(&self, matrix: &SparseColMat<usize, f64>) -> bool {
        let interior = self.untied.interior();
        let schur = self.factor.schur();
        let (mut through, mut direct) = (0.0, 0.0);
        for low in (0..schur.ncols()).filter(|&row| !self.untied.is_high(row)) {
            let column = interior + low;
            let high = |row: usize| row >= interior && self.untied.is_high(row - interior);
            through += (0..schur.nrows())
                .filter(|&row| self.untied.is_high(row))
                .map(|row| schur[(row.max(low), row.min(low))].powi(2))
                .sum::<f64>();
            direct += matrix
                .row_idx_of_col(column)
                .zip(matrix.val_of_col(column))
                .filter(|&(row, _)| high(row))
                .map(|(_, value)| value * value)
                .sum::<f64>();
        }
        let bound = 4.0 * (through.sqrt() + direct.sqrt());
        let tie = self.untied.tie(0);
        let mut shifted = tied_schur(self.untied, &self.factor, &[(1.0, matrix)], &tie);
        shifted.diagonal_mut().column_vector_mut().iter_mut().for_each(|value| *value -= bound);
        cholesky(shifted.as_mut(), &tie).is_ok()
    }

    /// Ψ_s = −K̂_ii⁻¹ K̂_ib of one nodal diameter, `n_i × n_b`.
    pub(super) fn static_modes(&self, tied: &TiedFactor) -> Mat<c64> {
        let (f, b) = (self.untied.face(), self.untied.contact());
        let interior = self.untied.interior();
        // Contact DOF at unit displacement, the face in equilibrium: S_ff x_f = −S_fb = −L_ff L_bfᴴ.
        let mut vectors = Mat::zeros(interior + f + b, b);
        vectors.subrows_mut(interior + f, b).diagonal_mut().fill(c64::new(1.0, 0.0));
        let mut face = vectors.subrows_mut(interior, f);
        face.copy_from(tied.lower.submatrix(f, 0, b, f).adjoint() * faer::Scale(c64::new(-1.0, 0.0)));
        solve_upper_triangular_in_place(tied.lower.submatrix(0, 0, f, f).adjoint(), face, Par::Seq);
        let columns: Vec<Mat<c64>> = (0..b)
            .step_by(GROUP / 2)
            .map(|first| vectors.subcols(first, (GROUP / 2).min(b - first)).to_owned())
            .collect();
        let solved: Vec<Mat<c64>> = columns
            .into_par_iter()
            .map(|columns| {
                let mut panel =
                    Mat::zeros(UntiedSector::width(&tied.tie, columns.ncols()), self.untied.size());
                self.untied.expand(&tied.tie, columns.as_ref(), panel.as_mut());
                self.factor.backward(panel.as_mut());
                let mut modes = columns.subrows(0, interior + f).to_owned();
                let solved = interior_of(&tied.tie, panel.as_ref(), interior);
                modes.subrows_mut(0, interior).copy_from(&solved);
                modes
            })
            .collect();
        let mut modes = Mat::zeros(interior + f, b);
        let mut first = 0;
        for part in solved {
            modes.subcols_mut(first, part.ncols()).copy_from(&part);
            first += part.ncols();
        }
        modes
    }

    /// Solves with the tied factors, then sends the loads in groups through `work`; groups in parallel.
    fn through(
        &self,
        loads: &mut [Load<'_>],
        work: impl Fn(MatMut<'_, f64>) + Sync,
    ) -> Vec<(std::ops::Range<usize>, Mat<f64>)> {
        let interior = self.untied.interior();
        let width = |load: &Load<'_>| UntiedSector::width(&load.tied.tie, load.vectors.ncols());
        for load in loads.iter_mut() {
            load.tied.solve_adjoint(load.vectors.as_mut(), interior);
        }
        let mut ranges = Vec::new();
        let mut start = 0;
        let mut held = 0;
        for (index, load) in loads.iter().enumerate() {
            if held > 0 && held + width(load) > GROUP {
                ranges.push(start..index);
                (start, held) = (index, 0);
            }
            held += width(load);
        }
        ranges.push(start..loads.len());
        let loads = &*loads;
        ranges
            .into_par_iter()
            .map(|range| {
                let members = &loads[range.clone()];
                let mut panel = Mat::zeros(members.iter().map(width).sum(), self.untied.size());
                let mut first = 0;
                for load in members {
                    let rows = panel.subrows_mut(first, width(load));
                    self.untied.expand(&load.tied.tie, load.vectors.as_ref(), rows);
                    first += width(load);
                }
                work(panel.as_mut());
                (range, panel)
            })
            .collect()
    }

    fn collect_interior(&self, loads: &mut [Load<'_>], groups: Vec<(std::ops::Range<usize>, Mat<f64>)>) {
        let interior = self.untied.interior();
        for (range, panel) in groups {
            let mut first = 0;
            for load in &mut loads[range] {
                let width = UntiedSector::width(&load.tied.tie, load.vectors.ncols());
                let solved = interior_of(&load.tied.tie, panel.subrows(first, width), interior);
                load.vectors.subrows_mut(0, interior).copy_from(&solved);
                first += width;
            }
        }
    }

    fn scale_interior(&self, mut panel: MatMut<'_, f64>) {
        for (row, scale) in self.scale.iter().enumerate() {
            panel.rb_mut().col_mut(row).iter_mut().for_each(|value| *value *= scale);
        }
    }
}

impl TiedFactor {
    /// x_F ← L_S⁻¹ x_F, with as many boundary rows as `x` has below row `interior`.
    fn solve(&self, x: MatMut<'_, c64>, interior: usize) {
        let rows = x.nrows() - interior;
        let lower = self.lower.submatrix(0, 0, rows, rows);
        solve_lower_triangular_in_place(lower, x.subrows_mut(interior, rows), Par::Seq);
    }

    /// x_F ← L_S⁻ᴴ x_F.
    fn solve_adjoint(&self, x: MatMut<'_, c64>, interior: usize) {
        let rows = x.nrows() - interior;
        let lower = self.lower.submatrix(0, 0, rows, rows);
        solve_upper_triangular_in_place(lower.adjoint(), x.subrows_mut(interior, rows), Par::Seq);
    }
}

/// S(i) = Tᴴ (A_FF − A_FI A_II⁻¹ A_IF) T over (face, contact), both triangles, for A = Σ factor · matrix, the sum `factor`
/// was made from.
pub(super) fn tied_schur(
    untied: &UntiedSector,
    factor: &PartialFactor<'_>,
    terms: &[(f64, &SparseColMat<usize, f64>)],
    tie: &Tie,
) -> Mat<c64> {
    let rows = untied.boundary(tie);
    let size = untied.face() + untied.contact();
    let interior = untied.interior();
    let mut schur = Mat::zeros(size, size);
    let mut add = |p: usize, q: usize, value: f64| {
        let ((row, left), (column, right)) = (rows[p], rows[q]);
        schur[(row, column)] += left.conj() * right * value;
    };
    for q in 0..rows.len() {
        let column = interior + q;
        for (scale, matrix) in terms {
            for (row, &value) in matrix.row_idx_of_col(column).zip(matrix.val_of_col(column)) {
                if row >= interior {
                    add(row - interior, q, scale * value);
                }
            }
        }
        let eliminated = factor.schur().col(q);
        add(q, q, eliminated[q]);
        for p in q + 1..rows.len() {
            add(p, q, eliminated[p]);
            add(q, p, eliminated[p]);
        }
    }
    schur
}

/// The interior rows of a panel as tied vectors.
fn interior_of(tie: &Tie, panel: MatRef<'_, f64>, interior: usize) -> Mat<c64> {
    let single = UntiedSector::width(tie, 1) == 1;
    let count = if single { panel.nrows() } else { panel.nrows() / 2 };
    Mat::from_fn(interior, count, |row, q| {
        c64::new(panel[(q, row)], if single { 0.0 } else { panel[(count + q, row)] })
    })
}

/// Lower Cholesky factor in place; in real arithmetic, four times cheaper, where the nodal diameter is real.
fn cholesky(mut matrix: MatMut<'_, c64>, tie: &Tie) -> Result<(), NotPositiveDefinite> {
    if UntiedSector::width(tie, 1) == 2 {
        return cholesky_of(matrix);
    }
    let mut real = Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].re);
    cholesky_of(real.as_mut())?;
    for j in 0..matrix.ncols() {
        for i in j..matrix.nrows() {
            matrix[(i, j)] = c64::new(real[(i, j)], 0.0);
        }
    }
    Ok(())
}

fn cholesky_of<T: ComplexField>(matrix: MatMut<'_, T>) -> Result<(), NotPositiveDefinite> {
    let scratch = cholesky_in_place_scratch::<T>(matrix.nrows(), Par::Seq, faer::prelude::default());
    let stack = &mut MemBuffer::new(scratch);
    cholesky_in_place(
        matrix,
        faer::prelude::default(),
        Par::Seq,
        MemStack::new(stack),
        faer::prelude::default(),
    )
    .map(|_| ())
    .map_err(|_| NotPositiveDefinite)
}
