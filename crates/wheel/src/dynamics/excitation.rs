//! Forces at engine orders, felt by blades that turn through a steady field of k periods.
//!
//! ```text
//! f_s(t) = A cos(k(sα + Ωt) + ψ)      on given contact nodes and directions of every sector
//! ```
//!
//! Such a force drives the nodal diameter |k − N·round(k/N)| alone (aliasing), as one travelling wave, so its modal forces turn at kΩ and only
//! that is left to the step loop. It grows over the ramp like the restriction. A boundary without mass feels it through the modes it keeps only.

use std::f64::consts::TAU;

use faer::c64;

use super::casing::ramp;
use super::direction::Direction;
use super::modal_wheel::ModalWheel;
use super::oscillators::ModalDamping;

/// Force at one engine order.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineOrderExcitation {
    /// Engine order k.
    pub order: u32,
    /// Contact nodes and directions of the force; each gets the whole amplitude.
    pub directions: Vec<Direction>,
    /// Amplitude A, force.
    pub amplitude: f64,
    /// Phase ψ, rad.
    pub phase_rad: f64,
    /// Revolutions over which the force grows.
    pub ramp_revolutions: f64,
}

/// Largest displacements along `to` that the steady response to `excitations` can have, without contact, mistuning or Coriolis forces:
/// the amplitudes z = f/(ω² − (kΩ)² ± 2jζωkΩ) of all orders added up.
pub fn steady_amplitudes(
    wheel: &ModalWheel,
    excitations: &[EngineOrderExcitation],
    damping: Option<&ModalDamping>,
    to: &[Direction],
) -> Vec<f64> {
    let mut amplitudes = vec![0.0; to.len()];
    for excitation in excitations {
        let force = ModalExcitation::new(excitation, wheel);
        let modes = &wheel.harmonics[force.harmonic];
        let frequency = force.order * wheel.speed_rad_s;
        let moved = |(family, &omega): (usize, &f64)| {
            let lag = 2.0
                * damping.map_or(0.0, |damping| damping.ratio(force.harmonic, family))
                * omega
                * frequency;
            let lag = if force.backwards { -lag } else { lag };
            force.amplitude[family] / c64::new(omega * omega - frequency * frequency, lag)
        };
        let z: Vec<c64> = modes.omega.iter().enumerate().map(moved).collect();
        let waves = if modes.single { 1.0 } else { 2.0 };
        let weight = (waves / wheel.sectors as f64).sqrt();
        for (amplitude, direction) in amplitudes.iter_mut().zip(to) {
            let at = |(m, z): (usize, &c64)| direction.of(modes.contact.as_ref(), m) * z;
            *amplitude += weight * z.iter().enumerate().map(at).sum::<c64>().norm();
        }
    }
    amplitudes
}

/// Modal forces of an engine order.
#[derive(Debug)]
pub(crate) struct ModalExcitation {
    /// Index of the nodal diameter among the wheel's harmonics.
    pub(crate) harmonic: usize,
    /// Force of every mode at kΩt = 0, turned by e^{+jkΩt} or, `backwards`, by e^{−jkΩt}; of a single harmonic the real
    /// part counts.
    pub(crate) amplitude: Vec<c64>,
    backwards: bool,
    order: f64,
    ramp_revolutions: f64,
}

impl ModalExcitation {
    pub(crate) fn new(excitation: &EngineOrderExcitation, wheel: &ModalWheel) -> Self {
        let around = wheel.around();
        let alias = excitation.order as usize % around;
        let (diameter, backwards) = if 2 * alias > around { (around - alias, true) } else { (alias, false) };
        let harmonic = diameter / wheel.repeats;
        let modes = &wheel.harmonics[harmonic];
        // f̂ = w Σ_s f_s e^{−jisα}: of a pair only one of the two halves of the cosine adds up.
        let sectors = wheel.sectors as f64;
        let weight = if modes.single { sectors.sqrt() } else { (0.5 * sectors).sqrt() };
        let (sin, cos) = excitation.phase_rad.sin_cos();
        let phase = c64::new(cos, if backwards { -sin } else { sin }) * (weight * excitation.amplitude);
        let along = |m: usize| {
            excitation.directions.iter().map(|d| d.of(modes.contact.as_ref(), m)).sum::<c64>().conj() * phase
        };
        Self {
            harmonic,
            amplitude: (0..modes.omega.len()).map(along).collect(),
            backwards,
            order: f64::from(excitation.order),
            ramp_revolutions: excitation.ramp_revolutions,
        }
    }

    /// Factor of the amplitudes after `revolutions`.
    pub(crate) fn turn(&self, revolutions: f64) -> c64 {
        let growth = ramp(revolutions, self.ramp_revolutions);
        let (sin, cos) = (TAU * (self.order * revolutions.fract()).fract()).sin_cos();
        c64::new(growth * cos, if self.backwards { -growth * sin } else { growth * sin })
    }
}
