//! Modes of the families of a nodal diameter over speed, and those of a wheel at the speeds of a grid.

use std::sync::OnceLock;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::families::{FamilyModes, FamilyWalk, grid};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::reduction::ReducedWheel;

/// Modes of the families of a nodal diameter at ascending speeds.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub(crate) speeds: Vec<f64>,
    pub(crate) modes: Vec<FamilyModes>,
}

impl Track {
    /// Modes at one of the speeds.
    pub(crate) fn at(&self, speed_rad_s: f64) -> Option<&FamilyModes> {
        let found = self.speeds.binary_search_by(|speed| speed.total_cmp(&speed_rad_s)).ok()?;
        self.modes.get(found)
    }

    /// Modes at the speeds of the track below and above this one; at a speed of the track both are its own.
    fn around(&self, speed_rad_s: f64) -> Option<[&FamilyModes; 2]> {
        let above = self.speeds.partition_point(|&speed| speed < speed_rad_s);
        let below =
            if self.speeds.get(above) == Some(&speed_rad_s) { above } else { above.saturating_sub(1) };
        Some([self.modes.get(below)?, self.modes.get(above)?])
    }

    /// Family of a rank where it is the same on both sides of a speed.
    pub(crate) fn family(&self, speed_rad_s: f64, rank: usize) -> Option<usize> {
        let [low, high] = self.around(speed_rad_s)?.map(|modes| modes.family(rank));
        low.filter(|_| low == high)
    }

    /// Ranks of the first `count` families where they are the same on both sides of a speed.
    fn ranks(&self, speed_rad_s: f64, count: usize) -> Option<Vec<usize>> {
        let [low, high] = self.around(speed_rad_s)?.map(|modes| modes.ranks.iter().take(count));
        low.clone().eq(high).then(|| low.copied().collect())
    }
}

/// Families of a wheel on the grid on which they are followed, up to the highest speed of its matrices; computed on first use.
#[derive(Debug, Clone, Default)]
pub struct FamilyTracks(OnceLock<Vec<Track>>);

impl FamilyTracks {
    /// Ranks of the modes of the first `count` families, by harmonic of `modal`, which is `wheel` at its speed with stiffening.
    pub(crate) fn ranks(
        &self,
        wheel: &ReducedWheel,
        modal: &ModalWheel,
        count: usize,
    ) -> Result<Vec<Vec<usize>>, ModelError> {
        let speed = modal.speed_rad_s;
        let tracks = self.tracks(wheel)?;
        let ranks = |nodal_diameter: usize| match tracks[nodal_diameter].ranks(speed, count) {
            Some(ranks) => Ok(ranks),
            None => {
                let modes = FamilyWalk::new(wheel, nodal_diameter, true)?.at(speed)?;
                Ok(modes.ranks.into_iter().take(count).collect())
            }
        };
        modal.harmonics.iter().map(|modes| ranks(modes.harmonic)).collect()
    }

    fn tracks(&self, wheel: &ReducedWheel) -> Result<&[Track], ModelError> {
        if let Some(tracks) = self.0.get() {
            return Ok(tracks);
        }
        let top = wheel.speeds_rad_s.iter().copied().fold(0.0, f64::max);
        let speeds = grid(wheel, true, top);
        let track = |nodal_diameter: usize| {
            let mut walk = FamilyWalk::new(wheel, nodal_diameter, true)?;
            let modes = speeds.iter().map(|&speed| walk.at(speed)).collect::<Result<_, _>>()?;
            Ok(Track { speeds: speeds.clone(), modes })
        };
        let tracks = (0..wheel.harmonics.len()).into_par_iter().map(track);
        let tracks = tracks.collect::<Result<Vec<Track>, ModelError>>()?;
        Ok(self.0.get_or_init(|| tracks))
    }
}

#[cfg(test)]
mod tests {
    use faer::{Mat, c64};

    use super::*;
    use rubmap_wheel::dynamics::centrifugal::StiffnessPolynomial;
    use rubmap_wheel::dynamics::modal_wheel::RotationEffects;
    use rubmap_wheel::dynamics::reduction::{InterpolationCheck, InterpolationVerdict, ReducedHarmonic};

    /// Wheel of one sector with ω² = 100² + 1.5Ω² and 180², which are equal at 122.2 rad/s: between steps of 10 rad/s.
    fn wheel() -> ReducedWheel {
        let diagonal =
            |a: f64, b: f64| Mat::from_fn(2, 2, |i, j| c64::new(if i == j { [a, b][i] } else { 0.0 }, 0.0));
        let coefficients = vec![diagonal(1e4, 3.24e4), diagonal(1.5, 0.0), diagonal(0.0, 0.0)];
        ReducedWheel {
            sectors: 1,
            contact: Vec::new(),
            speeds_rad_s: vec![0.0, 120.0, 240.0],
            harmonics: vec![ReducedHarmonic {
                harmonic: 0,
                mass: diagonal(1.0, 1.0),
                stiffness: StiffnessPolynomial { coefficients },
                gyroscopic: None,
                certificates: Vec::new(),
            }],
            interpolation: InterpolationCheck {
                verdict: InterpolationVerdict::Sound,
                linear_ratio: 0.0,
                quadratic_ratio: 0.0,
                frequency_error: 0.0,
            },
            comparison: Vec::new(),
        }
    }

    #[test]
    fn ranks_change_at_the_crossing() {
        let (wheel, tracks) = (wheel(), FamilyTracks::default());
        let at = (1.5_f64.recip() * 2.24e4).sqrt();
        for (speed, expected) in [
            (0.0, [0, 1]),
            (60.0, [0, 1]),
            (0.999 * at, [0, 1]),
            (1.001 * at, [1, 0]),
            (130.0, [1, 0]),
            (900.0, [1, 0]),
        ] {
            let modal = ModalWheel::at(&wheel, speed, RotationEffects::stiffening(true)).unwrap();
            assert_eq!(tracks.ranks(&wheel, &modal, 2).unwrap(), [expected], "{speed} rad/s");
            assert_eq!(tracks.ranks(&wheel, &modal, 1).unwrap(), [[expected[0]]], "{speed} rad/s");
        }
    }
}
