//! Stress of one place over all blades and instants, in full precision.

use faer::{Mat, c64};

use super::cycle::{Cycle, Weights};
use super::look::turn;
use super::measure::Stress;
use super::reduced::ReducedStress;
use super::trajectory::Path;

/// Stress of a place over all blades and instants.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    /// Largest von Mises stress and its instant; `peak_blade` is its blade.
    pub(super) peak: (f64, usize),
    pub(super) peak_blade: usize,
    /// Cycle of the blade with the largest measure of utilisation.
    pub(super) cycle: Cycle,
    pub(super) cycle_blade: usize,
    pub(super) measure: f64,
}

/// Wheel whose places are followed.
pub(super) struct Follow<'a> {
    pub(super) stress: &'a ReducedStress,
    pub(super) fixed: &'a [Stress],
    pub(super) paths: &'a [Path],
    /// Number of blades that differ, and of blades around the wheel.
    pub(super) blades: (usize, usize),
    pub(super) instants: usize,
}

impl Follow<'_> {
    /// Follows a place; `weights` decide which blade's cycle is reported.
    pub(super) fn place(&self, place: usize, weights: Weights) -> Followed {
        let fixed = &self.fixed[place];
        let waves: Vec<(usize, Mat<c64>)> = (self.paths.iter())
            .map(|path| {
                let rows = self.stress.harmonics[path.harmonic].matrix(place);
                (path.harmonic, rows * &path.directions * &path.course)
            })
            .collect();
        let mut found: Option<Followed> = None;
        for blade in 0..self.blades.0 {
            let turns: Vec<c64> =
                waves.iter().map(|&(harmonic, _)| turn(harmonic, blade, self.blades.1)).collect();
            let path = (0..self.instants).map(|instant| -> Stress {
                let mut stress = *fixed;
                for ((_, wave), turn) in waves.iter().zip(&turns) {
                    for (component, stress) in stress.iter_mut().enumerate() {
                        *stress += (turn * wave[(component, instant)]).re;
                    }
                }
                stress
            });
            let cycle = Cycle::of(path);
            let measure = weights.of(cycle.alternating, cycle.mean);
            let here = Followed { peak: cycle.peak, peak_blade: blade, cycle, cycle_blade: blade, measure };
            found = Some(found.map_or(here, |before| before.with(&here)));
        }
        found.unwrap_or_else(|| unreachable!("a wheel has at least one blade"))
    }
}

impl Followed {
    /// Larger of the results of this blade and another one.
    fn with(mut self, other: &Self) -> Self {
        if other.peak.0 > self.peak.0 {
            (self.peak, self.peak_blade) = (other.peak, other.peak_blade);
        }
        if other.measure > self.measure {
            (self.cycle, self.cycle_blade, self.measure) = (other.cycle, other.cycle_blade, other.measure);
        }
        self
    }
}
