//! The flow of a scene over the shortest time after which it looks the same, as a map of the wheel's state.
//!
//! Seen from a wheel of N sectors a casing of m lobes looks the same after 1/lcm(m, N) of a revolution, but for the number of each
//! sector: where sector s is then, sector s + b was. A motion with the symmetry of the scene comes back to itself under
//!
//! ```text
//! P(x) = T_b⁻¹ flow(x),   (T_b u)_s = u_{s+b}:   z_i → e^{jibα} z_i,   1/lcm(m, N) = b/N modulo 1/m
//! ```
//!
//! and one without it under the flow over one lobe, or some. The unknowns are ωz and d/h of every mode that remembers, real and
//! imaginary parts: their squares are twice the energies.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

use num_integer::lcm;
use pulp::{Simd, WithSimd};

use super::run::{Divergence, Outcome};
use super::simulation::Simulation;
use super::stepper::Stepper;
use super::trace::Trace;
#[cfg(test)]
use crate::dynamics::casing::RestrictionTable;
use crate::dynamics::initial::InitialMode;
use rubmap_numerics::complementarity::ComplementarityError;

/// Why a scene has no such map, or a state no image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PassageError {
    /// What moves the wheel or is moved by it has a state of its own, or does not repeat with the lobes.
    #[error("the scene has effects beyond damping and a rigid casing")]
    Effects,
    /// Steps do not divide it.
    #[error("{steps} steps per revolution are no multiple of {parts}")]
    Steps {
        /// Per revolution.
        steps: usize,
        /// Into which the revolution falls.
        parts: usize,
    },
    /// The flow left the bounds of the theory.
    #[error("the motion leaves the bounds of linear theory")]
    Diverged(Divergence),
    /// The contact problem of a step could not be solved.
    #[error("contact: {0}")]
    Contact(ComplementarityError),
}

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

/// The map, with all that its evaluation needs.
#[derive(Debug)]
pub struct Passage<'a> {
    simulation: Simulation<'a>,
    stepper: Stepper,
    unknowns: Vec<Unknown>,
    /// Where each is in the oscillators' state.
    places: Vec<usize>,
    steps: usize,
    turn: usize,
    trace: Trace,
    taken: AtomicUsize,
}

impl<'a> Passage<'a> {
    /// Of the scene of `simulation`, its restriction fully grown; over the shortest time its symmetry allows.
    ///
    /// # Errors
    /// [`PassageError::Effects`] and [`PassageError::Steps`].
    pub fn shortest(simulation: &Simulation<'a>) -> Result<Self, PassageError> {
        let around = simulation.wheel.around();
        let lobes = lobes(simulation).unwrap_or(around);
        let parts = lcm(lobes, around);
        // (b/N − 1/parts) m is a whole number.
        let fits = |&b: &usize| (b * (parts / around) + parts - 1).is_multiple_of(parts / lobes);
        let turn = (0..around).find(fits).unwrap_or(0);
        Self::new(simulation, parts, turn)
    }

    /// The same over `count` lobes, every sector keeping its number.
    ///
    /// # Errors
    /// As of [`Self::shortest`].
    pub fn over_lobes(simulation: &Simulation<'a>, count: usize) -> Result<Self, PassageError> {
        let lobes = lobes(simulation).unwrap_or(1);
        Ok(Self::new(simulation, lobes, 0)?.repeated(count))
    }

    /// `times` of it, one after the other.
    #[must_use]
    pub fn repeated(self, times: usize) -> Self {
        let sectors = self.simulation.wheel.sectors;
        Self { steps: times * self.steps, turn: (times * self.turn) % sectors, ..self }
    }

    fn new(simulation: &Simulation<'a>, parts: usize, turn: usize) -> Result<Self, PassageError> {
        let simulation = Simulation {
            initial: &[],
            sensors: &[],
            samples_per_revolution: 1,
            revolutions: 1,
            window_revolutions: 0,
            repeats: None,
            detail: None,
            states: None,
            ..*simulation
        };
        let steps = simulation.steps_per_revolution;
        if !steps.is_multiple_of(parts) {
            return Err(PassageError::Steps { steps, parts });
        }
        let stepper = Stepper::new(&simulation);
        if !stepper.is_plain() {
            return Err(PassageError::Effects);
        }
        let (mut unknowns, mut places) = (Vec::new(), Vec::new());
        for (harmonic, modes) in simulation.wheel.harmonics.iter().enumerate() {
            for family in 0..simulation.scheme.integrated_modes(modes.omega.len()) {
                let omega = modes.omega[family];
                if !remembers(&simulation, omega, family) {
                    continue;
                }
                let scale = if omega > 0.0 { omega } else { simulation.step_s().recip() };
                for (part, place) in stepper.oscillators().places(harmonic, family).enumerate() {
                    unknowns.push(Unknown { harmonic, family, imaginary: part == 1, scale });
                    places.push(place);
                }
            }
        }
        Ok(Self {
            simulation,
            stepper,
            unknowns,
            places,
            steps: steps / parts,
            turn,
            trace: Trace::default(),
            taken: AtomicUsize::new(0),
        })
    }

    /// The same against a restriction of any shape instead of the casing's lobes.
    #[cfg(test)]
    pub(in crate::dynamics) fn against(mut self, restriction: RestrictionTable) -> Self {
        self.stepper.replace_restriction(restriction);
        self
    }

    /// Lobes that pass in a revolution; 1 where there are none.
    pub fn lobes(&self) -> usize {
        lobes(&self.simulation).unwrap_or(1)
    }

    /// Numbers of a state.
    pub fn size(&self) -> usize {
        2 * self.unknowns.len()
    }

    /// What they are: ωz of all, then d/h of all.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// What is integrated.
    pub fn simulation(&self) -> &Simulation<'a> {
        &self.simulation
    }

    /// h, s.
    pub fn step_s(&self) -> f64 {
        self.simulation.step_s()
    }

    /// Steps that it takes.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// How often it was taken up to now, by states or, linearised, by what disturbs them.
    pub fn taken(&self) -> usize {
        self.taken.load(Ordering::Relaxed)
    }

    /// The same in revolutions of the wheel.
    pub fn revolutions(&self) -> f64 {
        (self.taken() * self.steps) as f64 / self.simulation.steps_per_revolution as f64
    }

    pub(in crate::dynamics) fn take(&self, times: usize) {
        self.taken.fetch_add(times, Ordering::Relaxed);
    }

    /// What touched on the way of the last state that was mapped.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// The state of these modes, all others being at rest.
    pub fn state(&self, modes: &[InitialMode]) -> Vec<f64> {
        let Simulation { wheel, scheme, damping, .. } = self.simulation;
        let (n, step) = (self.unknowns.len(), self.simulation.step_s());
        let mut state = vec![0.0; 2 * n];
        for (i, unknown) in self.unknowns.iter().enumerate() {
            let here =
                |mode: &&InitialMode| (mode.harmonic, mode.family) == (unknown.harmonic, unknown.family);
            let Some(mode) = modes.iter().find(here) else { continue };
            let part = |value: faer::c64| if unknown.imaginary { value.im } else { value.re };
            let omega = wheel.harmonics[unknown.harmonic].omega[unknown.family];
            let zeta = damping.map_or(0.0, |damping| damping.ratio(unknown.family));
            let (z, v) = (part(mode.displacement), part(mode.velocity));
            state[i] = unknown.scale * z;
            state[n + i] = scheme.first_increment(omega, zeta, step, z, v) / step;
        }
        state
    }

    /// The modes of a state: what a run starts from that goes on where it is, at the beginning of a revolution.
    pub fn modes(&self, state: &[f64]) -> Vec<InitialMode> {
        let Simulation { wheel, scheme, damping, casing, .. } = self.simulation;
        let (n, step) = (self.unknowns.len(), self.simulation.step_s());
        let mut modes: Vec<InitialMode> = Vec::new();
        for (i, unknown) in self.unknowns.iter().enumerate() {
            let omega = wheel.harmonics[unknown.harmonic].omega[unknown.family];
            let zeta = damping.map_or(0.0, |damping| damping.ratio(unknown.family));
            let (z, d) = (state[i] / unknown.scale, state[n + i] * step);
            let v = scheme.velocity(omega, zeta, step, z, d, casing.is_some());
            match modes.last_mut() {
                Some(mode) if unknown.imaginary => {
                    mode.displacement.im = z;
                    mode.velocity.im = v;
                }
                _ => modes.push(InitialMode {
                    harmonic: unknown.harmonic,
                    family: unknown.family,
                    displacement: faer::c64::new(z, 0.0),
                    velocity: faer::c64::new(v, 0.0),
                }),
            }
        }
        modes
    }

    /// P of a state.
    ///
    /// # Errors
    /// [`PassageError::Diverged`] and [`PassageError::Contact`].
    pub fn map(&mut self, state: &[f64]) -> Result<Vec<f64>, PassageError> {
        let (n, step) = (self.unknowns.len(), self.simulation.step_s());
        let (z, d) = self.stepper.oscillators_mut().state_mut();
        z.fill(0.0);
        d.fill(0.0);
        for (i, (&place, unknown)) in self.places.iter().zip(&self.unknowns).enumerate() {
            z[place] = state[i] / unknown.scale;
            d[place] = state[n + i] * step;
        }
        self.trace.clear();
        self.take(1);
        let flow = Flow { passage: self };
        pulp::Arch::new().dispatch(flow).map_err(|ended| match *ended {
            Outcome::ContactFailed { error, .. } => PassageError::Contact(error),
            Outcome::Diverged(divergence) => PassageError::Diverged(divergence),
            Outcome::Completed(_) | Outcome::Cancelled => unreachable!("a passage has no end of its own"),
        })?;
        let (z, d) = self.stepper.oscillators_mut().state_mut();
        let mut image = vec![0.0; 2 * n];
        for (i, (&place, unknown)) in self.places.iter().zip(&self.unknowns).enumerate() {
            image[i] = z[place] * unknown.scale;
            image[n + i] = d[place] / step;
        }
        self.renumber(&mut image);
        Ok(image)
    }

    /// T_b⁻¹, of a state or a part of one that is kept alike.
    pub fn renumber(&self, state: &mut [f64]) {
        if self.turn == 0 {
            return;
        }
        let sectors = self.simulation.wheel.sectors;
        for half in state.chunks_exact_mut(self.unknowns.len()) {
            for (i, unknown) in self.unknowns.iter().enumerate() {
                let angle = TAU * ((unknown.harmonic * self.turn) % sectors) as f64 / sectors as f64;
                let pair = self.unknowns.get(i + 1).is_some_and(|next| next.imaginary);
                if unknown.imaginary {
                    continue;
                }
                if pair {
                    let (re, im) = (half[i], half[i + 1]);
                    let (sin, cos) = angle.sin_cos();
                    (half[i], half[i + 1]) = (re * cos + im * sin, im * cos - re * sin);
                } else if angle > 0.0 {
                    half[i] = -half[i];
                }
            }
        }
    }
}

/// Lobes of the casing; none where it is circular, or absent.
fn lobes(simulation: &Simulation<'_>) -> Option<usize> {
    simulation.casing?.restriction.map(|restriction| restriction.count.max(1) as usize)
}

/// Whether where a mode goes depends on where it was: one that follows statically forgets it within a step.
fn remembers(simulation: &Simulation<'_>, omega: f64, family: usize) -> bool {
    let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(family));
    let step = simulation.scheme.mode_step(omega, zeta, simulation.step_s(), simulation.casing.is_some());
    step.keep != 0.0 || step.receptance * omega * omega != 1.0
}

/// The steps as a value, compiled for the widest vectors of the machine.
struct Flow<'a, 'b> {
    passage: &'a mut Passage<'b>,
}

impl WithSimd for Flow<'_, '_> {
    type Output = Result<(), Box<Outcome>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Passage { simulation, stepper, steps, trace, .. } = self.passage;
        let grown = simulation.casing.map_or(0.0, |casing| casing.ramp_revolutions).ceil() as usize;
        stepper.flow(simd, (grown, *steps), simulation, trace)
    }
}
