//! The casing in the terms of the physics.

use super::resolved::Clearance;
use super::shape::Shape;
use crate::not_runnable::NotRunnable;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::casing::{Casing, RestrictionTable, clearance_along_chord};
use rubmap_wheel::dynamics::integrate::MAX_TABLE_VALUES;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::sector::ContactNode;

/// The casing of a scene with contact; a casing that nothing touches does not exist for the integration.
pub(crate) fn casing(
    reduced: &ReducedWheel,
    request: &ResolvedSweep,
    ramp_revolutions: f64,
) -> Option<Casing> {
    let clearance = clearance(&reduced.contact, request)?;
    let casing = request.scene.casing.as_ref()?;
    let restriction = casing.shape.restriction(&reduced.contact);
    Some(Casing { clearance, restriction, ramp_revolutions })
}

/// c of every contact node of a scene with contact.
pub(crate) fn clearance(contact_nodes: &[ContactNode], request: &ResolvedSweep) -> Option<Vec<f64>> {
    request.scene.contact.as_ref()?;
    let positions: Vec<_> = contact_nodes.iter().map(|node| node.position).collect();
    clearances(request, &positions)
}

/// Clearances at rest of contact nodes at these positions `[r, θ, z]`, in the order of the chord; `None` if the scene has no casing.
pub fn clearances(request: &ResolvedSweep, positions: &[[f64; 3]]) -> Option<Vec<f64>> {
    request.scene.casing.as_ref().map(|casing| along(&casing.clearance, positions))
}

fn along(clearance: &Clearance, positions: &[[f64; 3]]) -> Vec<f64> {
    match clearance {
        Clearance::Each(values) => values.clone(),
        Clearance::AlongChord { leading, trailing } => clearance_along_chord(*leading, *trailing, positions),
    }
}

/// Whether the casing's heights can be tabulated; the error says what to change.
pub(crate) fn check_table(
    reduced: &ReducedWheel,
    request: &ResolvedSweep,
    steps_per_revolution: usize,
) -> Result<(), NotRunnable> {
    let stride = reduced.contact.len().next_multiple_of(8);
    let (steps, sectors) = (steps_per_revolution, reduced.sectors);
    let size = RestrictionTable::size(steps, sectors, stride);
    if size <= MAX_TABLE_VALUES || request.scene.touched_shape().and_then(Shape::repeats).is_none() {
        return Ok(());
    }
    Err(NotRunnable::Table { size, steps, sectors })
}
