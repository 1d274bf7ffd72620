//! Everything that needs the sector's factor at one speed: modes of every nodal diameter, their count, and the full
//! sector's own lowest frequencies.

use faer::Mat;
use faer::c64;
use faer::sparse::SparseColMat;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::checkpoints::Checkpoints;
use super::count::{Completeness, Verdict, count_modes};
use super::modes::{ModeError, Modes, Pencil, Wanted};
use super::options::{ReductionError, Watch};
use super::sector_factor::SectorFactor;
use super::tied_factor::TiedFactor;
use super::untied::UntiedSector;
use crate::dynamics::centrifugal::stiffness_terms;
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use rubmap_numerics::matrix_serde;

/// Vectors advanced together in a search; doubled when modes turn out to be missing.
const BLOCK: usize = 4;
/// Where a search ends: eigenvalues of a higher multiplicity are refused or left unproven.
const LARGEST_BLOCK: usize = 64;
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
    /// Ψ_s(0), from the search at rest only.
    #[serde(with = "matrix_serde::list")]
    static_modes: Vec<Mat<c64>>,
}

impl HarmonicPart {
    /// Ψ_s(0), of a part found at rest.
    pub(super) fn static_modes(&self) -> &Mat<c64> {
        &self.static_modes[0]
    }
}

/// Circular frequencies of the full sector per nodal diameter, ascending; none where its stiffness is indefinite.
pub(super) type FullFrequencies = Vec<Option<Vec<f64>>>;

/// What is known at one given speed.
pub(super) struct SpeedPart {
    pub(super) harmonics: Vec<HarmonicPart>,
    pub(super) completeness: Vec<Completeness>,
    pub(super) full: FullFrequencies,
    /// Block that found them.
    pub(super) full_block: usize,
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
        let summary: Option<(Vec<Completeness>, FullFrequencies, usize)> = self.load(&summary_name);
        if let Some((completeness, full, full_block)) = summary
            && harmonics.iter().all(Option::is_some)
        {
            let harmonics = harmonics.into_iter().flatten().collect();
            return Ok(SpeedPart { harmonics, completeness, full, full_block });
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
        let tied =
            self.tie(&factor, &stiffness).into_iter().collect::<Result<Vec<_>, _>>().map_err(indefinite)?;
        let pencil = Pencil { untied: self.untied, stiffness: &stiffness, mass: self.mass, factor: &factor };

        let all: Vec<usize> = (0..self.harmonics).collect();
        let groups = all.len().div_ceil(TOGETHER) as f64;
        for (group, members) in all.chunks(TOGETHER).enumerate() {
            // All or none of a group: who is solved together decides on the last bits.
            if members.iter().all(|&h| harmonics[h].is_some()) {
                continue;
            }
            let what = format!("fixed-interface modes, nodal diameter{}", list(members));
            let share = |done: f64| 0.1 + 0.5 * (group as f64 + done) / groups;
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

        phase(0.6, "counting modes")?;
        let mut completeness = vec![None; self.harmonics];
        let mut block = BLOCK;
        loop {
            let open: Vec<usize> = all.iter().copied().filter(|&h| completeness[h].is_none()).collect();
            let doubtful = self.prove(&stiffness, &harmonics, &open, block, &mut completeness);
            let doubtful =
                doubtful.map_err(|h| ModelError::ModesMissed { nodal_diameter: h, speed_rad_s })?;
            if doubtful.is_empty() {
                break;
            }
            block *= 2;
            let what = format!("searching again for modes, nodal diameter{}", list(&doubtful));
            let again = self.search(&pencil, &tied, &doubtful, block, &|_| phase(0.6, &what).is_ok());
            for (&harmonic, modes) in doubtful.iter().zip(again.map_err(|e| mode_error(e, speed_rad_s))?) {
                harmonics[harmonic].modes = modes;
                self.save(&harmonic_name(harmonic), &harmonics[harmonic]);
            }
        }
        let completeness: Vec<Completeness> = completeness.into_iter().flatten().collect();

        phase(0.8, "full sector")?;
        // Fixing the contact DOF raises every frequency: a ceiling for those of the full sector.
        let ceilings: Vec<Vec<f64>> = harmonics.iter().map(|part| part.modes.ceilings()).collect();
        let free: Vec<&TiedFactor> = tied.iter().filter(|tied| tied.free.is_ok()).collect();
        let going = |done: f64| phase(0.8 + 0.2 * done, "full sector").is_ok();
        let (full, full_block) = self
            .full_frequencies(&pencil, &free, Some(&ceilings), BLOCK, &going)
            .map_err(|error| mode_error(error, speed_rad_s))?;
        self.save(&summary_name, &(&completeness, &full, full_block));
        Ok(SpeedPart { harmonics, completeness, full, full_block })
    }

    /// Counts the modes of the nodal diameters `open`, found with blocks of `block`; returns those to search again, or
    /// one whose modes are missing for good.
    fn prove(
        &self,
        stiffness: &SparseColMat<usize, f64>,
        harmonics: &[HarmonicPart],
        open: &[usize],
        block: usize,
        completeness: &mut [Option<Completeness>],
    ) -> Result<Vec<usize>, usize> {
        // Fewer than asked for: no others have mass.
        let whole = |h: usize| {
            let found = harmonics[h].modes.values.len();
            found == self.untied.internal() || found < self.modes_per_speed
        };
        open.iter().filter(|&&h| whole(h)).for_each(|&h| completeness[h] = Some(Completeness::Whole));
        let counted: Vec<usize> = open.iter().copied().filter(|&h| !whole(h)).collect();
        let found: Vec<_> = counted.iter().map(|&h| (self.untied.tie(h), &harmonics[h].modes)).collect();
        let mut again = Vec::new();
        for (&h, verdict) in counted.iter().zip(count_modes(self.untied, stiffness, self.mass, &found)) {
            match verdict {
                Verdict::Complete(count) => completeness[h] = Some(Completeness::Counted(count)),
                _ if block < LARGEST_BLOCK => again.push(h),
                Verdict::Missed => return Err(h),
                Verdict::Uncountable => completeness[h] = Some(Completeness::Unproven),
            }
        }
        Ok(again)
    }

    /// The full sector's frequencies at a speed between the given ones, with K(Ω) through them, by blocks of `block`.
    pub(super) fn at_speed_between(
        &self,
        name: &str,
        speed_rad_s: f64,
        block: usize,
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
        let tied = self.tie(&factor, &stiffness);
        let free: Vec<&TiedFactor> = tied.iter().flatten().filter(|tied| tied.free.is_ok()).collect();
        let pencil = Pencil { untied: self.untied, stiffness: &stiffness, mass: self.mass, factor: &factor };
        let (full, _) = self
            .full_frequencies(&pencil, &free, None, block, &|done| phase(done).is_ok())
            .map_err(|error| mode_error(error, speed_rad_s))?;
        self.save(name, &full);
        Ok(full)
    }

    /// The dense factor of every nodal diameter; the number of the nodal diameter where it has none.
    fn tie(
        &self,
        factor: &SectorFactor<'_>,
        stiffness: &SparseColMat<usize, f64>,
    ) -> Vec<Result<TiedFactor, usize>> {
        (0..self.harmonics)
            .into_par_iter()
            .map(|harmonic| factor.tie(stiffness, harmonic).map_err(|_| harmonic))
            .collect()
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
            Wanted {
                count: self.modes_per_speed,
                block,
                free: false,
                vectors: true,
                tolerance: MODE_TOLERANCE,
                beyond: block / 2,
            },
            keep_going,
        )
    }

    /// The lowest frequencies of the nodal diameters in `free`, searched again with larger blocks where one lies above
    /// its ceiling, which tells that others were missed. Returns the largest block used.
    fn full_frequencies(
        &self,
        pencil: &Pencil<'_>,
        free: &[&TiedFactor],
        ceilings: Option<&[Vec<f64>]>,
        block: usize,
        keep_going: &dyn Fn(f64) -> bool,
    ) -> Result<(FullFrequencies, usize), ModeError> {
        let mut full = vec![None; self.harmonics];
        let mut waiting = free.to_vec();
        let mut block = block;
        loop {
            let mut again = Vec::new();
            for (group, members) in waiting.chunks(TOGETHER).enumerate() {
                let tolerance = FREQUENCY_TOLERANCE;
                let wanted =
                    Wanted { count: COMPARED, block, free: true, vectors: false, tolerance, beyond: 0 };
                let share = |done: f64| (group as f64 + done) / waiting.len().div_ceil(TOGETHER) as f64;
                let found = pencil.lowest_modes(members, wanted, &|done| keep_going(share(done)))?;
                for (&tied, modes) in members.iter().zip(found) {
                    let harmonic = tied.tie.harmonic;
                    let ceiling = ceilings.map_or(&[][..], |ceilings| &ceilings[harmonic]);
                    let mut pairs = modes.values.iter().zip(ceiling);
                    if block < LARGEST_BLOCK && pairs.any(|(found, ceiling)| found > ceiling) {
                        again.push(tied);
                    } else {
                        full[harmonic] = Some(modes.values.iter().map(|lambda| lambda.sqrt()).collect());
                    }
                }
            }
            if again.is_empty() {
                return Ok((full, block));
            }
            waiting = again;
            block *= 2;
        }
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
        ModeError::Massless { harmonic } => ModelError::ModesWithoutMass { nodal_diameter: harmonic }.into(),
        ModeError::DenseFailed { harmonic } => {
            ModelError::DecompositionFailed { nodal_diameter: harmonic, speed_rad_s }.into()
        }
    }
}
