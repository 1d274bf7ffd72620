//! Everything that needs the sector's factor at one speed: modes of every nodal diameter, their count, and the full
//! sector's own lowest frequencies.

use faer::Mat;
use faer::c64;
use faer::sparse::SparseColMat;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::condensed::SectorFactor;
use super::count::{ModeCount, count_modes};
use super::modes::{ModeError, Modes, Pencil, Wanted};
use super::tied::TiedFactor;
use super::untied::UntiedSector;
use super::{Checkpoints, ReductionError, Watch};
use crate::dynamics::centrifugal::stiffness_terms;
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use crate::numerics::matrix_serde;

/// Vectors advanced together in a search; doubled when modes turn out to be missing.
const BLOCK: usize = 4;
/// No sector has eigenvalues of a multiplicity beyond this.
const LARGEST_BLOCK: usize = 32;
/// Residual of the modes of the basis: 1e-8 in x is 1e-16 in λ; 1e-9 leaves a margin.
const MODE_TOLERANCE: f64 = 1e-9;
/// Residual behind the full sector's frequencies: right to some nine digits.
const FREQUENCY_TOLERANCE: f64 = 3e-5;
/// Nodal diameters searched together: enough to share solves, few enough for their Krylov bases to fit.
pub(super) const TOGETHER: usize = 6;
/// Frequencies of the full sector that the reduced ones are compared with.
pub(super) const COMPARED: usize = 10;

/// What one nodal diameter's search found at one speed.
#[derive(Serialize, Deserialize)]
pub(super) struct HarmonicPart {
    pub(super) modes: Modes,
    /// Ψ_s(0), at rest only.
    #[serde(with = "matrix_serde::list")]
    pub(super) static_modes: Vec<Mat<c64>>,
}

/// Circular frequencies of the full sector per nodal diameter, ascending; none where its stiffness is indefinite.
pub(super) type FullFrequencies = Vec<Option<Vec<f64>>>;

/// What is known at one given speed.
pub(super) struct SpeedPart {
    pub(super) harmonics: Vec<HarmonicPart>,
    /// None where the whole space was found.
    pub(super) counts: Vec<Option<ModeCount>>,
    pub(super) full: FullFrequencies,
}

/// The sector on its way through a reduction.
pub(super) struct Work<'a> {
    pub(super) sector: &'a SectorModel,
    pub(super) untied: &'a UntiedSector,
    /// Untied M.
    pub(super) mass: &'a SparseColMat<usize, f64>,
    pub(super) modes_per_speed: usize,
    pub(super) harmonics: usize,
    pub(super) checkpoints: &'a dyn Checkpoints,
}

impl Work<'_> {
    /// Modes, counts and full frequencies at the given speed number `index`.
    pub(super) fn at_given_speed(&self, index: usize, watch: Watch<'_>) -> Result<SpeedPart, ReductionError> {
        let harmonic_name = |harmonic: usize| format!("speed-{index}-harmonic-{harmonic}");
        let mut harmonics: Vec<Option<HarmonicPart>> =
            (0..self.harmonics).map(|harmonic| self.load(&harmonic_name(harmonic))).collect();
        let summary_name = format!("speed-{index}");
        let summary: Option<(Vec<Option<ModeCount>>, FullFrequencies)> = self.load(&summary_name);
        if let Some((counts, full)) = &summary
            && harmonics.iter().all(Option::is_some)
        {
            let harmonics = harmonics.into_iter().flatten().collect();
            return Ok(SpeedPart { harmonics, counts: counts.clone(), full: full.clone() });
        }

        let speed_rad_s = self.sector.speeds_rad_s[index];
        let phase = |share: f64, what: &str| go_on(watch, share, &format!("{what} at {speed_rad_s} rad/s"));
        phase(0.0, "factorisation")?;
        let stiffness = self.untied.assemble(&[(1.0, &self.sector.stiffness[index])]);
        let indefinite = |nodal_diameter: usize| ModelError::StiffnessNotPositiveDefinite {
            nodal_diameter,
            speed_rad_s,
            hint: if index == 0 {
                "is the hub constrained, and does every part of the sector hang on it?"
            } else {
                "the sector would buckle under its own centrifugal load, or this matrix is not K(Ω)"
            },
        };
        let factor = SectorFactor::new(self.untied, &stiffness).map_err(|_| indefinite(0))?;
        let tied = self.tie(&factor, &stiffness).map_err(indefinite)?;
        let pencil = Pencil { untied: self.untied, stiffness: &stiffness, mass: self.mass, factor: &factor };

        let missing: Vec<usize> = (0..self.harmonics).filter(|&h| harmonics[h].is_none()).collect();
        for (group, members) in missing.chunks(TOGETHER).enumerate() {
            let share =
                |done: f64| 0.1 + 0.5 * (group as f64 + done) / missing.len().div_ceil(TOGETHER) as f64;
            let names = list(members);
            let what = format!("fixed-interface modes, nodal diameter{names}");
            let modes =
                self.search(&pencil, &tied, members, BLOCK, &|done| phase(share(done), &what).is_ok());
            for (&harmonic, modes) in members.iter().zip(modes.map_err(|e| mode_error(e, speed_rad_s))?) {
                let static_modes =
                    if index == 0 { vec![factor.static_modes(&tied[harmonic])] } else { Vec::new() };
                let part = HarmonicPart { modes, static_modes };
                self.save(&harmonic_name(harmonic), &part);
                harmonics[harmonic] = Some(part);
            }
        }
        let mut harmonics: Vec<HarmonicPart> = harmonics.into_iter().flatten().collect();

        phase(0.6, "full sector")?;
        let full =
            self.full_frequencies(&pencil, &tied, &|done| phase(0.6 + 0.2 * done, "full sector").is_ok());
        let full = full.map_err(|error| mode_error(error, speed_rad_s))?;

        phase(0.8, "counting modes")?;
        let mut block = BLOCK;
        let counts = loop {
            let counts = self.count(&stiffness, &harmonics);
            let missed: Vec<usize> = (0..self.harmonics)
                .filter(|&h| counts[h].is_some_and(|count| count.is_none_or(|c| c.found < c.below)))
                .collect();
            if missed.is_empty() {
                break counts.into_iter().map(Option::flatten).collect::<Vec<_>>();
            }
            block *= 2;
            let what = format!("modes missed, searching again, nodal diameter{}", list(&missed));
            if block > LARGEST_BLOCK {
                let nodal_diameter = missed[0];
                return Err(ModelError::ModesMissed { nodal_diameter, speed_rad_s }.into());
            }
            let again = self.search(&pencil, &tied, &missed, block, &|_| phase(0.8, &what).is_ok());
            for (&harmonic, modes) in missed.iter().zip(again.map_err(|e| mode_error(e, speed_rad_s))?) {
                harmonics[harmonic].modes = modes;
                self.save(&harmonic_name(harmonic), &harmonics[harmonic]);
            }
        };
        self.save(&summary_name, &(&counts, &full));
        Ok(SpeedPart { harmonics, counts, full })
    }

    /// The full sector's frequencies at a speed between the given ones, with K(Ω) through them.
    pub(super) fn at_speed_between(
        &self,
        name: &str,
        speed_rad_s: f64,
        watch: Watch<'_>,
    ) -> Result<FullFrequencies, ReductionError> {
        if let Some(full) = self.load(name) {
            return Ok(full);
        }
        let phase = |share: f64| go_on(watch, share, &format!("full sector at {speed_rad_s} rad/s"));
        phase(0.0)?;
        let stiffness = self.untied.assemble(&stiffness_terms(self.sector, speed_rad_s));
        let Ok(factor) = SectorFactor::new(self.untied, &stiffness) else {
            return Ok(vec![None; self.harmonics]);
        };
        let Ok(tied) = self.tie(&factor, &stiffness) else {
            return Ok(vec![None; self.harmonics]);
        };
        let pencil = Pencil { untied: self.untied, stiffness: &stiffness, mass: self.mass, factor: &factor };
        let full = self
            .full_frequencies(&pencil, &tied, &|done| phase(done).is_ok())
            .map_err(|error| mode_error(error, speed_rad_s))?;
        self.save(name, &full);
        Ok(full)
    }

    /// The dense factor of every nodal diameter, or the first that has none.
    fn tie(
        &self,
        factor: &SectorFactor<'_>,
        stiffness: &SparseColMat<usize, f64>,
    ) -> Result<Vec<TiedFactor>, usize> {
        use rayon::iter::{IntoParallelIterator, ParallelIterator};
        let tied: Vec<_> = (0..self.harmonics)
            .into_par_iter()
            .map(|harmonic| factor.tie(stiffness, harmonic).map_err(|_| harmonic))
            .collect();
        tied.into_iter().collect()
    }

    fn search(
        &self,
        pencil: &Pencil<'_>,
        tied: &[TiedFactor],
        members: &[usize],
        block: usize,
        keep_going: &dyn Fn(f64) -> bool,
    ) -> Result<Vec<Modes>, ModeError> {
        let ties: Vec<&TiedFactor> = members.iter().map(|&harmonic| &tied[harmonic]).collect();
        pencil.lowest_modes(
            &ties,
            Wanted { count: self.modes_per_speed, block, free: false, tolerance: MODE_TOLERANCE, beyond: 2 },
            keep_going,
        )
    }

    fn full_frequencies(
        &self,
        pencil: &Pencil<'_>,
        tied: &[TiedFactor],
        keep_going: &dyn Fn(f64) -> bool,
    ) -> Result<FullFrequencies, ModeError> {
        let mut full = vec![None; self.harmonics];
        let free: Vec<usize> = (0..self.harmonics).filter(|&harmonic| tied[harmonic].free).collect();
        for (group, members) in free.chunks(TOGETHER).enumerate() {
            let ties: Vec<&TiedFactor> = members.iter().map(|&harmonic| &tied[harmonic]).collect();
            let wanted = Wanted {
                count: COMPARED,
                block: BLOCK,
                free: true,
                tolerance: FREQUENCY_TOLERANCE,
                beyond: 0,
            };
            let share = |done: f64| (group as f64 + done) / free.len().div_ceil(TOGETHER) as f64;
            let found = pencil.lowest_modes(&ties, wanted, &|done| keep_going(share(done)))?;
            for (&harmonic, modes) in members.iter().zip(found) {
                full[harmonic] = Some(modes.values.iter().map(|lambda| lambda.sqrt()).collect());
            }
        }
        Ok(full)
    }

    /// Per nodal diameter: nothing to count, or the count, or that it could not be counted.
    fn count(
        &self,
        stiffness: &SparseColMat<usize, f64>,
        harmonics: &[HarmonicPart],
    ) -> Vec<Option<Option<ModeCount>>> {
        let open: Vec<usize> = (0..self.harmonics)
            .filter(|&h| harmonics[h].modes.values.len() < self.untied.internal())
            .collect();
        let found: Vec<_> = open.iter().map(|&h| (self.untied.tie(h), &harmonics[h].modes)).collect();
        let mut counts = vec![None; self.harmonics];
        match count_modes(self.untied, stiffness, self.mass, &found) {
            Ok(all) => open.iter().zip(all).for_each(|(&h, count)| counts[h] = Some(Some(count))),
            Err(uncountable) => counts[uncountable.harmonic] = Some(None),
        }
        counts
    }

    fn load<T: DeserializeOwned>(&self, part: &str) -> Option<T> {
        postcard::from_bytes(&self.checkpoints.load(part)?).ok()
    }

    fn save<T: Serialize>(&self, part: &str, value: &T) {
        if let Ok(bytes) = postcard::to_stdvec(value) {
            self.checkpoints.save(part, bytes);
        }
    }
}

fn go_on(watch: Watch<'_>, share: f64, phase: &str) -> Result<(), ReductionError> {
    if watch(share, phase) { Ok(()) } else { Err(ReductionError::Cancelled) }
}

/// ` 3`, or `s 0 to 5`.
fn list(members: &[usize]) -> String {
    match members {
        [only] => format!(" {only}"),
        [first, .., last] if last - first + 1 == members.len() => format!("s {first} to {last}"),
        _ => format!("s {}", members.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
    }
}

fn mode_error(error: ModeError, speed_rad_s: f64) -> ReductionError {
    match error {
        ModeError::Stopped => ReductionError::Cancelled,
        ModeError::NotConverged { harmonic, residual, block_steps } => ModelError::ModesNotConverged {
            nodal_diameter: harmonic,
            speed_rad_s,
            residual,
            iterations: block_steps,
        }
        .into(),
        ModeError::Massless { harmonic } => {
            ModelError::MassNotPositiveDefinite { nodal_diameter: harmonic }.into()
        }
        ModeError::DenseFailed { harmonic } => {
            ModelError::DecompositionFailed { nodal_diameter: harmonic, speed_rad_s }.into()
        }
    }
}
