//! Unknowns that make up the state of a [`Passage`](super::Passage).

use super::simulation::Simulation;
use super::stepper::Stepper;
use crate::dynamics::flexible_casing::CasingMotion;

/// Unknown of the wheel: one number of the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// Index of the nodal diameter among the wheel's.
    pub harmonic: usize,
    /// Mode within the nodal diameter.
    pub family: usize,
    /// Whether the unknown belongs to the imaginary part of a pair.
    pub imaginary: bool,
    /// Factor of z: ω, or 1/h of a mode without frequency.
    pub scale: f64,
}

/// Unknown of an elastic casing: one number of the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CasingUnknown {
    /// Index of the wave.
    pub wave: usize,
    /// Nodal diameter n of the wave.
    pub nodal_diameter: usize,
    /// Whether the unknown belongs to the sine; n = 0 has none.
    pub sine: bool,
    /// Factor of z, as of [`Unknown`].
    pub scale: f64,
}

/// Unknowns of all modes that remember, each with its index in the oscillators' state.
pub(super) fn unknowns(simulation: &Simulation<'_>, stepper: &Stepper) -> Vec<(Unknown, usize)> {
    let mut unknowns = Vec::new();
    for (harmonic, modes) in simulation.wheel.harmonics.iter().enumerate() {
        for family in 0..simulation.scheme.integrated_modes(modes.omega.len()) {
            let omega = modes.omega[family];
            if !remembers(simulation, omega, (harmonic, family)) {
                continue;
            }
            let scale = if omega > 0.0 { omega } else { simulation.step_s().recip() };
            for (part, place) in stepper.oscillators().places(harmonic, family).enumerate() {
                unknowns.push((Unknown { harmonic, family, imaginary: part == 1, scale }, place));
            }
        }
    }
    unknowns
}

/// Unknowns of an elastic casing, in the order of the state.
pub(super) fn casing_unknowns(stepper: &Stepper, step: f64) -> Vec<CasingUnknown> {
    let mut unknowns = Vec::new();
    let waves = stepper.flexible_casing().into_iter().flat_map(CasingMotion::linear_waves);
    for (wave, of) in waves.enumerate() {
        let scale = if of.stiffness > 0.0 { of.stiffness.sqrt() } else { step.recip() };
        let nodal_diameter = of.nodal_diameter;
        let sines = if nodal_diameter == 0 { &[false][..] } else { &[false, true] };
        unknowns.extend(sines.iter().map(|&sine| CasingUnknown { wave, nodal_diameter, sine, scale }));
    }
    unknowns
}

/// Whether a mode remembers: its motion depends on where it was. A mode that follows statically forgets this within a step, unless it
/// follows itself or others that remember.
fn remembers(simulation: &Simulation<'_>, omega: f64, (harmonic, rank): (usize, usize)) -> bool {
    if simulation.effects.mistuning.is_some() || simulation.wheel.turns() {
        return true;
    }
    let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(harmonic, rank));
    let step = simulation.scheme.mode_step(omega, zeta, simulation.step_s(), simulation.casing.is_some());
    step.keep != 0.0 || step.receptance * omega * omega != 1.0
}
