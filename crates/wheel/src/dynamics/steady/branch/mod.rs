//! Branches: periodic responses followed while a number of their scene changes (docs/method.md, Branches).
//!
//! A branch is a curve of (x, p) with P_p(x) = x. It is followed by its arclength instead of by p, and so around folds (Seydel, Practical
//! Bifurcation and Stability Analysis, chapter 4): [`correct`] is Newton's method from beside the curve back to it, [`follow`] the steps
//! along it, [`locate`] finds points where it turns back or its stability changes.
//!
//! Modes depend on the speed. Vectors of one speed are carried to another by the [`Family`], as states are.

pub mod correct;
pub mod follow;
pub mod locate;

use crate::dynamics::initial::{Stepped, SteppedMode, SteppedWave};
use crate::dynamics::integrate::{Passage, PassageError, Simulation};

/// Family of scenes, one at any value of the number p that a branch is followed over. Steps per revolution are the same at all of them: the
/// map would jump with them.
pub trait Family {
    /// Calls `act` once with the return map of the scene at `value` that `lap` asks for.
    ///
    /// # Errors
    /// If there is no such map.
    fn with(&self, value: f64, lap: Lap, act: &mut dyn FnMut(&mut Passage<'_>)) -> Result<(), Unreachable>;

    /// Carries a motion, or a difference of two, of the scene at `from` over to the modes that it has at `to`.
    ///
    /// # Errors
    /// If there are no such modes.
    fn carry(&self, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Unreachable>;
}

/// Reason why there is no scene at a value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreachable(pub String);

impl From<PassageError> for Unreachable {
    fn from(error: PassageError) -> Self {
        Self(error.to_string())
    }
}

/// Time after which responses repeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lap {
    /// Shortest time that the symmetry of the scene allows, the sectors having changed their numbers.
    Symmetric,
    /// Time in which this number of lobes pass.
    Lobes(usize),
}

impl Lap {
    /// Return map of which such responses are fixed points.
    ///
    /// # Errors
    /// As of [`Passage::shortest`].
    pub fn passage<'a>(self, simulation: &Simulation<'a>) -> Result<Passage<'a>, PassageError> {
        match self {
            Self::Symmetric => Passage::about_half(simulation),
            Self::Lobes(count) => Passage::over_lobes(simulation, count),
        }
    }
}

/// Motion of the scene at a value, or per unit of arclength a direction there.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Value of p.
    pub value: f64,
    /// State at the beginning of a revolution.
    pub state: Stepped,
}

/// Reason why a branch was not found where it was sought.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Lost {
    /// Scene that cannot be run there.
    #[error("{0}")]
    Unreachable(#[from] Unreachable),
    /// Map that has no value there.
    #[error(transparent)]
    Passage(#[from] PassageError),
    /// Search by Newton's method that came no closer.
    #[error("the search came no closer than {residual:.1e}")]
    NotFound {
        /// Smallest residual ‖P(x) − x‖ / ‖x‖.
        residual: f64,
    },
    /// Response that was found, but in another direction.
    #[error("the next response that was found does not continue it")]
    Turned,
    /// Search that the caller stopped.
    #[error("cancelled")]
    Cancelled,
}

/// Branch to follow, and its measure.
#[derive(Clone, Copy)]
pub struct Branch<'a> {
    /// Scenes of the branch.
    pub family: &'a dyn Family,
    /// Time after which responses repeat.
    pub lap: Lap,
    /// Change of p that counts as much as a change of the motion by its own size.
    pub span: f64,
    /// Question whether to go on, asked now and then.
    pub go_on: &'a dyn Fn() -> bool,
}

impl Branch<'_> {
    /// Result of `act` on the return map at `value`.
    fn at<T>(&self, value: f64, act: impl FnOnce(&mut Passage<'_>) -> T) -> Result<T, Lost> {
        if !(self.go_on)() {
            return Err(Lost::Cancelled);
        }
        let (mut act, mut made) = (Some(act), None);
        self.family.with(value, self.lap, &mut |passage| made = act.take().map(|act| act(passage)))?;
        made.ok_or_else(|| Unreachable("there is no scene".to_owned()).into())
    }

    /// Motion or direction of the scene at `at`, in the modes at `to`.
    fn carried(&self, from: &Stepped, at: f64, to: f64) -> Result<Stepped, Lost> {
        Ok(if at == to { from.clone() } else { self.family.carry(from, at, to)? })
    }
}

/// Sum a + share · b, mode by mode and wave by wave.
fn add(a: &Stepped, b: &Stepped, share: f64) -> Stepped {
    let mut sum = a.clone();
    for more in &b.modes {
        let (displacement, increment) = (more.displacement * share, more.increment * share);
        match sum.modes.iter_mut().find(|mode| (mode.harmonic, mode.family) == (more.harmonic, more.family)) {
            Some(mode) => {
                mode.displacement += displacement;
                mode.increment += increment;
            }
            None => sum.modes.push(SteppedMode { displacement, increment, ..*more }),
        }
    }
    sum.casing.resize(sum.casing.len().max(b.casing.len()), SteppedWave::default());
    for (wave, more) in sum.casing.iter_mut().zip(&b.casing) {
        for part in 0..2 {
            wave.displacement[part] += share * more.displacement[part];
            wave.increment[part] += share * more.increment[part];
        }
    }
    sum
}
