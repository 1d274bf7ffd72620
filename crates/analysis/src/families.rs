//! Modal families of a wheel over speed: ranks, or modes that are followed by their shapes.

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::error::AnalysisError;
use crate::family_track::Track;
use crate::monitor::Monitor;
use rubmap_numerics::sector_fourier::harmonic_count;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::families::{FamilyModes, FamilyWalk, grid};
use rubmap_wheel::dynamics::modal_wheel::{RotationEffects, natural_frequencies};
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::waves::{WaveModes, wave_modes};
use rubmap_wheel::response::veerings::{Veering, veerings};
use rubmap_wheel::response::waves::Wave;

/// Families, the names of a wheel's modes: by rank, or followed by shape.
pub(crate) struct Families<'a> {
    wheel: &'a ReducedWheel,
    effects: RotationEffects,
    /// Modes of every nodal diameter; none where a family is a rank.
    tracks: Vec<Track>,
}

impl<'a> Families<'a> {
    /// Families that are ranks.
    pub(crate) fn by_rank(wheel: &'a ReducedWheel, effects: RotationEffects) -> Self {
        Self { wheel, effects, tracks: Vec::new() }
    }

    /// Families followed from rest, past the speed `top_rad_s`; their modes are known at all `speeds`.
    pub(crate) fn followed(
        wheel: &'a ReducedWheel,
        effects: RotationEffects,
        speeds: &[f64],
        top_rad_s: f64,
        monitor: &dyn Monitor,
    ) -> Result<Self, AnalysisError> {
        let mut all = grid(wheel, effects.stiffening, top_rad_s);
        all.extend(speeds);
        all.sort_by(f64::total_cmp);
        all.dedup();
        let track = |nodal_diameter: usize| {
            let mut walk = FamilyWalk::new(wheel, nodal_diameter, effects.stiffening)?;
            let mut modes = Vec::with_capacity(all.len());
            for &speed in &all {
                if monitor.is_cancelled() {
                    return Err(AnalysisError::Cancelled);
                }
                modes.push(walk.at(speed)?);
            }
            Ok(Track { speeds: all.clone(), modes })
        };
        let tracks = (0..harmonic_count(wheel.sectors)).into_par_iter().map(track);
        Ok(Self { wheel, effects, tracks: tracks.collect::<Result<_, AnalysisError>>()? })
    }

    /// Number of lowest ranks among which the first `families` are at all speeds that were followed.
    pub(crate) fn ranks(&self, families: usize) -> usize {
        let modes = self.tracks.iter().flat_map(|track| &track.modes);
        let ranks = modes.flat_map(|modes| modes.ranks.iter().take(families));
        let highest = ranks.max().map_or(0, |rank| rank + 1).max(families);
        // Coriolis forces may lead waves of neighbouring modes past each other.
        if self.effects.coriolis && !self.tracks.is_empty() { highest + 2 } else { highest }
    }

    /// Modes of the families of a nodal diameter at one of the speeds that were given; none where a family is a rank.
    pub(crate) fn at(&self, nodal_diameter: usize, speed_rad_s: f64) -> Option<&FamilyModes> {
        self.tracks.get(nodal_diameter)?.at(speed_rad_s)
    }

    /// Modes that the waves of a nodal diameter consist of, where families are followed and Coriolis forces act.
    pub(crate) fn waves(
        &self,
        nodal_diameter: usize,
        speed_rad_s: f64,
    ) -> Result<Option<WaveModes>, ModelError> {
        if self.tracks.is_empty() || !self.effects.coriolis {
            return Ok(None);
        }
        wave_modes(self.wheel, nodal_diameter, speed_rad_s, self.effects.stiffening).map(Some)
    }

    /// Family, from 0, of the frequency with this rank: of waves of one direction, if Coriolis forces act. None where the model fails.
    pub(crate) fn family(
        &self,
        nodal_diameter: usize,
        speed_rad_s: f64,
        wave: Wave,
        rank: usize,
    ) -> Option<usize> {
        let Some(track) = self.tracks.get(nodal_diameter) else { return Some(rank) };
        let rank = match self.waves(nodal_diameter, speed_rad_s).ok()? {
            None => rank,
            Some(modes) => *(if wave == Wave::Forward { modes.forward } else { modes.backward }).get(rank)?,
        };
        track.family(speed_rad_s, rank).or_else(|| {
            let mut walk = FamilyWalk::new(self.wheel, nodal_diameter, self.effects.stiffening).ok()?;
            walk.at(speed_rad_s).ok()?.family(rank)
        })
    }

    /// Veerings and crossings of the first `families` up to a speed.
    pub(crate) fn veerings(&self, families: usize, top_rad_s: f64) -> Vec<Veering> {
        let stiffening = self.effects.stiffening;
        let speeds = grid(self.wheel, stiffening, top_rad_s);
        let mut all: Vec<Veering> = Vec::new();
        for (nodal_diameter, track) in self.tracks.iter().enumerate() {
            let modes: Vec<FamilyModes> =
                speeds.iter().filter_map(|&speed| track.at(speed).cloned()).collect();
            let harmonic = &self.wheel.harmonics[nodal_diameter];
            let omega = |speed: f64| natural_frequencies(harmonic, speed, stiffening).ok();
            all.extend(veerings(&speeds, &modes, nodal_diameter as u32, families, omega));
        }
        all.retain(|found| found.speed_rad_s <= top_rad_s);
        all
    }
}
