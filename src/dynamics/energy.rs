//! The energy audit (§8).

use super::oscillators::Exchange;

/// Both sides of E^{q+½} − E^{q−½} = fᵀ(u_{q+1} − u_{q−1})/2 − loss, summed over a run; E is the
/// scheme's own energy ([`super::schemes`]).
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
}

impl EnergyAudit {
    /// Of a run that starts with the mechanical energy `initial`.
    pub(crate) fn starting_at(initial: f64) -> Self {
        Self { initial, largest_energy: initial.abs(), ..Self::default() }
    }

    /// Adds what the energy gained and lost.
    #[inline(always)]
    pub(crate) fn add(&mut self, exchange: Exchange) {
        self.work += exchange.work;
        self.loss += exchange.loss;
    }

    /// Compares the mechanical energy with the sums so far.
    pub(crate) fn check(&mut self, energy: f64) {
        self.largest_energy = larger(self.largest_energy, energy.abs());
        self.largest_residual =
            larger(self.largest_residual, (energy - (self.initial + self.work - self.loss)).abs());
    }

    /// Largest mechanical energy seen, force·length.
    pub fn largest_energy(&self) -> f64 {
        self.largest_energy
    }

    /// Energy lost so far to damping, and to modes that follow statically.
    pub fn loss(&self) -> f64 {
        self.loss
    }

    /// Largest violation of the identity, relative to the largest energy seen; 0 for a wheel that never moved.
    pub fn residual(&self) -> f64 {
        if self.largest_energy > 0.0 { self.largest_residual / self.largest_energy } else { 0.0 }
    }
}

/// The larger of two numbers, and NaN if either is: a broken run must not look balanced.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b { a } else { b + 0.0 * a }
}
