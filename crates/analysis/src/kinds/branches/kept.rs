//! Motions and results at points in a form that is stored, to the bit.

use serde::{Deserialize, Serialize};

use super::told::{Amplitudes, Told};
use crate::result::{FloquetMultiplier, Stability};
use faer::c64;
use rubmap_wheel::dynamics::initial::{Stepped, SteppedMode, SteppedWave};
use rubmap_wheel::dynamics::steady::branch::Motion;
use rubmap_wheel::dynamics::steady::branch::follow::Front;

/// Stored form of [`Told`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptTold {
    stability: Stability,
    multipliers: Vec<FloquetMultiplier>,
    lobe_passages: u32,
    passages: u32,
    amplitudes: Amplitudes,
    disturbances: KeptState,
    leading: KeptState,
}

/// Stored form of [`Stepped`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptState {
    /// Modes: nodal diameter, family, and displacement and increment, each as real and imaginary parts.
    modes: Vec<(u32, u32, [f64; 4])>,
    /// Casing waves: displacement and increment.
    casing: Vec<[[f64; 2]; 2]>,
}

/// Stored form of [`Front`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptFront {
    pub(super) last: KeptMotion,
    pub(super) before: Option<KeptMotion>,
    first: KeptMotion,
    step: f64,
}

/// Stored form of [`Motion`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptMotion {
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
            amplitudes: told.amplitudes.clone(),
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
            amplitudes: kept.amplitudes.clone(),
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
