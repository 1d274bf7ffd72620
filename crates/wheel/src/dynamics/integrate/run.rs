//! Results of a run, and how it ended.

use super::bounds::TipDisplacement;
use super::detail::DetailHistory;
use super::excursion::Excursion;
use super::revolutions::Repeated;
use super::states::ModalStates;
use super::tally::ContactRecord;
use super::tips::TipMotion;
use crate::dynamics::contact::coating::WornCoating;
use crate::dynamics::energy::EnergyAudit;
use crate::dynamics::initial::{InitialMode, SteppedWave};
use crate::dynamics::statistics::RunStatistics;
use rubmap_numerics::complementarity::ComplementarityError;

/// Histories that a simulation recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Displacements at the sensor's sector over the whole run, `[sensor][sample]`.
    pub displacement: Vec<Vec<f64>>,
    /// Coordinates of all sectors in the real orthonormal Fourier basis over the window, `[sensor][Fourier column][sample]`, every sample
    /// being a weighted mean of the steps around it so that nothing folds onto its lower half (docs/method.md, Sampling).
    pub harmonics: Vec<Vec<Vec<f64>>>,
    /// Displacements at the sensor's sector over the window, `[sensor][sample]`, with samples as those of `harmonics`.
    pub window: Vec<Vec<f64>>,
    /// Mechanical energy at the end of each revolution, `[revolution][nodal diameter]`, if asked for.
    pub energies: Vec<Vec<f64>>,
    /// Motion of a run that ended because it repeats; the results are then as if it had gone on for a whole window.
    pub repeated: Option<Repeated>,
    /// Modes at the end of the run, all of them.
    pub end: Vec<InitialMode>,
    /// Waves of an elastic casing at the end of the run, all of them.
    pub casing_end: Vec<SteppedWave>,
    /// Motion of the tips over the window, `[sector][contact node][component]`, one after the other.
    pub tips: Vec<TipMotion>,
    /// Largest excursions of the tips.
    pub excursion: Excursion,
    /// Histories of chosen revolutions, if any were recorded.
    pub detail: Option<Box<DetailHistory>>,
    /// Modes at the samples of chosen revolutions, all of them, if they were asked for.
    pub states: Option<Box<ModalStates>>,
}

/// Response that left the bounds of the theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Divergence {
    /// Revolutions integrated until the divergence was found.
    pub revolutions: f64,
    /// Tip that had moved most by then; none where nothing can be touched, and numbers overflowed.
    pub tip: Option<TipDisplacement>,
    /// Mechanical energy at that time over that at the end of the last whole revolution; none in the first.
    pub energy_growth: Option<f64>,
}

/// End of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Run that integrated all revolutions.
    Completed(History),
    /// Run in which a tip that a casing may touch moved by more than a tenth of the wheel's radius in any component, or a number
    /// overflowed. Without a casing the response is linear, and may be of any size.
    Diverged(Divergence),
    /// Run that stopped at a step whose contact problem could not be solved.
    ContactFailed {
        /// Revolutions integrated until then.
        revolutions: f64,
        /// Error of the contact solver.
        error: ComplementarityError,
    },
    /// Run that the caller stopped.
    Cancelled,
}

/// Outcome with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// End of the run.
    pub outcome: Outcome,
    /// Counters of the run.
    pub statistics: RunStatistics,
    /// Energy audit of the run.
    pub energy: EnergyAudit,
    /// Coating at the end, if there is one.
    pub coating: Option<WornCoating>,
    /// Contact over the window, where there is a casing.
    pub contact: Option<ContactRecord>,
}

impl Run {
    /// Extends a run whose window is the `period` of a motion that repeats, as if it had gone on for `revolutions` in all, the last
    /// `window` of them recorded. Counters stay those of the revolutions that were taken.
    #[must_use]
    pub fn repeated(mut self, period: usize, revolutions: usize, window: usize) -> Self {
        let times = window / period;
        if let Outcome::Completed(history) = &mut self.outcome {
            for (line, window) in history.displacement.iter_mut().zip(&history.window) {
                let missing = revolutions * window.len() / period - line.len();
                let last = line.split_off(line.len() - window.len());
                line.extend(last.iter().cycle().take(last.len() + missing));
            }
            history.window.iter_mut().for_each(|line| *line = line.repeat(times));
            history.harmonics.iter_mut().flatten().for_each(|line| *line = line.repeat(times));
        }
        for pair in self.contact.iter_mut().flat_map(|contact| &mut contact.pairs) {
            pair.impulse *= times as f64;
            pair.steps *= times as u64;
            pair.closings *= times as u64;
        }
        self
    }
}

/// Largest number of values of a restriction table (2 GiB); a larger table is refused.
pub const MAX_TABLE_VALUES: usize = 1 << 28;
