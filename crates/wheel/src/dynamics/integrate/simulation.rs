//! Simulation of the wheel: what is integrated, and what is recorded of it.

use std::f64::consts::TAU;

use crate::dynamics::casing::Casing;
use crate::dynamics::clearance_change::ClearanceChange;
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::Effects;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::modal_wheel::ModalWheel;
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::oscillators::driven::Drive;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

use super::revolutions::{Repeats, Revolutions};

/// Simulation of the wheel at its speed.
#[derive(Debug, Clone, Copy)]
pub struct Simulation<'a> {
    /// Wheel in modal coordinates.
    pub wheel: &'a ModalWheel,
    /// Contact nodes from leading to trailing edge.
    pub contact_nodes: &'a [ContactNode],
    /// Modal damping; absent: none.
    pub damping: Option<&'a ModalDamping>,
    /// Casing that the blades may touch; absent: none.
    pub casing: Option<&'a Casing>,
    /// Effects beyond damping and a rigid casing.
    pub effects: Effects<'a>,
    /// Modes that move at the start; empty: from rest.
    pub initial: &'a [InitialMode],
    /// Displacements to be recorded.
    pub sensors: &'a [SensorRow],
    /// Scheme of time integration.
    pub scheme: Scheme,
    /// Number S of steps per revolution, at least the scheme's smallest stable number.
    pub steps_per_revolution: usize,
    /// Number of recorded samples per revolution, a divisor of S.
    pub samples_per_revolution: usize,
    /// Number of revolutions to simulate, at most.
    pub revolutions: usize,
    /// Condition on which fewer revolutions are taken; absent: all are taken.
    pub repeats: Option<Repeats>,
    /// Number of revolutions at the end for which nodal-diameter coordinates are recorded.
    pub window_revolutions: usize,
    /// Details to record of chosen revolutions.
    pub detail: Option<Detail>,
    /// Revolutions of which all modes are recorded, at every sample.
    pub states: Option<Revolutions>,
}

/// Choice of the details that a run records of chosen revolutions, at every sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Detail {
    /// Revolutions to record.
    pub revolutions: Revolutions,
    /// Whether velocities of the sensors are recorded.
    pub velocity: bool,
    /// Whether the number of nodes in contact and the length of contact are recorded.
    pub contact: bool,
    /// Whether the force on every contact node of every blade is recorded.
    pub forces: bool,
    /// Whether the energy audit is recorded.
    pub energy: bool,
}

/// Recorded displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorRow {
    /// Contact node and direction of the displacement.
    pub direction: Direction,
    /// Sector of the displacement.
    pub sector: usize,
}

impl Simulation<'_> {
    /// Displacement of a tip beyond which a run ends as diverged; without bound where all tips lie on the axis.
    pub(super) fn reach(&self) -> f64 {
        let radius = self.contact_nodes.iter().fold(0.0f64, |r, node| r.max(node.position[0]));
        if radius > 0.0 { DIVERGED_SHARE_OF_RADIUS * radius } else { f64::INFINITY }
    }

    /// Revolutions after which nothing grows any more.
    pub(super) fn grown(&self) -> usize {
        let excitations = self.effects.excitation.iter().map(|excitation| excitation.ramp_revolutions);
        let ramps = excitations.chain(self.casing.map(|casing| casing.ramp_revolutions));
        let ramps = ramps.chain(self.effects.clearance_change.map(ClearanceChange::ends_after));
        ramps.fold(0.0, f64::max).ceil() as usize
    }

    /// Whether modes that are too fast for the step follow statically in part of a run: where anything acts on them.
    pub(super) fn fast_modes_follow(&self) -> bool {
        self.casing.is_some() || Drive::acts(self.wheel, &self.effects)
    }

    pub(super) fn step_s(&self) -> f64 {
        TAU / (self.wheel.speed_rad_s * self.steps_per_revolution as f64)
    }
}

/// Share of the largest contact radius beyond which a displacement ends a run as diverged: linear structural theory is void long before.
pub const DIVERGED_SHARE_OF_RADIUS: f64 = 0.1;
