//! Travelling waves of wheel and casing that coincide: n Ω = |ω_rotor ± ω_casing|.
//!
//! A wave of the wheel with n waves around it, at ω in the rotating frame, is seen at |ω ± nΩ| from the casing. Where that is
//! the casing's own frequency for n, either feeds the other (Schmiechen, Travelling wave speed coincidence, PhD thesis,
//! Imperial College London, 1997). n of the casing meets nodal diameter |n − N·round(n/N)| of the wheel.

use serde::{Deserialize, Serialize};

use super::campbell::{Line, roots};
use super::waves::{Frequencies, Wave, Waves, driven_wave, fold};

/// Coincidence of a wave of the wheel with one of the casing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Coincidence {
    /// Nodal diameter n of the casing.
    pub casing_nodal_diameter: u32,
    /// Natural frequency of the casing's wave, Hz.
    pub casing_frequency_hz: f64,
    /// Nodal diameter of the wheel.
    pub nodal_diameter: u32,
    /// Modal family of the wheel, from 1.
    pub family: u32,
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Frequency of the wheel in the rotating frame, Hz.
    pub frequency_hz: f64,
    /// Whether nΩ is the sum of both frequencies; otherwise it is their difference.
    pub sum: bool,
}

impl Coincidence {
    /// Direction in which the wheel's wave travels, on `sectors` sectors.
    pub fn wave(&self, sectors: u32) -> Wave {
        let against = driven_wave(self.casing_nodal_diameter, sectors).unwrap_or(Wave::Backward);
        let is_against = self.sum || self.frequency_hz > self.casing_frequency_hz;
        if is_against { against } else { opposite(against) }
    }
}

fn opposite(wave: Wave) -> Wave {
    if wave == Wave::Backward { Wave::Forward } else { Wave::Backward }
}

/// Coincidences of the first `families` with the casing's waves (n, Hz) over `grid` (ascending, rad/s), in ascending speed.
/// n = 0 turns with any speed alike and is left out.
pub fn coincidences<F: Frequencies>(
    waves: &Waves<'_, F>,
    grid: &[f64],
    families: usize,
    casing: &[(u32, f64)],
    sectors: u32,
) -> Vec<Coincidence> {
    let mut all = Vec::new();
    for &(n, casing_hz) in casing.iter().filter(|(n, _)| *n > 0) {
        let nodal_diameter = fold(n, sectors);
        // The wave that a field of n periods at rest drives runs against it; the other one with it.
        let against = driven_wave(n, sectors).unwrap_or(Wave::Backward);
        let with = opposite(against);
        // nΩ = ω + ω_c,  nΩ = ω − ω_c,  nΩ = ω_c − ω
        let lines = [
            (against, Line { order: n, sign: 1.0, offset: casing_hz }),
            (against, Line { order: n, sign: 1.0, offset: -casing_hz }),
            (with, Line { order: n, sign: -1.0, offset: casing_hz }),
        ];
        for (index, (wave, line)) in lines.into_iter().enumerate() {
            for family in 0..families {
                let found = roots(waves.of(wave), grid, nodal_diameter, family, line);
                all.extend(found.into_iter().map(|(speed_rad_s, frequency_hz)| Coincidence {
                    casing_nodal_diameter: n,
                    casing_frequency_hz: casing_hz,
                    nodal_diameter,
                    family: family as u32 + 1,
                    speed_rad_s,
                    frequency_hz,
                    sum: index == 0,
                }));
            }
        }
    }
    all.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    all
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::response::waves::{Branch, Table};

    /// Frequencies 100, 110 … Hz at every speed, in every nodal diameter.
    struct Constant;

    impl Frequencies for Constant {
        fn at(&self, _speed_rad_s: f64, nodal_diameter: u32) -> Option<Vec<f64>> {
            Some(vec![100.0 + 10.0 * f64::from(nodal_diameter)])
        }
    }

    #[test]
    fn every_combination_is_found_where_it_is() {
        let grid: Vec<f64> = (0..=20).map(|i| TAU * (0.5 + 10.0 * f64::from(i))).collect();
        let row = |speed: f64| (0..=4).map(|i| Constant.at(speed, i).unwrap()).collect();
        let table: Table = grid.iter().map(|&speed| row(speed)).collect();
        let waves = Waves::Alike(Branch { table: &table, frequencies: &Constant });
        // Nodal diameter 2 of the wheel, 120 Hz, and (7 on 9 sectors) the same again.
        let found = coincidences(&waves, &grid, 1, &[(0, 50.0), (2, 50.0), (7, 300.0)], 9);
        let expected = [
            (7, (300.0 - 120.0) / 7.0, false),
            (2, (120.0 - 50.0) / 2.0, false),
            (7, (300.0 + 120.0) / 7.0, true),
            (2, (120.0 + 50.0) / 2.0, true),
        ];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, (n, hz, sum)) in found.iter().zip(expected) {
            assert_eq!((found.casing_nodal_diameter, found.nodal_diameter, found.sum), (n, 2, sum));
            assert!((found.speed_rad_s / TAU - hz).abs() < 1e-9, "{found:?} {hz}");
            assert!((found.frequency_hz - 120.0).abs() < 1e-8);
        }
    }
}
