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

use super::tied_factor::{NotPositiveDefinite, TiedFactor, cholesky, tied_schur};
use super::untied::UntiedSector;
use rubmap_numerics::multifrontal::PartialFactor;
use rubmap_numerics::sparse_product::row_product;

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

impl Load<'_> {
    /// Real vectors that stand for it.
    fn width(&self) -> usize {
        UntiedSector::width(&self.tied.tie, self.vectors.ncols())
    }
}

/// Loads of a few columns each, so that they spread over the threads.
pub(super) fn split<'t>(tied: &'t TiedFactor, vectors: MatRef<'_, c64>) -> Vec<Load<'t>> {
    const COLUMNS: usize = 6;
    let count = vectors.ncols();
    let columns = |first: usize| vectors.subcols(first, COLUMNS.min(count - first)).to_owned();
    (0..count).step_by(COLUMNS).map(|first| Load { tied, vectors: columns(first) }).collect()
}

/// The vectors of all loads side by side.
pub(super) fn join(loads: &[Load<'_>]) -> Mat<c64> {
    let rows = loads.first().map_or(0, |load| load.vectors.nrows());
    let mut vectors = Mat::zeros(rows, loads.iter().map(|load| load.vectors.ncols()).sum());
    let mut first = 0;
    for load in loads {
        vectors.subcols_mut(first, load.vectors.ncols()).copy_from(&load.vectors);
        first += load.vectors.ncols();
    }
    vectors
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
        let factor = PartialFactor::new(&untied.analysis, &[(1.0, stiffness)])
            .map_err(|breakdown| NotPositiveDefinite { row: breakdown.row })?;
        let diagonal = |row: usize| {
            let column = stiffness.row_idx_of_col(row).zip(stiffness.val_of_col(row));
            column.filter(|&(i, _)| i == row).map(|(_, value)| value).sum::<f64>()
        };
        let mut pivots = factor.pivots().iter().enumerate();
        if let Some((row, _)) = pivots.find(|&(row, &d)| d <= SINGULAR * diagonal(row)) {
            return Err(NotPositiveDefinite { row });
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
        self.solve_tied_adjoint(loads);
        self.solve_interior(loads, |mut panel| {
            self.scale_interior(panel.rb_mut());
            self.factor.backward(panel);
        });
    }

    /// y ← L̂⁻¹ M̂ L̂⁻ᴴ y for every load, with `mass` untied.
    pub(super) fn apply(&self, mass: &SparseColMat<usize, f64>, loads: &mut [Load<'_>]) {
        self.solve_tied_adjoint(loads);
        let rows = loads.first().map_or(0, |load| load.vectors.nrows());
        let images = self.through(loads, rows, |mut panel| {
            self.scale_interior(panel.rb_mut());
            self.factor.backward(panel.rb_mut());
            let product = row_product(mass, panel.as_ref());
            panel.copy_from(&product);
            self.factor.forward(panel.rb_mut());
            self.scale_interior(panel);
        });
        for (load, image) in loads.iter_mut().zip(images) {
            load.vectors = image;
            load.tied.solve(load.vectors.as_mut(), self.untied.interior());
        }
    }

    /// x ← K̂⁻¹ f for every load, given with contact DOF that may be free.
    pub(super) fn solve(&self, loads: &mut [Load<'_>]) {
        let interior = self.untied.interior();
        let rows = loads.first().map_or(0, |load| load.vectors.nrows());
        let boundary: Vec<Mat<c64>> =
            loads.iter().map(|load| load.vectors.subrows(interior, rows - interior).to_owned()).collect();
        // Untied, what acts on the low face would act on the high one again.
        for load in &mut *loads {
            load.vectors.subrows_mut(interior, rows - interior).fill(c64::new(0.0, 0.0));
        }
        let images = self.through(loads, rows, |mut panel| {
            self.factor.forward(panel.rb_mut());
            self.scale_interior(panel);
        });
        for ((load, image), boundary) in loads.iter_mut().zip(images).zip(boundary) {
            load.vectors = image;
            let mut below = load.vectors.subrows_mut(interior, rows - interior);
            below += boundary;
            load.tied.solve(load.vectors.as_mut(), interior);
        }
        self.half_adjoint(loads);
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
        let mut loads = split(tied, tied.at_unit_contact(self.untied.interior()).as_ref());
        self.solve_interior(&mut loads, |panel| self.factor.backward(panel));
        join(&loads).subrows(0, self.untied.internal()).to_owned()
    }

    fn solve_tied_adjoint(&self, loads: &mut [Load<'_>]) {
        for load in loads {
            load.tied.solve_adjoint(load.vectors.as_mut(), self.untied.interior());
        }
    }

    /// Sends the loads through `work`, which leaves their boundary rows alone.
    fn solve_interior(&self, loads: &mut [Load<'_>], work: impl Fn(MatMut<'_, f64>) + Sync) {
        let interior = self.untied.interior();
        let solved = self.through(loads, interior, work);
        for (load, solved) in loads.iter_mut().zip(solved) {
            load.vectors.subrows_mut(0, interior).copy_from(&solved);
        }
    }

    /// Sends the loads, untied, in groups through `work`, and ties what comes out: its first `rows` rows, per load.
    /// Groups in parallel.
    fn through(
        &self,
        loads: &[Load<'_>],
        rows: usize,
        work: impl Fn(MatMut<'_, f64>) + Sync,
    ) -> Vec<Mat<c64>> {
        let mut groups: Vec<&[Load<'_>]> = Vec::new();
        let mut rest = loads;
        while !rest.is_empty() {
            let mut held = 0;
            let fits = |load: &&Load<'_>| {
                held += load.width();
                held <= GROUP
            };
            let (group, after) = rest.split_at(rest.iter().take_while(fits).count().max(1));
            groups.push(group);
            rest = after;
        }
        groups
            .into_par_iter()
            .flat_map_iter(|group| {
                let mut panel = Mat::zeros(group.iter().map(Load::width).sum(), self.untied.size());
                let mut first = 0;
                for load in group {
                    let rows = panel.subrows_mut(first, load.width());
                    self.untied.expand(&load.tied.tie, load.vectors.as_ref(), rows);
                    first += load.width();
                }
                work(panel.as_mut());
                let mut first = 0;
                group.iter().map(move |load| {
                    let rows_of_load = panel.subrows(first, load.width());
                    first += load.width();
                    self.untied.fold(&load.tied.tie, rows_of_load, rows)
                })
            })
            .collect()
    }

    fn scale_interior(&self, mut panel: MatMut<'_, f64>) {
        for (row, scale) in self.scale.iter().enumerate() {
            panel.rb_mut().col_mut(row).iter_mut().for_each(|value| *value *= scale);
        }
    }
}
