//! Lowest modes of many nodal diameters at once: block Lanczos on L̂⁻¹ M̂ L̂⁻ᴴ, residuals checked.
//!
//! Every search has its own Krylov basis; all of them, of several nodal diameters with fixed and with free contact DOF, go
//! through the one sparse factor together, so that it is read once for many vectors even with small blocks.

use faer::sparse::SparseColMat;
use faer::{Mat, MatRef, c64};
use rayon::iter::{
    IndexedParallelIterator, IntoParallelRefIterator, IntoParallelRefMutIterator, ParallelIterator,
};
use serde::{Deserialize, Serialize};

use super::sector_factor::{COLUMNS, Load, SectorFactor, join};
use super::tied_factor::TiedFactor;
use super::untied::{Tie, UntiedSector};
use rubmap_numerics::block_lanczos::{BlockLanczos, Ritz};
use rubmap_numerics::dense::Dense;
use rubmap_numerics::matrix_serde;
use rubmap_numerics::vector_block::VectorBlock;

/// Lowest modes of one nodal diameter at one stiffness.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Modes {
    /// Eigenvalues λ = ω² ascending, (rad/s)².
    pub(super) values: Vec<f64>,
    /// Residual ‖Kx − λMx‖/‖Kx‖ of each.
    pub(super) residuals: Vec<f64>,
    /// Mode shapes as tied vectors, mass-orthonormal.
    #[serde(with = "matrix_serde")]
    pub(super) vectors: Mat<c64>,
    /// Eigenvalues beyond `values` that are located well enough to be counted.
    pub(super) beyond: Vec<f64>,
}

impl Modes {
    /// Upper bounds of the known eigenvalues: above them by as much as they are known to.
    pub(super) fn ceilings(&self) -> Vec<f64> {
        let found = self.values.iter().map(|value| value * (1.0 + 1e-6));
        found.chain(self.beyond.iter().map(|value| value * (1.0 + 2.0 * LOCATED))).collect()
    }
}

/// Requirements on a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    /// Number of modes of each nodal diameter; all of them where there are fewer, or fewer with mass.
    pub(super) count: usize,
    /// Number of vectors advanced together; also the largest multiplicity of an eigenvalue that is found without luck.
    pub(super) block: usize,
    /// Whether contact DOF are free.
    pub(super) free: bool,
    /// Whether the vectors are needed: without them the iteration's own estimate stands for the residual.
    pub(super) vectors: bool,
    /// Accepted residual ‖Kx − λMx‖/‖Kx‖ of every returned pair; its square is the relative error of λ.
    pub(super) tolerance: f64,
    /// Number of eigenvalues to locate beyond the modes: room for a shift between them.
    pub(super) beyond: usize,
}

/// Reason why no modes were returned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ModeError {
    /// Search that did not reach the tolerance.
    NotConverged { harmonic: usize, residual: f64, block_steps: usize },
    /// Mode without mass: fewer have mass than the modes asked for.
    Massless { harmonic: usize },
    /// Dense decomposition inside the iteration that failed.
    DenseFailed { harmonic: usize },
    /// Search that the caller's `keep_going` stopped.
    Stopped,
}

/// Error of a Ritz pair at which its eigenvalue is located well enough to be counted.
pub(super) const LOCATED: f64 = 1e-4;
/// Number of searches whose modes are assembled together: enough to read the factor for many vectors, few enough for these to fit.
const ASSEMBLED: usize = 3;
/// Number of block steps before giving up; more where eight times the modes asked for need more.
const MAX_BLOCK_STEPS: usize = 200;
/// Size up to which spaces are solved densely: the Krylov space would be most of the whole.
const DENSE_SIZE: usize = 200;

/// Pencil of K and M of the untied sector, with the factor of K.
pub(super) struct Pencil<'a> {
    pub(super) untied: &'a UntiedSector,
    pub(super) stiffness: &'a SparseColMat<usize, f64>,
    pub(super) mass: &'a SparseColMat<usize, f64>,
    pub(super) factor: &'a SectorFactor<'a>,
}

/// Search under way.
struct Search<'a> {
    position: usize,
    tied: &'a TiedFactor,
    wanted: Wanted,
    /// Number of rows of the search's vectors.
    rows: usize,
    lanczos: BlockLanczos,
    ritz: Option<Ritz>,
    last_error: f64,
    /// Size of the basis at which the Ritz pairs are checked next.
    next_look: usize,
}

impl Pencil<'_> {
    /// Finds the lowest modes of every nodal diameter asked for, in that order. Deterministic: a nodal diameter gets the same bits whatever
    /// others are asked for; `keep_going(share)` is asked before every block step with a guess at the share of the work done.
    pub(super) fn lowest_modes(
        &self,
        asked: &[(&TiedFactor, Wanted)],
        keep_going: &dyn Fn(f64) -> bool,
    ) -> Result<Vec<Modes>, ModeError> {
        let mut found: Vec<Option<Modes>> = vec![None; asked.len()];
        let mut active = Vec::with_capacity(asked.len());
        let (mut guess, mut limit) = (1.0, 0);
        for (position, &(tied, mut wanted)) in asked.iter().enumerate() {
            let rows = self.untied.internal() + if wanted.free { self.untied.contact() } else { 0 };
            wanted.count = wanted.count.min(rows);
            if rows <= DENSE_SIZE.max(3 * wanted.count) {
                found[position] = Some(self.dense(&tied.tie, rows, wanted.count, wanted.tolerance)?);
                continue;
            }
            // Some five vectors a mode, seen over many sectors.
            guess = f64::max(guess, 5.0 * wanted.count as f64 / wanted.block as f64);
            limit = limit.max(MAX_BLOCK_STEPS.max(8 * wanted.count / wanted.block));
            active.push(Search {
                position,
                tied,
                wanted,
                rows,
                lanczos: BlockLanczos::new(rows, wanted.block, UntiedSector::is_real(&tied.tie)),
                ritz: None,
                last_error: f64::INFINITY,
                next_look: 2 * wanted.count,
            });
        }
        for step in 1..=limit {
            if active.is_empty() {
                break;
            }
            if !keep_going((step as f64 / guess).min(0.95)) {
                return Err(ModeError::Stopped);
            }
            let block = |search: &Search<'_>| search.lanczos.last_block().clone();
            let mut loads: Vec<Load<'_>> =
                active.iter().map(|search| Load { tied: search.tied, vectors: block(search) }).collect();
            self.factor.apply(self.mass, &mut loads);
            active.par_iter_mut().zip(loads).for_each(|(search, image)| search.advance(image.vectors));

            let mut waiting = Vec::new();
            let mut converged = Vec::new();
            for mut search in active {
                match search.ritz.take() {
                    None => waiting.push(search),
                    Some(ritz) if search.wanted.vectors => converged.push((search, ritz)),
                    Some(ritz) => {
                        let count = search.wanted.count;
                        found[search.position] = Some(Modes {
                            values: values_of(&ritz, count, search.tied.tie.harmonic)?,
                            residuals: ritz.errors[..count].to_vec(),
                            vectors: Mat::new(),
                            beyond: Vec::new(),
                        });
                    }
                }
            }
            // With free and with fixed contact DOF apart: what else of a nodal diameter converged now must not matter.
            let (free, fixed): (Vec<_>, Vec<_>) =
                converged.into_iter().partition(|(search, _)| search.wanted.free);
            for mut converged in [free, fixed] {
                while !converged.is_empty() {
                    let now: Vec<_> = converged.drain(..converged.len().min(ASSEMBLED)).collect();
                    let modes = self.modes(&now)?;
                    for ((mut search, _), (modes, worst)) in now.into_iter().zip(modes) {
                        let Wanted { count, tolerance, .. } = search.wanted;
                        if worst <= tolerance {
                            found[search.position] = Some(modes);
                        } else if search.lanczos.is_full() {
                            // The whole space, and round-off in the way: small enough to be solved at once.
                            let modes = self.dense(&search.tied.tie, search.rows, count, tolerance)?;
                            found[search.position] = Some(modes);
                        } else {
                            search.last_error = worst;
                            waiting.push(search);
                        }
                    }
                }
            }
            active = waiting;
            active.par_iter_mut().for_each(|search| search.lanczos.extend());
        }
        match active.first() {
            None => Ok(found.into_iter().flatten().collect()),
            Some(search) => Err(ModeError::NotConverged {
                harmonic: search.tied.tie.harmonic,
                residual: search.last_error,
                block_steps: limit,
            }),
        }
    }

    /// Modes from Ritz pairs, x = L̂⁻ᴴ y/√θ, and the distance of the worst from acceptance.
    fn modes(&self, converged: &[(Search<'_>, Ritz)]) -> Result<Vec<(Modes, f64)>, ModeError> {
        let assemble = |(search, ritz): &(Search<'_>, Ritz)| {
            let count = search.wanted.count;
            let lambda = values_of(ritz, count, search.tied.tie.harmonic)?;
            let scaled =
                Mat::from_fn(ritz.values.len(), count, |i, m| ritz.coefficients[(i, m)] * lambda[m].sqrt());
            Ok((lambda, search.lanczos.assemble(scaled.as_ref(), COLUMNS)))
        };
        let assembled: Vec<_> = converged.par_iter().map(assemble).collect::<Result<_, ModeError>>()?;
        let mut loads = Vec::new();
        let mut values = Vec::new();
        for ((search, _), (lambda, blocks)) in converged.iter().zip(assembled) {
            loads.extend(blocks.into_iter().map(|vectors| Load { tied: search.tied, vectors }));
            values.push(lambda);
        }
        self.factor.half_adjoint(&mut loads);
        let mut first = 0;
        let modes = |((search, ritz), values): (&(Search<'_>, Ritz), Vec<f64>)| {
            let Wanted { count, tolerance, .. } = search.wanted;
            let own = &loads[first..][..count.div_ceil(COLUMNS)];
            first += own.len();
            let vectors = join(own);
            let (residuals, worst) = self.residuals(&search.tied.tie, &values, vectors.as_ref(), tolerance);
            let beyond = (count..ritz.values.len())
                .take_while(|&m| ritz.values[m] > 0.0 && ritz.errors[m] <= LOCATED)
                .map(|m| 1.0 / ritz.values[m])
                .collect();
            (Modes { values, residuals, vectors, beyond }, worst)
        };
        Ok(converged.iter().zip(values).map(modes).collect())
    }

    /// Solves densely for `count` modes, or as many as have mass, on M x = θ K x like the iteration: the lowest modes are then accurate to
    /// round-off even where M is nearly singular.
    fn dense(&self, tie: &Tie, rows: usize, count: usize, tolerance: f64) -> Result<Modes, ModeError> {
        let harmonic = tie.harmonic;
        // Rows without motion have stiffness and no mass, which makes their eigenvalues the last.
        let [m, k] = [(self.mass, 0.0), (self.stiffness, 1.0)]
            .map(|(matrix, held)| self.untied.tied_dense(matrix, tie, rows, held));
        let pairs = Dense::generalised_eigenpairs(m.as_ref(), k.as_ref())
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

    /// Residuals ‖Kx − λMx‖/‖Kx‖ of every column, and the largest measure of acceptance, NaN if any is. The measure is the same ratio, but
    /// the part that the round-off of Kx alone may leave, 64 ε ‖|K||x|‖, counts as the tolerance and no more, for no eigensolver can do
    /// better on a stiffness of high contrast.
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
        let terms = self.untied.product(&magnitudes, &tie.magnitudes(), terms.as_ref());
        let floor = |j: usize| 64.0 * f64::EPSILON * terms.col(j).norm_l2() / tolerance;
        let eased: Vec<f64> =
            norms.iter().enumerate().map(|(j, (residual, norm))| residual / norm.max(floor(j))).collect();
        (plain, worst(&eased))
    }
}

/// Eigenvalues λ = 1/θ of the first `count` pairs.
fn values_of(ritz: &Ritz, count: usize, harmonic: usize) -> Result<Vec<f64>, ModeError> {
    let theta = &ritz.values[..count];
    if theta.iter().any(|&theta| theta.is_nan() || theta <= 0.0) {
        return Err(ModeError::Massless { harmonic });
    }
    Ok(theta.iter().map(|theta| 1.0 / theta).collect())
}

impl Search<'_> {
    /// Takes the image of the last block; leaves Ritz pairs where the wanted modes seem to have converged.
    fn advance(&mut self, image: VectorBlock) {
        let Wanted { count, block, tolerance, beyond, .. } = self.wanted;
        self.lanczos.absorb(image);
        let full = self.lanczos.is_full();
        let columns = self.lanczos.columns();
        if !full && columns < self.next_look {
            return;
        }
        // The dense projection costs more than a step once it is large.
        self.next_look = columns + block.max(columns / 12);
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
