//! Part of a reduction that needs the sector's factor at one speed: modes of every nodal diameter, their count, and the full sector's own
//! lowest frequencies.

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
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use rubmap_numerics::matrix_serde;

/// Number of vectors advanced together in a search; doubled when modes turn out to be missing.
const BLOCK: usize = 4;
/// Largest block of a search: eigenvalues of a higher multiplicity are refused or left unproven.
pub(super) const LARGEST_BLOCK: usize = 64;
/// Residual of the modes of the basis: 1e-8 in x is 1e-16 in λ; 1e-9 leaves a margin.
const MODE_TOLERANCE: f64 = 1e-9;
/// Residual behind the full sector's frequencies: right to some nine digits.
pub(super) const FREQUENCY_TOLERANCE: f64 = 3e-5;
/// Number of nodal diameters searched together: enough to share solves, few enough for their Krylov bases to fit.
pub(super) const TOGETHER: usize = 6;
/// Number of frequencies of the full sector that the reduced ones are compared with.
pub(super) const COMPARED: usize = 10;
/// Number of modes of the full sector at a given speed beyond the compared ones, which tell whether any is missing between the speeds.
pub(super) const BEYOND_COMPARED: usize = 2;

/// Results of the searches of one nodal diameter at one speed.
#[derive(Serialize, Deserialize)]
pub(super) struct HarmonicPart {
    /// Modes with fixed contact DOF.
    pub(super) modes: Modes,
    /// Lowest modes of the full sector; none where its stiffness is indefinite.
    pub(super) full: Option<Modes>,
    /// Block that found the modes of the full sector.
    pub(super) full_block: usize,
    /// Static modes Ψ_s(0), from the search at rest only.
    #[serde(with = "matrix_serde::list")]
    static_modes: Vec<Mat<c64>>,
}

impl HarmonicPart {
    /// Static modes Ψ_s(0), of a part found at rest.
    pub(super) fn static_modes(&self) -> &Mat<c64> {
        &self.static_modes[0]
    }
}

/// Circular frequencies of the full sector per nodal diameter, ascending; none where its stiffness is indefinite.
pub(super) type FullFrequencies = Vec<Option<Vec<f64>>>;

/// Results at one given speed.
pub(super) struct SpeedPart {
    pub(super) harmonics: Vec<HarmonicPart>,
    pub(super) completeness: Vec<Completeness>,
}

impl SpeedPart {
    /// Lowest frequencies of the full sector.
    pub(super) fn full_frequencies(&self) -> FullFrequencies {
        self.harmonics.iter().map(|part| part.full.as_ref().map(frequencies)).collect()
    }
}

/// Stiffness at one given speed and its factors.
pub(super) struct Factored<'a> {
    pub(super) stiffness: SparseColMat<usize, f64>,
    pub(super) factor: SectorFactor<'a>,
    pub(super) tied: Vec<TiedFactor>,
}

/// Circular frequencies of the modes that are compared.
pub(super) fn frequencies(modes: &Modes) -> Vec<f64> {
    modes.values.iter().take(COMPARED).map(|value| value.sqrt()).collect()
}

/// Sector on its way through a reduction.
pub(super) struct Work<'a> {
    pub(super) sector: &'a SectorModel,
    pub(super) untied: &'a UntiedSector,
    /// Mass matrix M of the untied sector.
    pub(super) mass: &'a SparseColMat<usize, f64>,
    pub(super) modes_per_speed: usize,
    pub(super) harmonics: usize,
    pub(super) checkpoints: &'a dyn Checkpoints,
}

impl<'a> Work<'a> {
    /// Computes modes, counts and full modes at the given speed number `index`, and the factors they needed.
    pub(super) fn at_given_speed(
        &self,
        index: usize,
        watch: Watch<'_>,
    ) -> Result<(SpeedPart, Option<Factored<'a>>), ReductionError> {
        let harmonic_name = |harmonic: usize| format!("speed-{index}-harmonic-{harmonic}");
        let mut harmonics: Vec<Option<HarmonicPart>> =
            (0..self.harmonics).map(|harmonic| self.load(&harmonic_name(harmonic))).collect();
        let summary_name = format!("speed-{index}");
        if let Some(completeness) = self.load(&summary_name)
            && harmonics.iter().all(Option::is_some)
        {
            let harmonics = harmonics.into_iter().flatten().collect();
            return Ok((SpeedPart { harmonics, completeness }, None));
        }

        let speed_rad_s = self.sector.speeds_rad_s[index];
        let phase = |share: f64, what: &str| go_on(watch, share, &format!("{what} at {speed_rad_s} rad/s"));
        let factored = self.factored(index, watch)?;
        let Factored { stiffness, factor, tied } = &factored;
        let pencil = Pencil { untied: self.untied, stiffness, mass: self.mass, factor };

        let unknown: Vec<usize> = (0..self.harmonics).filter(|&h| harmonics[h].is_none()).collect();
        let groups = unknown.len().div_ceil(TOGETHER) as f64;
        for (group, members) in unknown.chunks(TOGETHER).enumerate() {
            let what = format!("modes of nodal diameter{}", list(members));
            let share = |done: f64| 0.1 + 0.6 * (group as f64 + done) / groups;
            let free: Vec<usize> = members.iter().copied().filter(|&h| tied[h].free.is_ok()).collect();
            let asked: Vec<(&TiedFactor, Wanted)> = (members.iter())
                .map(|&h| (&tied[h], self.wanted(BLOCK)))
                .chain(free.iter().map(|&h| (&tied[h], self.wanted_of_full(BLOCK, true))))
                .collect();
            let found = search(&pencil, &asked, speed_rad_s, &|done| phase(share(done), &what).is_ok())?;
            let mut found = found.into_iter();
            for (&harmonic, modes) in members.iter().zip(found.by_ref().take(members.len())) {
                let static_modes =
                    if index == 0 { vec![factor.static_modes(&tied[harmonic])] } else { Vec::new() };
                harmonics[harmonic] =
                    Some(HarmonicPart { modes, full: None, full_block: BLOCK, static_modes });
            }
            for (&harmonic, full) in free.iter().zip(found) {
                if let Some(part) = &mut harmonics[harmonic] {
                    part.full = Some(full);
                }
            }
            for &harmonic in members {
                harmonics[harmonic].iter().for_each(|part| self.save(&harmonic_name(harmonic), part));
            }
        }
        let mut harmonics: Vec<HarmonicPart> = harmonics.into_iter().flatten().collect();

        phase(0.7, "counting modes")?;
        let mut completeness = vec![None; self.harmonics];
        let mut block = BLOCK;
        loop {
            let open: Vec<usize> = (0..self.harmonics).filter(|&h| completeness[h].is_none()).collect();
            let doubtful = self.prove(stiffness, &harmonics, &open, block, &mut completeness);
            let doubtful =
                doubtful.map_err(|h| ModelError::ModesMissed { nodal_diameter: h, speed_rad_s })?;
            if doubtful.is_empty() {
                break;
            }
            block *= 2;
            let what = format!("searching again for modes, nodal diameter{}", list(&doubtful));
            let asked: Vec<_> = doubtful.iter().map(|&h| (&tied[h], self.wanted(block))).collect();
            let again = search(&pencil, &asked, speed_rad_s, &|_| phase(0.7, &what).is_ok())?;
            for (&harmonic, modes) in doubtful.iter().zip(again) {
                harmonics[harmonic].modes = modes;
                self.save(&harmonic_name(harmonic), &harmonics[harmonic]);
            }
        }
        let completeness: Vec<Completeness> = completeness.into_iter().flatten().collect();

        loop {
            // Fixing the contact DOF raises every frequency: one of the full sector above a fixed one tells of others that
            // were missed.
            let above = |part: &HarmonicPart| {
                let full = part.full.iter().flat_map(|full| &full.values);
                full.zip(part.modes.ceilings()).any(|(&full, ceiling)| full > ceiling)
            };
            let missed: Vec<usize> = (0..self.harmonics)
                .filter(|&h| harmonics[h].full_block < LARGEST_BLOCK && above(&harmonics[h]))
                .collect();
            if missed.is_empty() {
                break;
            }
            let block = |h: usize| 2 * harmonics[h].full_block;
            let what =
                format!("searching again for modes of the full sector, nodal diameter{}", list(&missed));
            let asked: Vec<_> =
                missed.iter().map(|&h| (&tied[h], self.wanted_of_full(block(h), true))).collect();
            let again = search(&pencil, &asked, speed_rad_s, &|_| phase(0.9, &what).is_ok())?;
            for (&harmonic, full) in missed.iter().zip(again) {
                harmonics[harmonic].full = Some(full);
                harmonics[harmonic].full_block *= 2;
                self.save(&harmonic_name(harmonic), &harmonics[harmonic]);
            }
        }
        self.save(&summary_name, &completeness);
        Ok((SpeedPart { harmonics, completeness }, Some(factored)))
    }

    /// Factors the stiffness at the given speed number `index`.
    pub(super) fn factored(&self, index: usize, watch: Watch<'_>) -> Result<Factored<'a>, ReductionError> {
        let speed_rad_s = self.sector.speeds_rad_s[index];
        go_on(watch, 0.0, &format!("factorisation at {speed_rad_s} rad/s"))?;
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
        Ok(Factored { stiffness, factor, tied })
    }

    /// Counts the modes of the nodal diameters `open`, found with blocks of `block`; returns those to search again, or one whose modes are
    /// missing for good.
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

    /// Dense factor of every nodal diameter; the number of the nodal diameter where it has none.
    pub(super) fn tie(
        &self,
        factor: &SectorFactor<'_>,
        stiffness: &SparseColMat<usize, f64>,
    ) -> Vec<Result<TiedFactor, usize>> {
        (0..self.harmonics)
            .into_par_iter()
            .map(|harmonic| factor.tie(stiffness, harmonic).map_err(|_| harmonic))
            .collect()
    }

    /// Requirements on the modes of the basis, by blocks of `block`.
    fn wanted(&self, block: usize) -> Wanted {
        Wanted {
            count: self.modes_per_speed,
            block,
            free: false,
            vectors: true,
            tolerance: MODE_TOLERANCE,
            beyond: block / 2,
        }
    }

    /// Requirements on the full sector's lowest modes, at a given speed or not. At the given speeds a few more are needed than are
    /// compared: the frequencies between the speeds follow from them.
    pub(super) fn wanted_of_full(&self, block: usize, given: bool) -> Wanted {
        let vectors = given && self.sector.speeds_rad_s.len() == 3;
        let count = if vectors { COMPARED + BEYOND_COMPARED } else { COMPARED };
        Wanted { count, block, free: true, vectors, tolerance: FREQUENCY_TOLERANCE, beyond: 0 }
    }

    pub(super) fn load<T: DeserializeOwned>(&self, part: &str) -> Option<T> {
        postcard::from_bytes(&self.checkpoints.load(part)?).ok()
    }

    pub(super) fn save<T: Serialize>(&self, part: &str, value: &T) {
        if let Ok(bytes) = postcard::to_stdvec(value) {
            self.checkpoints.save(part, bytes);
        }
    }
}

/// Searches the modes asked for, as many at a time as both kinds of modes of [`TOGETHER`] nodal diameters.
pub(super) fn search(
    pencil: &Pencil<'_>,
    asked: &[(&TiedFactor, Wanted)],
    speed_rad_s: f64,
    keep_going: &dyn Fn(f64) -> bool,
) -> Result<Vec<Modes>, ReductionError> {
    let groups = asked.len().div_ceil(2 * TOGETHER) as f64;
    let mut found = Vec::with_capacity(asked.len());
    for (group, asked) in asked.chunks(2 * TOGETHER).enumerate() {
        let modes = pencil.lowest_modes(asked, &|done| keep_going((group as f64 + done) / groups));
        found.extend(modes.map_err(|error| mode_error(error, speed_rad_s))?);
    }
    Ok(found)
}

pub(super) fn go_on(watch: Watch<'_>, share: f64, phase: &str) -> Result<(), ReductionError> {
    if watch(share, phase) { Ok(()) } else { Err(ReductionError::Cancelled) }
}

/// List of nodal diameters in words: ` 3`, or `s 0 to 5`.
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
