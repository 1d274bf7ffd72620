//! Casing, its alternatives resolved.

use super::request::{self, ClearanceState};
use super::shape::Shape;
use crate::effects::asked::Asked;
use crate::error::Violation;

/// Casing of revolution, and what stands inward of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Casing {
    pub(crate) clearance: Clearance,
    pub(crate) given: ClearanceState,
    pub(crate) shape: Shape,
}

/// Clearance, in the model's unit of length.
#[derive(Debug, Clone, PartialEq)]
pub enum Clearance {
    /// Linear in the arc length from contact node 0 to the last.
    AlongChord {
        /// Clearance at contact node 0.
        leading: f64,
        /// Clearance at the last contact node.
        trailing: f64,
    },
    /// Clearances, one per contact node.
    Each(Vec<f64>),
}

impl Asked for Option<request::Casing> {
    type Resolved = Option<Casing>;

    fn resolve(self, refuse: &mut dyn FnMut(Violation)) -> Option<Casing> {
        let asked = self?;
        let shape = Shape::of(&asked);
        let given = asked.clearance.given;
        Some(Casing { clearance: Clearance::of(asked.clearance, refuse), given, shape })
    }

    fn of(resolved: Option<Casing>) -> Self {
        resolved.map(|Casing { clearance, given, shape }| {
            let Shape { lobes, single_lobes, waves, measured, tilt } = shape;
            request::Casing { clearance: clearance.given(given), lobes, single_lobes, waves, measured, tilt }
        })
    }
}

impl Casing {
    /// Whether the casing may be pressed into tips.
    pub(crate) fn may_press(&self) -> bool {
        self.given == ClearanceState::Cold || self.clearance.smallest() < 0.0
    }
}

impl Clearance {
    fn of(asked: request::Clearance, refuse: &mut dyn FnMut(Violation)) -> Self {
        match asked {
            request::Clearance { leading: Some(leading), trailing: Some(trailing), values: None, .. } => {
                Self::AlongChord { leading, trailing }
            }
            request::Clearance { leading: None, trailing: None, values: Some(values), .. } => {
                Self::Each(values)
            }
            request::Clearance { .. } => {
                refuse(Violation::new(
                    "/scene/casing/clearance",
                    "give either `leading` and `trailing`, or `values` with one clearance per contact node",
                ));
                Self::AlongChord { leading: 0.0, trailing: 0.0 }
            }
        }
    }

    /// Clearance as it is asked for, in that state of the wheel.
    fn given(self, given: ClearanceState) -> request::Clearance {
        let (leading, trailing, values) = match self {
            Self::AlongChord { leading, trailing } => (Some(leading), Some(trailing), None),
            Self::Each(values) => (None, None, Some(values)),
        };
        request::Clearance { leading, trailing, values, given }
    }

    /// Smallest clearance that was given.
    pub(crate) fn smallest(&self) -> f64 {
        match self {
            Self::AlongChord { leading, trailing } => leading.min(*trailing),
            Self::Each(values) => values.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }
}
