//! How a run ended, and what it left.

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

/// What a simulation recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// `[sensor][sample]`: displacement at the sensor's sector, over the whole run.
    pub displacement: Vec<Vec<f64>>,
    /// `[sensor][Fourier column][sample]`: coordinates of all sectors in the real orthonormal Fourier basis, over the
    /// window, every sample being a weighted mean of the steps around it so that nothing folds onto its lower half (docs/method.md,
    /// Sampling).
    pub harmonics: Vec<Vec<Vec<f64>>>,
    /// `[sensor][sample]`: the same at the sensor's sector.
    pub window: Vec<Vec<f64>>,
    /// `[revolution][nodal diameter]`: mechanical energy at its end, if asked for.
    pub energies: Vec<Vec<f64>>,
    /// Where the run ended because its motion repeats; what it left is then as if it had gone on for a whole window.
    pub repeated: Option<Repeated>,
    /// All modes at the end of the run.
    pub end: Vec<InitialMode>,
    /// All waves of an elastic casing then.
    pub casing_end: Vec<SteppedWave>,
    /// `[sector][contact node][component]`, one after the other: motion of the tips over the window.
    pub tips: Vec<TipMotion>,
    /// How far they went at once.
    pub excursion: Excursion,
    /// What was recorded of chosen revolutions, if any were.
    pub detail: Option<Box<DetailHistory>>,
    /// All modes at the samples of chosen revolutions, if they were asked for.
    pub states: Option<Box<ModalStates>>,
}

/// A response that left the bounds of the theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Divergence {
    /// Revolutions integrated until it was found.
    pub revolutions: f64,
    /// The tip that had moved most then; none where nothing can be touched, and numbers overflowed.
    pub tip: Option<TipDisplacement>,
    /// Mechanical energy then over that at the end of the last whole revolution; none in the first.
    pub energy_growth: Option<f64>,
}

/// How a simulation ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// All revolutions were integrated.
    Completed(History),
    /// A tip that a casing may touch moved by more than a tenth of the wheel's radius in any component, or a number
    /// overflowed. Without a casing the response is linear, and may be of any size.
    Diverged(Divergence),
    /// The contact problem of a step could not be solved.
    ContactFailed {
        /// Revolutions integrated until then.
        revolutions: f64,
        /// Why.
        error: ComplementarityError,
    },
    /// The caller asked to stop.
    Cancelled,
}

/// Outcome with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// How it ended.
    pub outcome: Outcome,
    /// What was counted.
    pub statistics: RunStatistics,
    /// The energy identity.
    pub energy: EnergyAudit,
    /// The coating at the end, if there is one.
    pub coating: Option<WornCoating>,
    /// Contact over the window, where there is a casing.
    pub contact: Option<ContactRecord>,
}

impl Run {
    /// Of a run whose window is the `period` of a motion that repeats: as if it had gone on for `revolutions` in all, the last `window` of
    /// them recorded. What was counted stays that of the revolutions that were taken.
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

/// A restriction table larger than this many values (2 GiB) is refused.
pub const MAX_TABLE_VALUES: usize = 1 << 28;
