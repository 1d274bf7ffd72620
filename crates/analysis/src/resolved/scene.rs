//! The scene with its alternatives told apart.

use crate::error::Violation;
use crate::request::{
    self, Abradable, CasingMode, Contact, Damping, EngineOrderExcitation, Friction, Initial, Lobes, Orbit,
    Probe, Ring, Symmetry,
};

/// Effects of one simulation; see [`request::Scene`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    pub(crate) centrifugal_stiffening: bool,
    pub(crate) damping: Option<Damping>,
    pub(crate) casing: Option<Casing>,
    pub(crate) contact: Option<Contact>,
    pub(crate) coriolis: bool,
    pub(crate) friction: Option<Friction>,
    pub(crate) abradable: Option<Abradable>,
    pub(crate) flexible_casing: Option<FlexibleCasing>,
    pub(crate) mistuning: Option<Mistuning>,
    pub(crate) engine_order_excitation: Vec<EngineOrderExcitation>,
    pub(crate) orbit: Option<Orbit>,
    pub(crate) initial: Option<Initial>,
    pub(crate) symmetry: Symmetry,
    pub(crate) probe: Option<Probe>,
}

/// Casing of revolution with an optional static restriction.
#[derive(Debug, Clone, PartialEq)]
pub struct Casing {
    pub(crate) clearance: Clearance,
    pub(crate) lobes: Option<Lobes>,
}

/// Clearance at rest, in the model's unit of length.
#[derive(Debug, Clone, PartialEq)]
pub enum Clearance {
    /// Linear in the arc length from contact node 0 to the last.
    AlongChord {
        /// At contact node 0.
        leading: f64,
        /// At the last contact node.
        trailing: f64,
    },
    /// One value per contact node.
    Each(Vec<f64>),
}

/// Elastic casing in the fixed frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FlexibleCasing {
    pub(crate) waves: WavesOf,
    pub(crate) damping_ratio: f64,
}

/// Where the waves of an elastic casing come from.
#[derive(Debug, Clone, PartialEq)]
pub enum WavesOf {
    /// In-plane bending of a ring, computed.
    Ring(Ring),
    /// As given.
    Modes(Vec<CasingMode>),
}

/// Relative stiffness deviations of the sectors.
#[derive(Debug, Clone, PartialEq)]
pub enum Mistuning {
    /// δ of every sector.
    Given(Vec<f64>),
    /// Normally distributed.
    Drawn {
        /// Standard deviation.
        spread: f64,
        /// The same seed gives the same wheel.
        seed: u64,
    },
}

impl Scene {
    /// The scene that is asked for. `refuse` hears of fields that together say too much or too little: a clearance that they would
    /// give is none then, an elastic casing or mistuning left away.
    pub(crate) fn of(asked: request::Scene, refuse: &mut dyn FnMut(Violation)) -> Self {
        Self {
            centrifugal_stiffening: asked.centrifugal_stiffening,
            damping: asked.damping,
            casing: asked.casing.map(|casing| Casing {
                clearance: Clearance::of(casing.clearance, refuse),
                lobes: casing.lobes,
            }),
            contact: asked.contact,
            coriolis: asked.coriolis,
            friction: asked.friction,
            abradable: asked.abradable,
            flexible_casing: asked.flexible_casing.and_then(|casing| FlexibleCasing::of(casing, refuse)),
            mistuning: asked.mistuning.and_then(|mistuning| Mistuning::of(mistuning, refuse)),
            engine_order_excitation: asked.engine_order_excitation,
            orbit: asked.orbit,
            initial: asked.initial,
            symmetry: asked.symmetry,
            probe: asked.probe,
        }
    }

    /// Lobes that pass the blades and may be touched.
    pub(crate) fn touched_lobes(&self) -> Option<&Lobes> {
        self.contact.as_ref()?;
        self.casing.as_ref()?.lobes.as_ref()
    }
}

impl Clearance {
    /// Where it is in a request.
    pub(crate) const AT: &str = "/scene/casing/clearance";

    fn of(asked: request::Clearance, refuse: &mut dyn FnMut(Violation)) -> Self {
        match asked {
            request::Clearance { leading: Some(leading), trailing: Some(trailing), values: None } => {
                Self::AlongChord { leading, trailing }
            }
            request::Clearance { leading: None, trailing: None, values: Some(values) } => Self::Each(values),
            request::Clearance { .. } => {
                refuse(Violation::new(
                    Self::AT,
                    "give either `leading` and `trailing`, or `values` with one clearance per contact node",
                ));
                Self::AlongChord { leading: 0.0, trailing: 0.0 }
            }
        }
    }

    /// The smallest number that was given.
    pub(crate) fn smallest(&self) -> f64 {
        match self {
            Self::AlongChord { leading, trailing } => leading.min(*trailing),
            Self::Each(values) => values.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }
}

impl FlexibleCasing {
    fn of(asked: request::FlexibleCasing, refuse: &mut dyn FnMut(Violation)) -> Option<Self> {
        let waves = match (asked.ring, asked.modes) {
            (Some(ring), None) => WavesOf::Ring(ring),
            (None, Some(modes)) => WavesOf::Modes(modes),
            _ => {
                refuse(Violation::new(
                    "/scene/flexible_casing",
                    "give either `ring`, whose modes are computed, or `modes`",
                ));
                return None;
            }
        };
        Some(Self { waves, damping_ratio: asked.damping_ratio })
    }
}

impl Mistuning {
    fn of(asked: request::Mistuning, refuse: &mut dyn FnMut(Violation)) -> Option<Self> {
        if asked.seed.is_some() && asked.spread.is_none() {
            refuse(Violation::new(
                "/scene/mistuning/seed",
                "a seed belongs to `spread`: given deviations need none",
            ));
        }
        match (asked.deviations, asked.spread) {
            (Some(deviations), None) => Some(Self::Given(deviations)),
            (None, Some(spread)) => Some(Self::Drawn { spread, seed: asked.seed.unwrap_or(0) }),
            _ => {
                refuse(Violation::new(
                    "/scene/mistuning",
                    "give either `deviations`, one per sector, or `spread` (with a `seed`)",
                ));
                None
            }
        }
    }
}

impl From<Scene> for request::Scene {
    fn from(scene: Scene) -> Self {
        Self {
            centrifugal_stiffening: scene.centrifugal_stiffening,
            damping: scene.damping,
            casing: scene
                .casing
                .map(|casing| request::Casing { clearance: casing.clearance.into(), lobes: casing.lobes }),
            contact: scene.contact,
            coriolis: scene.coriolis,
            friction: scene.friction,
            abradable: scene.abradable,
            flexible_casing: scene.flexible_casing.map(Into::into),
            mistuning: scene.mistuning.map(Into::into),
            engine_order_excitation: scene.engine_order_excitation,
            orbit: scene.orbit,
            initial: scene.initial,
            symmetry: scene.symmetry,
            probe: scene.probe,
        }
    }
}

impl From<Clearance> for request::Clearance {
    fn from(clearance: Clearance) -> Self {
        match clearance {
            Clearance::AlongChord { leading, trailing } => {
                Self { leading: Some(leading), trailing: Some(trailing), values: None }
            }
            Clearance::Each(values) => Self { leading: None, trailing: None, values: Some(values) },
        }
    }
}

impl From<FlexibleCasing> for request::FlexibleCasing {
    fn from(casing: FlexibleCasing) -> Self {
        let (ring, modes) = match casing.waves {
            WavesOf::Ring(ring) => (Some(ring), None),
            WavesOf::Modes(modes) => (None, Some(modes)),
        };
        Self { ring, modes, damping_ratio: casing.damping_ratio }
    }
}

impl From<Mistuning> for request::Mistuning {
    fn from(mistuning: Mistuning) -> Self {
        match mistuning {
            Mistuning::Given(deviations) => Self { deviations: Some(deviations), spread: None, seed: None },
            Mistuning::Drawn { spread, seed } => {
                Self { deviations: None, spread: Some(spread), seed: Some(seed) }
            }
        }
    }
}
