//! The numbers that the state over a [`Passage`](super::Passage) is made of.

use super::simulation::Simulation;
use super::stepper::Stepper;
use crate::dynamics::flexible_casing::CasingMotion;

/// One number of the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// Index of the nodal diameter among the wheel's.
    pub harmonic: usize,
    /// Mode within it.
    pub family: usize,
    /// Whether it is of the imaginary part of a pair.
    pub imaginary: bool,
    /// What z is multiplied by: ω, or 1/h of a mode without frequency.
    pub scale: f64,
}

/// One number of the state of an elastic casing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CasingUnknown {
    /// Which of its waves.
    pub wave: usize,
    /// n.
    pub nodal_diameter: usize,
    /// Whether it is of the sine; that of n = 0 is none.
    pub sine: bool,
    /// What z is multiplied by, as of [`Unknown`].
    pub scale: f64,
}

/// z and d of all modes that remember, each with its place in the oscillators' state.
pub(super) fn unknowns(simulation: &Simulation<'_>, stepper: &Stepper) -> Vec<(Unknown, usize)> {
    let mut unknowns = Vec::new();
    for (harmonic, modes) in simulation.wheel.harmonics.iter().enumerate() {
        for family in 0..simulation.scheme.integrated_modes(modes.omega.len()) {
            let omega = modes.omega[family];
            if !remembers(simulation, omega, family) {
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

/// z and d of an elastic casing, as they are in the state.
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

/// Whether where a mode goes depends on where it was: one that follows statically forgets it within a step, unless it follows itself or others
/// that remember.
fn remembers(simulation: &Simulation<'_>, omega: f64, family: usize) -> bool {
    if simulation.effects.mistuning.is_some() || simulation.wheel.turns() {
        return true;
    }
    let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(family));
    let step = simulation.scheme.mode_step(omega, zeta, simulation.step_s(), simulation.casing.is_some());
    step.keep != 0.0 || step.receptance * omega * omega != 1.0
}
