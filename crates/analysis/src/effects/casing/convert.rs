//! Casing in the terms of the physics.

use std::f64::consts::TAU;

use super::resolved::Clearance;
use crate::effects::clearance_change::convert::change;
use crate::model::ReducedSector;
use crate::not_runnable::NotRunnable;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::casing::{
    Casing, Part, Profile, Restriction, RestrictionTable, clearance_along_chord,
};
use rubmap_wheel::dynamics::integrate::MAX_TABLE_VALUES;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Casing of a scene with contact, with these clearances; a casing that nothing touches does not exist for the integration.
///
/// Casings that press into the tips grow with the shape: the run begins with the gap closed.
pub(crate) fn casing(
    reduced: &ReducedWheel,
    request: &ResolvedSweep,
    mut clearance: Vec<f64>,
    ramp_revolutions: f64,
) -> Option<Casing> {
    let casing = request.scene.casing.as_ref()?;
    let (positions, normals) = places(&reduced.contact);
    let mut restriction = casing.shape.restriction(&positions, &normals);
    if clearance.iter().any(|&clearance| clearance < 0.0) {
        let pressed = clearance.iter().map(|clearance| (-clearance).max(0.0)).collect();
        let everywhere = Profile::Wave { order: 0, amplitude: 1.0, phase_rad: 0.0 };
        let part = Part { profile: everywhere, along_chord: Some(pressed) };
        restriction.get_or_insert(Restriction { parts: Vec::new() }).parts.push(part);
        clearance.iter_mut().for_each(|clearance| *clearance = clearance.max(0.0));
    }
    Some(Casing { clearance, restriction, ramp_revolutions })
}

/// Clearance of every contact node of a scene with contact at a speed, as a run begins: as it is given, less the growth of the tips where
/// it is given cold.
pub(crate) fn running_clearance(
    sector: &ReducedSector,
    request: &ResolvedSweep,
    speed_rad_s: f64,
) -> Result<Option<Vec<f64>>, NotRunnable> {
    let Some(mut clearance) = clearance_given(&sector.wheel.contact, request) else { return Ok(None) };
    if request.has_cold_clearances() {
        let growth = sector.growth.as_ref().ok_or(NotRunnable::UnreadGrowth)?;
        let growth = growth.at(speed_rad_s, request.scene.centrifugal_stiffening);
        clearance.iter_mut().zip(growth).for_each(|(clearance, growth)| *clearance -= growth);
    }
    Ok(Some(clearance))
}

/// Clearance of every contact node over the window: that of [`running_clearance`], with what a change of clearances leaves of it; none where nothing
/// could run.
pub(crate) fn lasting_clearance(
    sector: &ReducedSector,
    request: &ResolvedSweep,
    speed_rad_s: f64,
) -> Option<Vec<f64>> {
    let mut clearance = running_clearance(sector, request, speed_rad_s).ok().flatten()?;
    if let Some(change) = change(&request.scene) {
        clearance.iter_mut().enumerate().for_each(|(node, clearance)| *clearance += change.lasting(node));
    }
    Some(clearance)
}

/// Clearance of every contact node of a scene with contact, as it is given.
pub(crate) fn clearance_given(contact_nodes: &[ContactNode], request: &ResolvedSweep) -> Option<Vec<f64>> {
    request.scene.contact.as_ref()?;
    clearances(request, &places(contact_nodes).0)
}

/// Positions and normals of contact nodes.
fn places(contact_nodes: &[ContactNode]) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    contact_nodes.iter().map(|node| (node.position, node.normal)).unzip()
}

/// Number of angles at which heights are reported.
const ANGLES: u32 = 720;

/// Heights of the casing before contact nodes at these positions `[r, θ, z]` in the order of the chord, with these normals, `[node][angle]`
/// at 720 equal angles from the package's x axis on; `None` if the scene has no casing or a circular one.
pub fn heights(
    request: &ResolvedSweep,
    positions: &[[f64; 3]],
    normals: &[[f64; 3]],
) -> Option<Vec<Vec<f64>>> {
    let restriction = request.scene.casing.as_ref()?.shape.restriction(positions, normals)?;
    Some((0..positions.len()).map(|node| around(&restriction, node)).collect())
}

/// Heights of the casing before a contact node.
fn around(restriction: &Restriction, node: usize) -> Vec<f64> {
    (0..ANGLES).map(|i| restriction.height(TAU * f64::from(i) / f64::from(ANGLES), node)).collect()
}

/// Heights of the casing before one of the contact nodes, as in [`heights`]; empty where there are none.
pub(crate) fn heights_before(
    contact_nodes: &[ContactNode],
    node: usize,
    request: &ResolvedSweep,
) -> Vec<f64> {
    let (positions, normals) = places(contact_nodes);
    let casing = request.scene.casing.as_ref();
    let restriction = casing.and_then(|casing| casing.shape.restriction(&positions, &normals));
    restriction.map_or(Vec::new(), |restriction| around(&restriction, node))
}

/// Clearances as they are given of contact nodes at these positions `[r, θ, z]`, in the order of the chord; `None` if the scene has no casing.
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
    casing: Option<&Casing>,
    steps_per_revolution: usize,
) -> Result<(), NotRunnable> {
    let stride = reduced.contact.len().next_multiple_of(8);
    let (steps, sectors) = (steps_per_revolution, reduced.sectors);
    let size = RestrictionTable::size(steps, sectors, stride);
    if size <= MAX_TABLE_VALUES || casing.is_none_or(|casing| casing.restriction.is_none()) {
        return Ok(());
    }
    Err(NotRunnable::Table { size, steps, sectors })
}
