//! Shift of the gaps by a casing or an axis that moves, and by clearances that change.

use super::super::clearance_change::ClearanceShift;
use super::super::clearance_drift::ClearanceDrift;
use super::super::flexible_casing::CasingMotion;
use super::super::orbit::OrbitShift;
use super::simulation::Simulation;

/// Shift of the gaps; each effect is absent unless the scene names it.
#[derive(Debug)]
pub(super) struct GapShift {
    pub(super) casing: Option<CasingMotion>,
    orbit: Option<OrbitShift>,
    change: Option<ClearanceShift>,
    drift: Option<ClearanceDrift>,
    /// Number of contact nodes of a sector, padded to whole vectors.
    stride: usize,
    /// Shift as it is now, `[sector][node]`.
    pub(super) now: Vec<f64>,
}

impl GapShift {
    /// Shift under the effects of a scene; none for a casing that stays where it is.
    pub(super) fn new(simulation: &Simulation<'_>, stride: usize) -> Option<Self> {
        let Simulation { wheel, effects, contact_nodes, scheme, .. } = *simulation;
        let (sectors, around) = (wheel.sectors, wheel.around());
        let casing = effects.flexible_casing.map(|casing| {
            CasingMotion::new(casing, scheme, simulation.step_s(), contact_nodes, sectors, around, stride)
        });
        let orbit = effects.orbit.map(|orbit| OrbitShift::new(orbit, contact_nodes, sectors, around, stride));
        let change =
            effects.clearance_change.map(|change| ClearanceShift::new(change, contact_nodes.len(), stride));
        let drift = effects.clearance_drift.cloned();
        let moves = casing.is_some() || orbit.is_some() || change.is_some() || drift.is_some();
        moves.then(|| Self { casing, orbit, change, drift, stride, now: vec![0.0; sectors * stride] })
    }

    /// Updates the shift to `revolutions` after the start, where orbit and drift have grown to a share `growth`.
    pub(super) fn move_to(&mut self, revolutions: f64, growth: f64) {
        let Self { casing, orbit, change, drift, stride, now } = self;
        now.fill(0.0);
        if let Some(orbit) = orbit {
            orbit.add(revolutions, growth, now);
        }
        if let Some(change) = change {
            change.add(revolutions, now);
        }
        if let Some(drift) = drift {
            drift.add(revolutions, growth, *stride, now);
        }
        if let Some(casing) = casing {
            casing.add(revolutions, now);
        }
    }
}
