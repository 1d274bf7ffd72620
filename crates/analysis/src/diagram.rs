//! Frequency diagram: natural frequencies of a wheel over a grid of speeds, and their crossings with engine orders.

use std::f64::consts::TAU;

use crate::result::WaveTables;
use rubmap_numerics::sector_fourier::harmonic_count;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::modal_wheel::{RotationEffects, natural_frequencies};
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::waves::wave_frequencies;
use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing, crossings, driven_crossings};
use rubmap_wheel::response::coincidence::{Coincidence, coincidences};
use rubmap_wheel::response::waves::{Branch, Frequencies, Table, Wave, Waves};

/// Frequencies of the first families over ascending speeds.
pub(super) struct FrequencyDiagram<'a> {
    wheel: &'a ReducedWheel,
    effects: RotationEffects,
    families: usize,
    /// Rotational speeds, rad/s.
    pub(super) speeds: Vec<f64>,
    /// Frequencies without Coriolis forces, `[speed][nodal diameter][family]`, Hz.
    pub(super) frequencies_hz: Table,
    /// Frequencies of waves with Coriolis forces, if those are among the effects.
    pub(super) waves: Option<WaveTables>,
}

impl<'a> FrequencyDiagram<'a> {
    /// Diagram without speeds.
    pub(super) fn new(wheel: &'a ReducedWheel, effects: RotationEffects, families: usize) -> Self {
        let waves = effects.coriolis.then(WaveTables::default);
        Self { wheel, effects, families, speeds: Vec::new(), frequencies_hz: Table::new(), waves }
    }

    /// Adds the frequencies at one speed, or nothing where the model fails.
    pub(super) fn push(&mut self, speed_rad_s: f64) -> Result<(), ModelError> {
        let mut row = Vec::new();
        let (mut forward, mut backward) = (Vec::new(), Vec::new());
        for i in 0..harmonic_count(self.wheel.sectors) {
            let stiffening = self.effects.stiffening;
            let omega = natural_frequencies(&self.wheel.harmonics[i], speed_rad_s, stiffening)?;
            row.push(self.lowest(&omega));
            if self.waves.is_some() {
                let waves = wave_frequencies(self.wheel, i, speed_rad_s, stiffening)?;
                forward.push(self.lowest(&waves.forward));
                backward.push(self.lowest(&waves.backward));
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

    fn lowest(&self, omega: &[f64]) -> Vec<f64> {
        omega.iter().take(self.families).map(|w| w / TAU).collect()
    }

    /// Crossings of the linear criterion.
    pub(super) fn crossings(&self, superharmonics: &[u32]) -> Vec<Crossing> {
        self.with_waves(|waves| crossings(waves, &self.speeds, self.families, superharmonics))
    }

    /// Crossings that excitations with `orders` periods around the circumference can drive.
    pub(super) fn driven_crossings(&self, orders: &[u32]) -> Vec<DrivenCrossing> {
        let sectors = self.wheel.sectors as u32;
        self.with_waves(|waves| driven_crossings(waves, &self.speeds, self.families, orders, sectors))
    }

    /// Coincidences with the waves of a casing.
    pub(super) fn coincidences(&self, casing: &[(u32, f64)]) -> Vec<Coincidence> {
        let sectors = self.wheel.sectors as u32;
        self.with_waves(|waves| coincidences(waves, &self.speeds, self.families, casing, sectors))
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
