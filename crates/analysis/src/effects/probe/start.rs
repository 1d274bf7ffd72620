//! A tiny asymmetry at the start of a run.

use faer::c64;

use super::request::Probe;
use crate::effects::symmetry::repeats::repeats;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::initial::{InitialMode, InitialWave};
use rubmap_wheel::dynamics::mistuning::normal_numbers;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;

/// Lowest mode of every nodal diameter that the symmetry of the scene keeps at rest, at a phase of its own.
pub(crate) fn asymmetry(
    request: &ResolvedSweep,
    wheel: &ModalWheel,
    casing: Option<&Casing>,
) -> Vec<InitialMode> {
    let Probe { amplitude, seed } = request.scene.probe.clone().unwrap_or_default();
    let repeats = repeats(&request.scene, wheel.sectors as u32) as usize;
    let mut modes = lowest_modes(wheel, amplitude * wheel_reach(casing), seed);
    modes.retain(|mode| !wheel.harmonics[mode.harmonic].harmonic.is_multiple_of(repeats));
    modes
}

/// Lowest mode of every nodal diameter, standing, at a phase of its own.
pub(crate) fn lowest_modes(wheel: &ModalWheel, amplitude: f64, seed: u64) -> Vec<InitialMode> {
    let phases = normal_numbers(seed).take(wheel.harmonics.len());
    let mode = |(index, phase): (usize, f64)| {
        let phase = c64::new(phase.cos(), phase.sin());
        InitialMode::of_amplitude(wheel, index, 0, amplitude, phase, InitialWave::Standing)
    };
    phases.enumerate().map(mode).collect()
}

/// Length that an asymmetry is small against: the smallest clearance, or the restriction where that is zero; 1 without a casing, where all motion is
/// linear.
pub(crate) fn wheel_reach(casing: Option<&Casing>) -> f64 {
    let Some(casing) = casing else { return 1.0 };
    let smallest = casing.clearance.iter().copied().fold(f64::INFINITY, f64::min);
    match &casing.restriction {
        Some(restriction) if smallest == 0.0 => restriction.largest(casing.clearance.len()),
        _ => smallest,
    }
}
