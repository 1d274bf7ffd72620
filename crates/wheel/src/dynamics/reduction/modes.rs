//! Lowest modes of many nodal diameters at once: block Lanczos on L̂⁻¹ M̂ L̂⁻ᴴ, residuals checked.
//!
//! Every nodal diameter has its own Krylov basis; all of them go through the one sparse factor together, so that
//! solves run at level-3 speed even with small blocks.

use faer::sparse::SparseColMat;
use faer::{Mat, MatRef, c64};
use rayon::iter::{IntoParallelRefMutIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::sector_factor::{Load, SectorFactor, join, split};
use super::tied_factor::TiedFactor;
use super::untied::{Tie, UntiedSector};
use rubmap_numerics::block_lanczos::{BlockLanczos, Ritz};
use rubmap_numerics::hermitian::generalised_eigenpairs;
use rubmap_numerics::matrix_serde;

/// Lowest modes of one nodal diameter at one stiffness.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Modes {
    /// λ = ω² ascending, (rad/s)².
    pub(super) values: Vec<f64>,
    /// ‖Kx − λMx‖/‖Kx‖ of each.
    pub(super) residuals: Vec<f64>,
    /// Tied vectors, mass-orthonormal.
    #[serde(with = "matrix_serde")]
    pub(super) vectors: Mat<c64>,
    /// Eigenvalues beyond `values` that are located well enough to be counted.
    pub(super) beyond: Vec<f64>,
}

impl Modes {
    /// Values just above the known eigenvalues, by as much as they are known to.
    pub(super) fn ceilings(&self) -> Vec<f64> {
        let found = self.values.iter().map(|value| value * (1.0 + 1e-6));
        found.chain(self.beyond.iter().map(|value| value * (1.0 + 2.0 * LOCATED))).collect()
    }
}

/// What is asked of a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    /// Modes of each nodal diameter; all of them where there are fewer, or fewer with mass.
    pub(super) count: usize,
    /// Vectors advanced together; also the multiplicity of an eigenvalue found without luck.
    pub(super) block: usize,
    /// Whether contact DOF are free.
    pub(super) free: bool,
    /// Whether the vectors are wanted: without them the iteration's own estimate stands for the residual.
    pub(super) vectors: bool,
    /// Accepted ‖Kx − λMx‖/‖Kx‖ of every returned pair; its square is the relative error of λ.
    pub(super) tolerance: f64,
    /// Eigenvalues to locate beyond those: room for a shift between them.
    pub(super) beyond: usize,
}

/// Why no modes were returned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ModeError {
    /// The tolerance was not reached.
    NotConverged { harmonic: usize, residual: f64, block_steps: usize },
    /// A mode without mass: fewer have it than the modes asked for.
    Massless { harmonic: usize },
    /// A dense decomposition inside the iteration failed.
    DenseFailed { harmonic: usize },
    /// The caller's `keep_going` said no.
    Stopped,
}

/// An eigenvalue is located, for counting, once its Ritz pair has this error.
pub(super) const LOCATED: f64 = 1e-4;
/// Block steps before giving up, or enough for eight times the modes asked for.
const MAX_BLOCK_STEPS: usize = 200;
/// Spaces up to this size are solved densely: the Krylov space would be most of the whole.
const DENSE_SIZE: usize = 200;

/// K and M of the untied sector, with the factor of K.
pub(super) struct Pencil<'a> {
    pub(super) untied: &'a UntiedSector,
    pub(super) stiffness: &'a SparseColMat<usize, f64>,
    pub(super) mass: &'a SparseColMat<usize, f64>,
    pub(super) factor: &'a SectorFactor<'a>,
}

/// One nodal diameter's search.
struct Search<'a> {
    position: usize,
    tied: &'a TiedFactor,
    lanczos: BlockLanczos,
    ritz: Option<Ritz>,
    last_error: f64,
    /// Size of the basis at which its Ritz pairs are looked at next.
    next_look: usize,
}

impl Pencil<'_> {
    /// The lowest modes of every nodal diameter in `ties`. Deterministic; `keep_going(share)` is asked before every
    /// block step with a guess at the share of the work done.
    pub(super) fn lowest_modes(
        &self,
        ties: &[&TiedFactor],
        wanted: Wanted,
        keep_going: &dyn Fn(f64) -> bool,
    ) -> Result<Vec<Modes>, ModeError> {
        let rows = self.untied.internal() + if wanted.free { self.untied.contact() } else { 0 };
        let count = wanted.count.min(rows);
        if rows <= DENSE_SIZE.max(3 * count) {
            return ties.iter().map(|tied| self.dense(&tied.tie, rows, count, wanted.tolerance)).collect();
        }
        let search = |(position, tied)| Search {
            position,
            tied,
            lanczos: BlockLanczos::new(rows, wanted.block),
            ritz: None,
            last_error: f64::INFINITY,
            next_look: 2 * count,
        };
        let mut active: Vec<Search<'_>> = ties.iter().copied().enumerate().map(search).collect();
        let mut found: Vec<Option<Modes>> = vec![None; ties.len()];
        let limit = MAX_BLOCK_STEPS.max(8 * count / wanted.block);
        for step in 1..=limit {
            // Some five vectors a mode, seen over many sectors.
            if !keep_going((step as f64 * wanted.block as f64 / (5.0 * count as f64)).min(0.95)) {
                return Err(ModeError::Stopped);
            }
            let mut loads: Vec<Load<'_>> = active
                .iter()
                .map(|search| Load { tied: search.tied, vectors: search.lanczos.last_block().to_owned() })
                .collect();
            self.factor.apply(self.mass, &mut loads);
            let images: Vec<Mat<c64>> = loads.into_iter().map(|load| load.vectors).collect();
            let mut pairs: Vec<_> = active.iter_mut().zip(images).collect();
            pairs.par_iter_mut().for_each(|(search, image)| {
                search.advance(std::mem::replace(image, Mat::new()), count, wanted)
            });
            let mut waiting = Vec::new();
            for mut search in active {
                let Some(ritz) = search.ritz.take() else {
                    waiting.push(search);
                    continue;
                };
                if !wanted.vectors {
                    found[search.position] = Some(Modes {
                        values: values_of(&ritz, count, search.tied.tie.harmonic)?,
                        residuals: ritz.errors[..count].to_vec(),
                        vectors: Mat::new(),
                        beyond: Vec::new(),
                    });
                    continue;
                }
                let (modes, worst) = self.modes(&search, ritz, count, wanted.tolerance)?;
                if worst <= wanted.tolerance {
                    found[search.position] = Some(modes);
                } else if search.lanczos.is_full() {
                    // The whole space, and round-off in the way: small enough to be solved at once.
                    let modes = self.dense(&search.tied.tie, rows, count, wanted.tolerance)?;
                    found[search.position] = Some(modes);
                } else {
                    search.last_error = worst;
                    waiting.push(search);
                }
            }
            active = waiting;
            if active.is_empty() {
                return Ok(found.into_iter().flatten().collect());
            }
            active.par_iter_mut().for_each(|search| search.lanczos.extend());
        }
        let search = &active[0];
        Err(ModeError::NotConverged {
            harmonic: search.tied.tie.harmonic,
            residual: search.last_error,
            block_steps: limit,
        })
    }

    /// Modes from Ritz pairs, x = L̂⁻ᴴ y/√θ, and how far the worst is from being accepted.
    fn modes(
        &self,
        search: &Search<'_>,
        ritz: Ritz,
        count: usize,
        tolerance: f64,
    ) -> Result<(Modes, f64), ModeError> {
        let values = values_of(&ritz, count, search.tied.tie.harmonic)?;
        let whole = search.lanczos.assemble(ritz.coefficients.subcols(0, count));
        let mut loads = split(search.tied, whole.as_ref());
        self.factor.half_adjoint(&mut loads);
        let mut vectors = join(&loads);
        for (mut x, lambda) in vectors.col_iter_mut().zip(&values) {
            x *= faer::Scale(c64::new(lambda.sqrt(), 0.0));
        }
        let (residuals, worst) = self.residuals(&search.tied.tie, &values, vectors.as_ref(), tolerance);
        let beyond = (count..ritz.values.len())
            .take_while(|&m| ritz.values[m] > 0.0 && ritz.errors[m] <= LOCATED)
            .map(|m| 1.0 / ritz.values[m])
            .collect();
        Ok((Modes { values, residuals, vectors, beyond }, worst))
    }

    /// The dense solution, `count` modes or as many as have mass, on M x = θ K x like the iteration: the lowest modes are
    /// then accurate to round-off even where M is nearly singular.
    fn dense(&self, tie: &Tie, rows: usize, count: usize, tolerance: f64) -> Result<Modes, ModeError> {
        let harmonic = tie.harmonic;
        let [m, k] = [self.mass, self.stiffness].map(|matrix| self.untied.tied_dense(matrix, tie, rows));
        let pairs = generalised_eigenpairs(m.as_ref(), k.as_ref())
            .map_err(|_| ModeError::DenseFailed { harmonic })?;
        let theta = |m: usize| pairs.values[rows - 1 - m];
        // Below, θ is round-off: directions without mass.
        let massless = if rows == 0 { 0.0 } else { rows as f64 * f64::EPSILON * theta(0) };
        let carrying = (0..rows).take_while(|&m| theta(m) > massless).count();
        if carrying < count.min(1) {
            return Err(ModeError::Massless { harmonic });
        }
        let count = count.min(carrying);
        let values: Vec<f64> = (0..count).map(|m| 1.0 / theta(m)).collect();
        let vectors =
            Mat::from_fn(rows, count, |i, m| pairs.vectors[(i, rows - 1 - m)] * (1.0 / theta(m).sqrt()));
        let (residuals, residual) = self.residuals(tie, &values, vectors.as_ref(), tolerance);
        if residual > tolerance {
            return Err(ModeError::NotConverged { harmonic, residual, block_steps: 0 });
        }
        let beyond = (count..carrying).map(|m| 1.0 / theta(m)).collect();
        Ok(Modes { values, residuals, vectors, beyond })
    }

    /// ‖Kx − λMx‖/‖Kx‖ of every column, and the largest measure of acceptance, NaN if any is: the same ratio, but what
    /// the round-off of Kx alone may leave, 64 ε ‖|K||x|‖, counts as the tolerance and no more, for no eigensolver can
    /// do better on a stiffness of high contrast.
    fn residuals(
        &self,
        tie: &Tie,
        values: &[f64],
        vectors: MatRef<'_, c64>,
        tolerance: f64,
    ) -> (Vec<f64>, f64) {
        let kx = self.untied.product(self.stiffness, tie, vectors);
        let mx = self.untied.product(self.mass, tie, vectors);
        let norms: Vec<(f64, f64)> = (0..values.len())
            .map(|j| {
                let terms = kx.col(j).iter().zip(mx.col(j).iter());
                let residual = terms.map(|(k, m)| (k - m * values[j]).norm_sqr()).sum::<f64>().sqrt();
                (residual, kx.col(j).norm_l2())
            })
            .collect();
        let worst =
            |ratios: &[f64]| ratios.iter().fold(0.0f64, |worst, &r| if r <= worst { worst } else { r });
        let plain: Vec<f64> = norms.iter().map(|(residual, norm)| residual / norm).collect();
        let accepted = worst(&plain);
        if accepted <= tolerance {
            return (plain, accepted);
        }
        let mut magnitudes = self.stiffness.clone();
        magnitudes.val_mut().iter_mut().for_each(|value| *value = value.abs());
        let terms =
            Mat::from_fn(vectors.nrows(), vectors.ncols(), |i, j| c64::new(vectors[(i, j)].norm(), 0.0));
        // Tied without its phases, which have magnitude one.
        let terms = self.untied.product(&magnitudes, &self.untied.tie(0), terms.as_ref());
        let floor = |j: usize| 64.0 * f64::EPSILON * terms.col(j).norm_l2() / tolerance;
        let eased: Vec<f64> =
            norms.iter().enumerate().map(|(j, (residual, norm))| residual / norm.max(floor(j))).collect();
        (plain, worst(&eased))
    }
}

/// λ = 1/θ of the first `count` pairs.
fn values_of(ritz: &Ritz, count: usize, harmonic: usize) -> Result<Vec<f64>, ModeError> {
    let theta = &ritz.values[..count];
    if theta.iter().any(|&theta| theta.is_nan() || theta <= 0.0) {
        return Err(ModeError::Massless { harmonic });
    }
    Ok(theta.iter().map(|theta| 1.0 / theta).collect())
}

impl Search<'_> {
    /// Takes the image of the last block; leaves Ritz pairs where the wanted ones seem to have converged.
    fn advance(&mut self, image: Mat<c64>, count: usize, wanted: Wanted) {
        let Wanted { tolerance, beyond, .. } = wanted;
        self.lanczos.absorb(image);
        let full = self.lanczos.is_full();
        let columns = self.lanczos.columns();
        if !full && columns < self.next_look {
            return;
        }
        // The dense projection costs more than a step once it is large.
        self.next_look = columns + (2 * wanted.block).max(columns / 12);
        // A decomposition that fails once may succeed with the next block.
        let Ok(ritz) = self.lanczos.ritz(columns) else { return };
        let worst = ritz.errors[..count].iter().fold(0.0f64, |worst, &e| if e <= worst { worst } else { e });
        self.last_error = worst;
        let located = ritz.errors.iter().skip(count).take_while(|&&error| error <= LOCATED).count();
        if full || (worst <= 0.1 * tolerance && located >= beyond) {
            self.ritz = Some(ritz);
        }
    }
}
