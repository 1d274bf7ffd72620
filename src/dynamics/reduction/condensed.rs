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

use faer::prelude::ReborrowMut;
use faer::sparse::SparseColMat;
use faer::{Mat, MatMut, MatRef, c64};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::tied::{NotPositiveDefinite, TiedFactor, cholesky, tied_schur};
use super::untied::{Tie, UntiedSector};
use crate::numerics::multifrontal::PartialFactor;
use crate::numerics::sparse_product::symmetric_product;

/// The factor of the untied sector's interior at one stiffness.
pub(super) struct SectorFactor<'a> {
    untied: &'a UntiedSector,
    factor: PartialFactor<'a>,
    /// D^−½
    scale: Vec<f64>,
}

/// Vectors of one nodal diameter on their way through the sparse factor.
pub(super) struct Load<'a> {
    pub(super) tied: &'a TiedFactor,
    /// Tied vectors, over (interior, face) or (interior, face, contact).
    pub(super) vectors: Mat<c64>,
}

/// A pivot below this fraction of its diagonal entry is round-off: the matrix is singular, as far as double precision
/// can tell.
const SINGULAR: f64 = 1e-13;
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
        let diagonal = |row: usize| {
            let column = stiffness.row_idx_of_col(row).zip(stiffness.val_of_col(row));
            column.filter(|&(i, _)| i == row).map(|(_, value)| value).sum::<f64>()
        };
        if factor.pivots().iter().enumerate().any(|(row, &d)| d <= SINGULAR * diagonal(row)) {
            return Err(NotPositiveDefinite);
        }
        let scale = factor.pivots().iter().map(|d| 1.0 / d.sqrt()).collect();
        Ok(Self { untied, factor, scale })
    }

    /// What nodal diameter `harmonic` adds. Fails where the stiffness with fixed contact DOF is not positive definite.
    pub(super) fn tie(
        &self,
        stiffness: &SparseColMat<usize, f64>,
        harmonic: usize,
    ) -> Result<TiedFactor, NotPositiveDefinite> {
        TiedFactor::new(self.untied, &self.factor, stiffness, self.untied.tie(harmonic))
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
        let (interior, f, b) = (self.untied.interior(), self.untied.face(), self.untied.contact());
        let vectors = tied.at_unit_contact(interior);
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

/// The interior rows of a panel as tied vectors.
fn interior_of(tie: &Tie, panel: MatRef<'_, f64>, interior: usize) -> Mat<c64> {
    let single = UntiedSector::width(tie, 1) == 1;
    let count = if single { panel.nrows() } else { panel.nrows() / 2 };
    Mat::from_fn(interior, count, |row, q| {
        c64::new(panel[(q, row)], if single { 0.0 } else { panel[(count + q, row)] })
    })
}
