//! Energy audit of a run (docs/method.md, Energy).

use super::oscillators::Exchange;

/// Work of the effects of a scene, force·length; 0 for effects that the scene does not have.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EffectWork {
    /// Work of forces at engine orders and of the Euler force, on the wheel.
    pub excitation: f64,
    /// Work of mistuning: minus the change of the energy that the stiffness deviations store.
    pub mistuning: f64,
    /// Work of blades that stiffen: minus the change of their energy beyond the quadratic one, to second order of the step.
    pub stiffening: f64,
    /// Work of contact forces on the casing.
    pub casing: f64,
    /// Energy lost in the casing's damping.
    pub casing_loss: f64,
    /// Heat of friction: of tips that slide forwards the energy that the shaft supplies against the rotation, Σ μλ·rΩ·h; of a disc Σ τ·v h.
    /// The work of friction on the vibration is part of that of contact.
    pub friction_heat: f64,
}

/// Energy identity E^{q+½} − E^{q−½} = fᵀ(u_{q+1} − u_{q−1})/2 − loss, both sides summed over a run; E is the scheme's own energy
/// ([`super::schemes`]).
///
/// The identity holds to round-off in exact arithmetic of the scheme, so its residual is the cheapest proof that a
/// run was integrated, not merely finished.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyAudit {
    initial: f64,
    work: f64,
    loss: f64,
    largest_energy: f64,
    largest_residual: f64,
    last: f64,
    /// Energy of stiffening and its work when they were first compared, together, and their largest change since.
    stiffening: Option<(f64, f64)>,
    effects: EffectWork,
}

impl EnergyAudit {
    /// Audit of a run that starts with the mechanical energy `initial`.
    pub(crate) fn starting_at(initial: f64) -> Self {
        Self { initial, last: initial, largest_energy: initial.abs(), ..Self::default() }
    }

    /// Adds the work done on the wheel and the energy lost.
    #[inline(always)]
    pub(crate) fn add(&mut self, exchange: Exchange) {
        self.work += exchange.work;
        self.loss += exchange.loss;
    }

    /// Adds the work of contact forces on the casing and its loss.
    pub(crate) fn add_casing(&mut self, exchange: Exchange) {
        self.effects.casing += exchange.work;
        self.effects.casing_loss += exchange.loss;
    }

    /// Work of the effects, to be added to as it is done.
    pub(crate) fn effects_mut(&mut self) -> &mut EffectWork {
        &mut self.effects
    }

    /// Compares the mechanical energy with the sums so far.
    pub(crate) fn check(&mut self, energy: f64) {
        self.last = energy;
        self.largest_energy = larger(self.largest_energy, energy.abs());
        // The heat of friction comes from the shaft, or is part of the work of contact.
        let EffectWork { excitation, mistuning, stiffening, casing, casing_loss, friction_heat: _ } =
            self.effects;
        let effects = excitation + mistuning + stiffening + casing - casing_loss;
        let expected = self.initial + self.work - self.loss + effects;
        self.largest_residual = larger(self.largest_residual, (energy - expected).abs());
    }

    /// Compares the energy of blades that stiffen beyond the quadratic one with their work so far.
    pub(crate) fn check_stiffening(&mut self, energy: f64) {
        let total = energy + self.effects.stiffening;
        let (start, largest) = self.stiffening.get_or_insert((total, 0.0));
        *largest = larger(*largest, (total - *start).abs());
    }

    /// Largest difference between the energy that blades stored by stiffening and what they took for it, relative to the largest mechanical
    /// energy: of second order in the step; none without stiffening.
    pub fn stiffening_residual(&self) -> Option<f64> {
        let (_, largest) = self.stiffening?;
        Some(if self.largest_energy > 0.0 { largest / self.largest_energy } else { 0.0 })
    }

    /// Largest mechanical energy seen, force·length.
    pub fn largest_energy(&self) -> f64 {
        self.largest_energy
    }

    /// Mechanical energy at the start and when it was last compared, force·length.
    pub fn ends(&self) -> (f64, f64) {
        (self.initial, self.last)
    }

    /// Work of the contact forces on the wheel so far.
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Work of the effects so far, force·length.
    pub fn effects(&self) -> EffectWork {
        self.effects
    }

    /// Energy lost so far to damping, and to modes that follow statically, force·length.
    pub fn loss(&self) -> f64 {
        self.loss
    }

    /// Largest violation of the identity, relative to the largest energy seen; 0 for a wheel that never moved.
    pub fn residual(&self) -> f64 {
        if self.largest_energy > 0.0 { self.largest_residual / self.largest_energy } else { 0.0 }
    }
}

/// Larger of two numbers, and NaN if either is: a broken run must not look balanced.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b { a } else { b + 0.0 * a }
}
