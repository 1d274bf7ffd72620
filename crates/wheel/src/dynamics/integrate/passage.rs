//! Return map of a scene: its flow over the shortest time after which it looks the same, as a map of the wheel's state.
//!
//! Seen from a wheel of N sectors a casing of m lobes looks the same after 1/lcm(m, N) of a revolution, but for the number of each
//! sector: where sector s is then, sector s + b was. A motion with the symmetry of the scene comes back to itself under
//!
//! ```text
//! P(x) = T_b⁻¹ flow(x),   (T_b u)_s = u_{s+b}:   z_i → e^{jibα} z_i,   1/lcm(m, N) = b/N modulo 1/m
//! ```
//!
//! and one without it under the flow over one lobe, or some. The times that effects leave are in [`recurrence`](super::recurrence). The
//! unknowns are ωz and d/h of every mode that remembers, real and imaginary parts, and of the waves of an elastic casing in the fixed
//! frame: their squares are twice the energies.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

use faer::{Mat, c64};

use super::passage_error::PassageError;
use super::recurrence::{Recurrence, Recurrences};
use super::run::Outcome;
use super::simulation::Simulation;
use super::step_range::StepRange;
use super::stepper::Stepper;
use super::trace::Trace;
use super::unknowns::{CasingUnknown, Unknown, casing_unknowns, unknowns};
#[cfg(test)]
use crate::dynamics::casing::RestrictionTable;
use crate::dynamics::flexible_casing::CasingMotion;
use crate::dynamics::initial::{InitialMode, Stepped, SteppedMode, SteppedWave};

/// Return map of a scene, with all that its evaluation needs.
#[derive(Debug)]
pub struct Passage<'a> {
    simulation: Simulation<'a>,
    stepper: Stepper,
    unknowns: Vec<Unknown>,
    casing: Vec<CasingUnknown>,
    /// Index of each unknown in the oscillators' state.
    places: Vec<usize>,
    of: Recurrence,
    /// Number of maps over a lobe until the scene is the same again.
    lobes: usize,
    /// Steps until the scene is the same again.
    whole: usize,
    /// Revolution with which the map begins.
    grown: usize,
    trace: Trace,
    taken: AtomicUsize,
}

impl<'a> Passage<'a> {
    /// Return map of the scene of `simulation`, all that grows fully grown; over the shortest time its symmetry and its steps allow.
    ///
    /// # Errors
    /// [`PassageError::Coating`], [`PassageError::ClearanceChange`], [`PassageError::Disc`] and [`PassageError::Orbit`].
    pub fn shortest(simulation: &Simulation<'a>) -> Result<Self, PassageError> {
        let recurrences = Recurrences::of(simulation)?;
        Ok(Self::new(simulation, &recurrences, recurrences.shortest()))
    }

    /// Return map over `count` lobes, every sector keeping its number; over `count` times as many revolutions as the whole scene needs to
    /// come round where there are no lobes, or effects tell them apart.
    ///
    /// # Errors
    /// As of [`Self::shortest`].
    pub fn over_lobes(simulation: &Simulation<'a>, count: usize) -> Result<Self, PassageError> {
        let recurrences = Recurrences::of(simulation)?;
        Ok(Self::new(simulation, &recurrences, recurrences.lobe()).repeated(count))
    }

    /// Return map over about half a revolution, so often that some make a whole: short ones look back over too little, long ones are few.
    ///
    /// # Errors
    /// As of [`Self::shortest`].
    pub fn about_half(simulation: &Simulation<'a>) -> Result<Self, PassageError> {
        let passage = Self::shortest(simulation)?;
        let (steps, parts) = (passage.steps(), passage.whole() / passage.steps());
        let fits = |times: &usize| {
            parts.is_multiple_of(*times) && 2 * times * steps <= simulation.steps_per_revolution
        };
        let times = (1..=parts).rev().find(fits).unwrap_or(1);
        Ok(passage.repeated(times))
    }

    /// Repeats the map `times` times, one after the other.
    #[must_use]
    pub fn repeated(self, times: usize) -> Self {
        let sectors = self.simulation.wheel.sectors;
        let Recurrence { steps, turn } = self.of;
        Self { of: Recurrence { steps: times * steps, turn: (times * turn) % sectors }, ..self }
    }

    fn new(simulation: &Simulation<'a>, recurrences: &Recurrences<'_>, of: Recurrence) -> Self {
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
        let stepper = Stepper::new(&simulation);
        let (unknowns, places) = unknowns(&simulation, &stepper).into_iter().unzip();
        let whole = recurrences.whole().steps;
        Self {
            grown: simulation.grown().next_multiple_of(recurrences.revolutions()),
            lobes: whole / recurrences.lobe().steps,
            whole,
            simulation,
            casing: casing_unknowns(&stepper, simulation.step_s()),
            stepper,
            unknowns,
            places,
            of,
            trace: Trace::default(),
            taken: AtomicUsize::new(0),
        }
    }

    /// Map against a restriction of any shape instead of the casing's lobes.
    #[cfg(test)]
    pub(in crate::dynamics) fn against(mut self, restriction: RestrictionTable) -> Self {
        self.stepper.replace_restriction(restriction);
        self
    }

    /// Number of maps over a lobe ([`Self::over_lobes`]) until the scene is the same again, sectors with their numbers.
    pub fn lobes(&self) -> usize {
        self.lobes
    }

    /// Lobes of the casing that pass during the map; revolutions where it has none.
    pub fn lobes_passed(&self) -> usize {
        let restriction = self.simulation.casing.and_then(|casing| casing.restriction.as_ref());
        let lobes = restriction.map_or(1, |restriction| restriction.repeats().max(1) as usize);
        lobes * self.of.steps / self.simulation.steps_per_revolution
    }

    /// Revolution with which the map begins, when all has grown.
    pub fn grown(&self) -> usize {
        self.grown
    }

    /// Steps until the scene is the same again, sectors with their numbers: whole revolutions.
    pub fn whole(&self) -> usize {
        self.whole
    }

    /// Number of unknowns of a state.
    pub fn size(&self) -> usize {
        2 * (self.unknowns.len() + self.casing.len())
    }

    /// Unknowns of the wheel. A state has ωz of all unknowns, those of the casing last, then d/h of all.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// Unknowns of the casing, which come last among ωz and among d/h of a state.
    pub fn casing_unknowns(&self) -> &[CasingUnknown] {
        &self.casing
    }

    /// Factors of z of all unknowns.
    pub fn scales(&self) -> impl Iterator<Item = f64> {
        self.unknowns.iter().map(|of| of.scale).chain(self.casing.iter().map(|of| of.scale))
    }

    pub(in crate::dynamics) fn flexible_casing(&self) -> Option<&CasingMotion> {
        self.stepper.flexible_casing()
    }

    /// Simulation that is integrated.
    pub fn simulation(&self) -> &Simulation<'a> {
        &self.simulation
    }

    /// Step h, s.
    pub fn step_s(&self) -> f64 {
        self.simulation.step_s()
    }

    /// Number of steps of the map.
    pub fn steps(&self) -> usize {
        self.of.steps
    }

    /// Number of maps taken up to now, of states or, linearised, of their disturbances.
    pub fn taken(&self) -> usize {
        self.taken.load(Ordering::Relaxed)
    }

    /// Revolutions of the wheel that the maps taken up to now amount to.
    pub fn revolutions(&self) -> f64 {
        (self.taken() * self.of.steps) as f64 / self.simulation.steps_per_revolution as f64
    }

    pub(in crate::dynamics) fn take(&self, times: usize) {
        self.taken.fetch_add(times, Ordering::Relaxed);
    }

    /// Trace of the contact on the way of the last state that was mapped.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Stiffness −∂f/∂z of mistuning between the Fourier columns of every family that it couples.
    pub(in crate::dynamics) fn mistuned(&self) -> Vec<Mat<f64>> {
        self.stepper.mistuned()
    }

    /// State with these modes and these waves of the casing, all others being at rest, as a run that begins with them has it.
    pub fn state(&mut self, modes: &[InitialMode], casing: &[SteppedWave]) -> Vec<f64> {
        let Simulation { wheel, scheme, damping, .. } = self.simulation;
        let (step, follow) = (self.simulation.step_s(), self.simulation.casing.is_some());
        let mut stepped: Vec<SteppedMode> = Vec::new();
        for &InitialMode { harmonic, family, displacement, velocity } in modes {
            let omega = wheel.harmonics[harmonic].omega[family];
            let zeta = damping.map_or(0.0, |damping| damping.ratio(harmonic, family));
            let increment = |z: f64, v: f64| scheme.first_increment(omega, zeta, step, z, v, follow);
            let increment =
                c64::new(increment(displacement.re, velocity.re), increment(displacement.im, velocity.im));
            stepped.push(SteppedMode { harmonic, family, displacement, increment });
        }
        self.stepper.go_on_from(&Stepped { modes: stepped, casing: casing.to_vec() });
        self.stepper.drive_from(&self.simulation, modes, self.grown as f64);
        self.read()
    }

    /// State as a motion from which a run goes on at the beginning of a revolution.
    pub fn stepped(&self, state: &[f64]) -> Stepped {
        let (n, step) = (self.size() / 2, self.simulation.step_s());
        let mut stepped = Stepped::default();
        let numbers = self.scales().zip(state).zip(&state[n..]).map(|((scale, x), y)| (x / scale, y * step));
        let mut wheel: Vec<_> = numbers.collect();
        let casing = wheel.split_off(self.unknowns.len());
        for (unknown, (z, d)) in self.unknowns.iter().zip(wheel) {
            match stepped.modes.last_mut() {
                Some(mode) if unknown.imaginary => (mode.displacement.im, mode.increment.im) = (z, d),
                _ => stepped.modes.push(SteppedMode {
                    harmonic: unknown.harmonic,
                    family: unknown.family,
                    displacement: c64::new(z, 0.0),
                    increment: c64::new(d, 0.0),
                }),
            }
        }
        for (unknown, (z, d)) in self.casing.iter().zip(casing) {
            if !unknown.sine {
                stepped.casing.push(SteppedWave::default());
            }
            let part = usize::from(unknown.sine);
            if let Some(wave) = stepped.casing.last_mut() {
                (wave.displacement[part], wave.increment[part]) = (z, d);
            }
        }
        stepped
    }

    /// State of a motion under way; parts of it that are not among the unknowns are dropped.
    pub fn state_of(&mut self, stepped: &Stepped) -> Vec<f64> {
        self.stepper.go_on_from(stepped);
        self.read()
    }

    /// Image P of a state.
    ///
    /// # Errors
    /// [`PassageError::Diverged`] and [`PassageError::Contact`].
    pub fn map(&mut self, state: &[f64]) -> Result<Vec<f64>, PassageError> {
        self.write(state);
        self.trace.clear();
        self.take(1);
        let range = StepRange {
            revolution: self.grown,
            before: 0,
            steps: self.of.steps,
            per_revolution: self.simulation.steps_per_revolution,
        };
        self.stepper.flow(range, &mut self.trace).map_err(|ended| match *ended {
            Outcome::ContactFailed { error, .. } => PassageError::Contact(error),
            Outcome::Diverged(divergence) => PassageError::Diverged(divergence),
            Outcome::Completed(_) | Outcome::Cancelled => unreachable!("a passage has no end of its own"),
        })?;
        let mut image = self.read();
        self.renumber(&mut image);
        Ok(image)
    }

    /// Sets the oscillators to `state`.
    fn write(&mut self, state: &[f64]) {
        let stepped = self.stepped(state);
        self.stepper.go_on_from(&stepped);
    }

    fn read(&self) -> Vec<f64> {
        let step = self.simulation.step_s();
        let (z, d) = self.stepper.oscillators().state();
        let waves = self.stepper.flexible_casing().map(CasingMotion::stepped).unwrap_or_default();
        let part = |unknown: &CasingUnknown| (waves[unknown.wave], usize::from(unknown.sine));
        let casing = self.casing.iter().map(|of| (part(of), of.scale));
        let wheel = self.places.iter().zip(&self.unknowns);
        let displacements = wheel
            .map(|(&at, of)| z[at] * of.scale)
            .chain(casing.clone().map(|((wave, part), scale)| wave.displacement[part] * scale));
        let increments = self
            .places
            .iter()
            .map(|&at| d[at] / step)
            .chain(casing.map(|((wave, part), _)| wave.increment[part] / step));
        displacements.chain(increments).collect()
    }

    /// Renumbers the sectors by T_b⁻¹ in a state, or in parts with the same layout.
    pub fn renumber(&self, state: &mut [f64]) {
        let sectors = self.simulation.wheel.sectors;
        for half in state.chunks_exact_mut(self.size() / 2) {
            self.turn_casing(half, |n| {
                // n (t − b/N) of a revolution, whole ones left out before anything is rounded.
                let (per, around) = (self.simulation.steps_per_revolution, self.simulation.wheel.around());
                let moved = (self.of.steps * around) as i128 - (self.of.turn * per) as i128;
                let whole = (per * around) as i128;
                (n as i128 * moved).rem_euclid(whole) as f64 / whole as f64
            });
            if self.of.turn == 0 {
                continue;
            }
            for (i, unknown) in self.unknowns.iter().enumerate() {
                let angle = TAU * ((unknown.harmonic * self.of.turn) % sectors) as f64 / sectors as f64;
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

    /// Turns the casing's part of z or d against +θ by `revolutions` of every nodal diameter n: (c, s) as seen from there.
    pub(in crate::dynamics) fn turn_casing(&self, half: &mut [f64], revolutions: impl Fn(usize) -> f64) {
        let casing = &mut half[self.unknowns.len()..];
        for (i, unknown) in self.casing.iter().enumerate().filter(|(_, unknown)| unknown.sine) {
            let (sin, cos) = (TAU * revolutions(unknown.nodal_diameter)).sin_cos();
            let (c, s) = (casing[i - 1], casing[i]);
            (casing[i - 1], casing[i]) = (c * cos + s * sin, s * cos - c * sin);
        }
    }
}
