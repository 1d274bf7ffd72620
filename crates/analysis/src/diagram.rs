//! Frequency diagram: natural frequencies of a wheel over a grid of speeds, and their crossings with engine orders.

use std::f64::consts::TAU;

use crate::families::Families;
use crate::result::WaveTables;
use rubmap_numerics::sector_fourier::harmonic_count;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::modal_wheel::{RotationEffects, natural_frequencies};
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::waves::wave_frequencies;
use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing, crossings, driven_crossings};
use rubmap_wheel::response::coincidence::{Coincidence, coincidences};
use rubmap_wheel::response::waves::{Branch, Frequencies, Table, Wave, Waves};

/// Frequencies over ascending speeds by rank, and their crossings by family.
pub(super) struct FrequencyDiagram<'a> {
    wheel: &'a ReducedWheel,
    effects: RotationEffects,
    /// Number of families whose crossings are sought.
    count: usize,
    /// Rotational speeds, rad/s.
    pub(super) speeds: Vec<f64>,
    /// Frequencies without Coriolis forces, `[speed][nodal diameter][rank]`, Hz.
    pub(super) frequencies_hz: Table,
    /// Frequencies of waves with Coriolis forces, if those are among the effects.
    pub(super) waves: Option<WaveTables>,
}

impl<'a> FrequencyDiagram<'a> {
    /// Diagram without speeds.
    pub(super) fn new(wheel: &'a ReducedWheel, effects: RotationEffects, count: usize) -> Self {
        let waves = effects.coriolis.then(WaveTables::default);
        Self { wheel, effects, count, speeds: Vec::new(), frequencies_hz: Table::new(), waves }
    }

    /// Adds the frequencies at one speed, or nothing where the model fails.
    pub(super) fn push(&mut self, speed_rad_s: f64) -> Result<(), ModelError> {
        let mut row = Vec::new();
        let (mut forward, mut backward) = (Vec::new(), Vec::new());
        for i in 0..harmonic_count(self.wheel.sectors) {
            let stiffening = self.effects.stiffening;
            let omega = natural_frequencies(&self.wheel.harmonics[i], speed_rad_s, stiffening)?;
            row.push(in_hz(&omega));
            if self.waves.is_some() {
                let waves = wave_frequencies(self.wheel, i, speed_rad_s, stiffening)?;
                forward.push(in_hz(&waves.forward));
                backward.push(in_hz(&waves.backward));
            }
        }
        self.speeds.push(speed_rad_s);
        self.frequencies_hz.push(row);
        if let Some(waves) = &mut self.waves {
            waves.forward_hz.push(forward);
            waves.backward_hz.push(backward);
        }
        Ok(())
    }

    /// Crossings of the linear criterion.
    pub(super) fn crossings(&self, families: &Families<'_>, superharmonics: &[u32]) -> Vec<Crossing> {
        let ranks = families.ranks(self.count);
        let all = self.with_waves(|waves| crossings(waves, &self.speeds, ranks, superharmonics));
        let named = all.into_iter().filter_map(|found| {
            let Crossing { nodal_diameter, speed_rad_s, family: rank, .. } = found;
            let family = self.family(families, nodal_diameter, speed_rad_s, Wave::Backward, rank)?;
            Some(Crossing { family, ..found })
        });
        named.collect()
    }

    /// Crossings that excitations with `orders` periods around the circumference can drive.
    pub(super) fn driven_crossings(&self, families: &Families<'_>, orders: &[u32]) -> Vec<DrivenCrossing> {
        let (ranks, sectors) = (families.ranks(self.count), self.wheel.sectors as u32);
        let all = self.with_waves(|waves| driven_crossings(waves, &self.speeds, ranks, orders, sectors));
        let named = all.into_iter().filter_map(|found| {
            let DrivenCrossing { nodal_diameter, speed_rad_s, family: rank, .. } = found;
            let wave = found.wave.unwrap_or(Wave::Backward);
            let family = self.family(families, nodal_diameter, speed_rad_s, wave, rank)?;
            Some(DrivenCrossing { family, ..found })
        });
        named.collect()
    }

    /// Coincidences with the waves of a casing.
    pub(super) fn coincidences(&self, families: &Families<'_>, casing: &[(u32, f64)]) -> Vec<Coincidence> {
        let (ranks, sectors) = (families.ranks(self.count), self.wheel.sectors as u32);
        let all = self.with_waves(|waves| coincidences(waves, &self.speeds, ranks, casing, sectors));
        let named = all.into_iter().filter_map(|found| {
            let Coincidence { nodal_diameter, speed_rad_s, family: rank, .. } = found;
            let wave = found.wave(sectors);
            let family = self.family(families, nodal_diameter, speed_rad_s, wave, rank)?;
            Some(Coincidence { family, ..found })
        });
        named.collect()
    }

    /// Family of a rank, both from 1, if it is among those whose crossings are sought.
    fn family(
        &self,
        families: &Families<'_>,
        nodal_diameter: u32,
        speed: f64,
        wave: Wave,
        rank: u32,
    ) -> Option<u32> {
        let family = families.family(nodal_diameter as usize, speed, wave, rank as usize - 1)?;
        (family < self.count).then_some(family as u32 + 1)
    }

    fn with_waves<T>(&self, use_them: impl FnOnce(&Waves<'_, WheelFrequencies<'_>>) -> T) -> T {
        let source = |wave| WheelFrequencies { wheel: self.wheel, stiffening: self.effects.stiffening, wave };
        match &self.waves {
            None => {
                let plain = source(None);
                use_them(&Waves::Alike(Branch { table: &self.frequencies_hz, frequencies: &plain }))
            }
            Some(WaveTables { forward_hz, backward_hz }) => {
                let (forward, backward) = (source(Some(Wave::Forward)), source(Some(Wave::Backward)));
                use_them(&Waves::Split {
                    forward: Branch { table: forward_hz, frequencies: &forward },
                    backward: Branch { table: backward_hz, frequencies: &backward },
                })
            }
        }
    }
}

fn in_hz(omega: &[f64]) -> Vec<f64> {
    omega.iter().map(|w| w / TAU).collect()
}

/// Reduced wheel as a source of frequencies in Hz: of waves of one direction, or without Coriolis forces.
struct WheelFrequencies<'a> {
    wheel: &'a ReducedWheel,
    stiffening: bool,
    wave: Option<Wave>,
}

impl Frequencies for WheelFrequencies<'_> {
    fn at(&self, speed_rad_s: f64, nodal_diameter: u32) -> Option<Vec<f64>> {
        let i = nodal_diameter as usize;
        let waves = || wave_frequencies(self.wheel, i, speed_rad_s, self.stiffening).ok();
        let omega = match self.wave {
            None => natural_frequencies(&self.wheel.harmonics[i], speed_rad_s, self.stiffening).ok()?,
            Some(Wave::Forward) => waves()?.forward,
            Some(Wave::Backward) => waves()?.backward,
        };
        Some(omega.into_iter().map(|w| w / TAU).collect())
    }
}
