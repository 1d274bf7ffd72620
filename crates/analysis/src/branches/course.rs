//! How far branches have been followed: all that the next leg needs, to the bit.

use serde::{Deserialize, Serialize};

use super::told::Told;
use crate::result::{Bifurcation, FloquetMultiplier, Stability, Track};
use faer::c64;
use rubmap_wheel::dynamics::initial::{Stepped, SteppedMode, SteppedWave};
use rubmap_wheel::dynamics::steady::branch::Motion;
use rubmap_wheel::dynamics::steady::branch::follow::Front;

/// How far branches have been followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// The stretch under way.
    pub(super) under_way: UnderWay,
    /// Those that have still to be begun, the next one last.
    pub(super) waiting: Vec<Stretch>,
    /// Branches so far.
    pub(super) branches: u32,
}

/// A branch away from where it begins, to one side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Stretch {
    pub(super) track: Track,
    /// Passages over a lobe after which its motions repeat; none of those that repeat as their scene does.
    pub(super) passages: Option<u32>,
    pub(super) backwards: bool,
    pub(super) front: KeptFront,
    /// Whether where it begins is a point of it.
    pub(super) tells_start: bool,
}

impl Stretch {
    /// Whether both are of doubled periods, and of the same branch.
    pub(super) fn doubles_as(&self, other: &Self) -> bool {
        let doubled = |stretch: &Self| stretch.track.doubles.map(|(branch, _)| branch);
        doubled(self).is_some() && doubled(self) == doubled(other)
    }

    /// Where it begins.
    pub(super) fn start(&self) -> Motion {
        (&self.front.last).into()
    }
}

/// A stretch that was begun.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct UnderWay {
    pub(super) stretch: Stretch,
    /// Points that it has.
    pub(super) points: u32,
    /// What was told of the last one, and of the one before.
    pub(super) last: Option<KeptTold>,
    pub(super) before: Option<KeptTold>,
    /// A multiplier passed 1 before the last point: of a fold, if the branch turns back at the next.
    pub(super) pending: Option<Bifurcation>,
}

impl UnderWay {
    /// Nothing of it is done.
    pub(super) fn new(stretch: Stretch) -> Self {
        Self { stretch, points: 0, last: None, before: None, pending: None }
    }
}

/// [`Told`], to be kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptTold {
    stability: Stability,
    multipliers: Vec<FloquetMultiplier>,
    lobe_passages: u32,
    passages: u32,
    half_peak_to_peak: Vec<f64>,
    disturbances: KeptState,
    leading: KeptState,
}

/// [`Stepped`], to be kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptState {
    /// Nodal diameter and family, displacement and increment.
    modes: Vec<(u32, u32, [f64; 4])>,
    /// Displacement and increment.
    casing: Vec<[[f64; 2]; 2]>,
}

/// [`Front`], to be kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptFront {
    last: KeptMotion,
    before: Option<KeptMotion>,
    first: KeptMotion,
    step: f64,
}

/// [`Motion`], to be kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptMotion {
    value: f64,
    state: KeptState,
}

impl From<&Stepped> for KeptState {
    fn from(state: &Stepped) -> Self {
        let mode = |mode: &SteppedMode| {
            let SteppedMode { harmonic, family, displacement: z, increment: d } = *mode;
            (harmonic as u32, family as u32, [z.re, z.im, d.re, d.im])
        };
        let casing = state.casing.iter().map(|wave| [wave.displacement, wave.increment]);
        Self { modes: state.modes.iter().map(mode).collect(), casing: casing.collect() }
    }
}

impl From<&KeptState> for Stepped {
    fn from(kept: &KeptState) -> Self {
        let mode = |&(harmonic, family, [a, b, c, d]): &(u32, u32, [f64; 4])| SteppedMode {
            harmonic: harmonic as usize,
            family: family as usize,
            displacement: c64::new(a, b),
            increment: c64::new(c, d),
        };
        let wave = |&[displacement, increment]: &[[f64; 2]; 2]| SteppedWave { displacement, increment };
        Self { modes: kept.modes.iter().map(mode).collect(), casing: kept.casing.iter().map(wave).collect() }
    }
}

impl From<&Motion> for KeptMotion {
    fn from(motion: &Motion) -> Self {
        Self { value: motion.value, state: (&motion.state).into() }
    }
}

impl From<&KeptMotion> for Motion {
    fn from(kept: &KeptMotion) -> Self {
        Self { value: kept.value, state: (&kept.state).into() }
    }
}

impl From<&Told> for KeptTold {
    fn from(told: &Told) -> Self {
        Self {
            stability: told.stability,
            multipliers: told.multipliers.clone(),
            lobe_passages: told.lobe_passages,
            passages: told.passages,
            half_peak_to_peak: told.half_peak_to_peak.clone(),
            disturbances: (&told.disturbances).into(),
            leading: (&told.leading).into(),
        }
    }
}

impl From<&KeptTold> for Told {
    fn from(kept: &KeptTold) -> Self {
        Self {
            stability: kept.stability,
            multipliers: kept.multipliers.clone(),
            disturbances: (&kept.disturbances).into(),
            leading: (&kept.leading).into(),
            lobe_passages: kept.lobe_passages,
            passages: kept.passages,
            half_peak_to_peak: kept.half_peak_to_peak.clone(),
            revolutions: 0.0,
        }
    }
}

impl From<&Front> for KeptFront {
    fn from(front: &Front) -> Self {
        Self {
            last: (&front.last).into(),
            before: front.before.as_ref().map(Into::into),
            first: (&front.first).into(),
            step: front.step,
        }
    }
}

impl From<&KeptFront> for Front {
    fn from(kept: &KeptFront) -> Self {
        Self {
            last: (&kept.last).into(),
            before: kept.before.as_ref().map(Into::into),
            first: (&kept.first).into(),
            step: kept.step,
        }
    }
}
