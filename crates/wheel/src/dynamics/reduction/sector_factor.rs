//! Real factor of the untied sector, and the small dense factor that each nodal diameter adds to it.
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

use faer::sparse::SparseColMat;
use faer::{Mat, MatMut, MatRef, c64};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::tied_factor::{NotPositiveDefinite, TiedFactor, cholesky, tied_schur};
use super::untied::UntiedSector;
use rubmap_numerics::multifrontal::PartialFactor;
use rubmap_numerics::panel::Panel;
use rubmap_numerics::sparse_product::row_product;
use rubmap_numerics::vector_block::VectorBlock;

/// Factor of the untied sector's interior at one stiffness.
pub(super) struct SectorFactor<'a> {
    untied: &'a UntiedSector,
    factor: PartialFactor<'a>,
    /// Scale D^−½.
    scale: Vec<f64>,
}

/// Vectors of one nodal diameter on their way through the sparse factor.
pub(super) struct Load<'a> {
    pub(super) tied: &'a TiedFactor,
    /// Tied vectors, over (interior, face) or (interior, face, contact).
    pub(super) vectors: VectorBlock,
}

impl Load<'_> {
    /// Number of real vectors that stand for the load.
    fn width(&self) -> usize {
        self.vectors.parts().width()
    }
}

/// Number of tied vectors a load should have: a few, so that loads spread over the threads.
pub(super) const COLUMNS: usize = 4;

/// Splits `vectors` into loads of a few columns each.
pub(super) fn split<'t>(tied: &'t TiedFactor, vectors: MatRef<'_, c64>) -> Vec<Load<'t>> {
    let count = vectors.ncols();
    let real = UntiedSector::is_real(&tied.tie);
    let load = |first: usize| {
        let columns = vectors.subcols(first, COLUMNS.min(count - first));
        Load { tied, vectors: VectorBlock::of(columns, real) }
    };
    (0..count).step_by(COLUMNS).map(load).collect()
}

/// Joins the vectors of all loads side by side.
pub(super) fn join(loads: &[Load<'_>]) -> Mat<c64> {
    let rows = loads.first().map_or(0, |load| load.vectors.size());
    let mut vectors = Mat::zeros(rows, loads.iter().map(|load| load.vectors.count()).sum());
    let mut first = 0;
    for load in loads {
        let count = load.vectors.count();
        load.vectors.copy_to(0, vectors.subcols_mut(first, count));
        first += count;
    }
    vectors
}

/// Fraction of its diagonal entry below which a pivot is round-off: the matrix is singular, as far as double precision can tell.
const SINGULAR: f64 = 1e-13;
/// Largest number of real vectors solved together: the factor is read once for all of them.
const GROUP: usize = 48;

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

    /// Factor of nodal diameter `harmonic`. Fails where the stiffness with fixed contact DOF is not positive definite.
    pub(super) fn tie(
        &self,
        stiffness: &SparseColMat<usize, f64>,
        harmonic: usize,
    ) -> Result<TiedFactor, NotPositiveDefinite> {
        TiedFactor::new(self.untied, self.factor.schur(), stiffness, self.untied.tie(harmonic))
    }

    /// Solves x ← L̂⁻ᴴ y for every load.
    pub(super) fn half_adjoint(&self, loads: &mut [Load<'_>]) {
        self.on_boundary(loads, TiedFactor::solve_adjoint);
        self.solve_interior(loads, |panel| {
            self.scale_interior(panel);
            self.factor.backward(panel);
        });
    }

    /// Applies y ← L̂⁻¹ M̂ L̂⁻ᴴ y to every load, with `mass` untied.
    pub(super) fn apply(&self, mass: &SparseColMat<usize, f64>, loads: &mut [Load<'_>]) {
        self.on_boundary(loads, TiedFactor::solve_adjoint);
        let images = self.through(loads, usize::MAX, |panel| {
            self.scale_interior(panel);
            self.factor.backward(panel);
            *panel = row_product(mass, panel);
            self.factor.forward(panel);
            self.scale_interior(panel);
        });
        loads.iter_mut().zip(images).for_each(|(load, image)| load.vectors = image);
        self.on_boundary(loads, TiedFactor::solve);
    }

    /// Solves x ← K̂⁻¹ f for every load.
    pub(super) fn solve(&self, loads: &mut [Load<'_>]) {
        self.half(loads);
        self.half_adjoint(loads);
    }

    /// Solves y ← L̂⁻¹ f for every load: ‖y‖² = fᴴ K̂⁻¹ f.
    pub(super) fn half(&self, loads: &mut [Load<'_>]) {
        let interior = self.untied.interior();
        // Untied, what acts on the low face would act on the high one again.
        let take = |load: &mut Load<'_>| {
            let mut boundary = Mat::zeros(load.vectors.size() - interior, load.vectors.count());
            load.vectors.copy_to(interior, boundary.as_mut());
            load.vectors.copy_from(interior, Mat::zeros(boundary.nrows(), boundary.ncols()).as_ref());
            boundary
        };
        let boundary: Vec<Mat<c64>> = loads.iter_mut().map(take).collect();
        let images = self.through(loads, usize::MAX, |panel| {
            self.factor.forward(panel);
            self.scale_interior(panel);
        });
        for ((load, image), mut boundary) in loads.iter_mut().zip(images).zip(boundary) {
            load.vectors = image;
            let mut reached = Mat::zeros(boundary.nrows(), boundary.ncols());
            load.vectors.copy_to(interior, reached.as_mut());
            boundary += reached;
            load.vectors.copy_from(interior, boundary.as_ref());
        }
        self.on_boundary(loads, TiedFactor::solve);
    }

    /// Whether the matrix of every nodal diameter is positive definite, contact DOF included, seen without factoring each: with S(i) = A +
    /// B e^{jiα} + Bᵀ e^{−jiα}, ‖S(i) − S(0)‖ ≤ 4 ‖B‖, and a mass couples face to face only weakly. `false` proves nothing.
    pub(super) fn surely_definite(&self, matrix: &SparseColMat<usize, f64>) -> bool {
        // Nodal diameters differ at the axis by more than a phase.
        if self.untied.has_axis() {
            return false;
        }
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
        let mut shifted = tied_schur(self.untied, self.factor.schur(), &[(1.0, matrix)], &tie);
        shifted.diagonal_mut().column_vector_mut().iter_mut().for_each(|value| *value -= bound);
        cholesky(shifted.as_mut(), &tie).is_ok()
    }

    /// Static modes Ψ_s = −K̂_ii⁻¹ K̂_ib of one nodal diameter, `n_i × n_b`.
    pub(super) fn static_modes(&self, tied: &TiedFactor) -> Mat<c64> {
        let mut loads = split(tied, tied.at_unit_contact(self.untied.interior()).as_ref());
        self.solve_interior(&mut loads, |panel| self.factor.backward(panel));
        join(&loads).subrows(0, self.untied.internal()).to_owned()
    }

    /// Solves with the dense factor of each nodal diameter, which is read once for all its loads; their last bits depend on which loads these are.
    fn on_boundary(&self, loads: &mut [Load<'_>], solve: impl Fn(&TiedFactor, MatMut<'_, c64>) + Sync) {
        let interior = self.untied.interior();
        let mut loads: Vec<&mut Load<'_>> = loads.iter_mut().collect();
        loads.sort_by_key(|load| load.tied.tie.harmonic);
        let same: Vec<_> = loads.chunk_by_mut(|a, b| std::ptr::eq(a.tied, b.tied)).collect();
        same.into_par_iter().for_each(|loads| {
            // Contact rows that are missing stay zero in a solve with L_S⁻ᴴ, and what L_S⁻¹ makes of them reaches no others.
            let rows = loads.iter().map(|load| load.vectors.size() - interior).max().unwrap_or(0);
            let mut x = Mat::zeros(rows, loads.iter().map(|load| load.vectors.count()).sum());
            let columns = |first: &mut usize, load: &Load<'_>| {
                let at = *first;
                *first += load.vectors.count();
                (at, load.vectors.size() - interior, load.vectors.count())
            };
            let mut first = 0;
            for load in &*loads {
                let (at, rows, count) = columns(&mut first, load);
                load.vectors.copy_to(interior, x.submatrix_mut(0, at, rows, count));
            }
            solve(loads[0].tied, x.as_mut());
            let mut first = 0;
            for load in loads {
                let (at, rows, count) = columns(&mut first, load);
                load.vectors.copy_from(interior, x.submatrix(0, at, rows, count));
            }
        });
    }

    /// Sends the loads through `work`, which leaves their boundary rows alone.
    fn solve_interior(&self, loads: &mut [Load<'_>], work: impl Fn(&mut Panel) + Sync) {
        let interior = self.untied.interior();
        let solved = self.through(loads, interior, work);
        for (load, solved) in loads.iter_mut().zip(solved) {
            for row in 0..interior {
                load.vectors.parts_mut().row_mut(row).copy_from_slice(solved.parts().row(row));
            }
        }
    }

    /// Sends the loads, untied, in groups through `work`, and ties the result: at most its first `rows` rows, per load. Groups run in
    /// parallel; the grouping changes no bit.
    fn through(&self, loads: &[Load<'_>], rows: usize, work: impl Fn(&mut Panel) + Sync) -> Vec<VectorBlock> {
        let width: usize = loads.iter().map(Load::width).sum();
        let count = width.div_ceil(GROUP).max(1).next_multiple_of(rayon::current_num_threads());
        let room = width.div_ceil(count).next_multiple_of(Panel::LANES);
        let mut groups: Vec<&[Load<'_>]> = Vec::new();
        let mut rest = loads;
        while !rest.is_empty() {
            let mut held = 0;
            let fits = |load: &&Load<'_>| {
                held += load.width();
                held <= room
            };
            let (group, after) = rest.split_at(rest.iter().take_while(fits).count().max(1));
            groups.push(group);
            rest = after;
        }
        groups
            .into_par_iter()
            .flat_map_iter(|group| {
                let width = group.iter().map(Load::width).sum();
                let mut panel = Panel::zeros(width, self.untied.size());
                let mut first = 0;
                for load in group {
                    self.untied.expand(&load.tied.tie, &load.vectors, &mut panel, first);
                    first += load.width();
                }
                work(&mut panel);
                let mut first = 0;
                group.iter().map(move |load| {
                    let from = first;
                    first += load.width();
                    let rows = rows.min(load.vectors.size());
                    self.untied.fold(&load.tied.tie, &panel, from, load.vectors.count(), rows)
                })
            })
            .collect()
    }

    fn scale_interior(&self, panel: &mut Panel) {
        for (row, scale) in self.scale.iter().enumerate() {
            panel.row_mut(row).iter_mut().for_each(|value| *value *= scale);
        }
    }
}
