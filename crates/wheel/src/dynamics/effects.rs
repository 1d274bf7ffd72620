//! Effects beyond damping and contact with a rigid casing. An effect that is absent is no part of the run.

use super::bending::Bending;
use super::clearance_change::ClearanceChange;
use super::clearance_drift::ClearanceDrift;
use super::contact::coating::Coating;
use super::direction::Direction;
use super::euler::EulerForce;
use super::excitation::EngineOrderExcitation;
use super::flexible_casing::FlexibleCasing;
use super::orbit::Orbit;

/// Effects of a simulation. Coriolis forces are the wheel's own: they act where it has gyroscopic matrices.
#[derive(Debug, Clone, Copy, Default)]
pub struct Effects<'a> {
    /// Coulomb friction at the contact.
    pub friction: Option<Friction<'a>>,
    /// Abradable coating of the casing.
    pub coating: Option<&'a Coating>,
    /// Elastic casing.
    pub flexible_casing: Option<&'a FlexibleCasing>,
    /// Eccentric casing or whirling shaft.
    pub orbit: Option<Orbit>,
    /// Clearances that change over the run.
    pub clearance_change: Option<&'a ClearanceChange>,
    /// Clearances that follow the speed.
    pub clearance_drift: Option<&'a ClearanceDrift>,
    /// Relative stiffness deviation of every sector.
    pub mistuning: Option<&'a [f64]>,
    /// Blades that bend far.
    pub bending: Option<Bending<'a>>,
    /// Forces at engine orders.
    pub excitation: &'a [EngineOrderExcitation],
    /// Euler force of a speed that changes; on the vibration where the wheel has gyroscopic matrices.
    pub euler_force: Option<&'a EulerForce>,
    /// Whether the energy of every nodal diameter is recorded, revolution by revolution.
    pub energies: bool,
}

/// Coulomb friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction<'a> {
    /// Friction coefficient μ.
    pub coefficient: f64,
    /// Law by which friction acts.
    pub law: FrictionLaw,
    /// Directions that contact forces act against.
    pub directions: &'a [Direction],
}

/// Law by which friction acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictionLaw {
    /// Friction on tips that slide forwards ([`super::contact::friction`]): directions are n + μt of every contact node.
    Sliding,
    /// Friction on tips that stick, or slide in any direction ([`super::contact::disc`]): directions are n, t and n × t of every contact
    /// node. Not with a coating, nor with a boundary without mass.
    Disc,
}

impl<'a> Effects<'a> {
    /// Friction of tips that slide forwards, if the scene has that law.
    pub(crate) fn sliding(&self) -> Option<Friction<'a>> {
        self.friction.filter(|friction| friction.law == FrictionLaw::Sliding)
    }

    /// Bending of blades that stiffen, if the scene has it.
    pub(crate) fn stiffening(&self) -> Option<Bending<'a>> {
        self.bending.filter(|bending| bending.stiffens)
    }

    /// Whether forces act that are known beforehand: excitation or the Euler force.
    pub(crate) fn forces_are_known(&self) -> bool {
        !self.excitation.is_empty() || self.euler_force.is_some()
    }
}
