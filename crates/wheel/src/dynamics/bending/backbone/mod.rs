//! Backbone curves: frequency of free, undamped vibration of the wheel without contact over its amplitude (docs/method.md, Backbone curves).
//!
//! In a wave of nodal diameter i that travels, or stands where the nodal diameter is single, all sectors do the same at shifted times. One of them
//! is enough, α = 2π/N:
//!
//! ```text
//! p_s(t) = Re Σ_h P_h e^{jh(ωt + isα)}       P_h = R_k (Λ_k − h²ω²)⁻¹ R_kᴴ F_h,   k = h·i mod N,   f = −∂V/∂p − d/dt ∂T/∂ṗ + ∂T/∂p
//! ```
//!
//! F_h are the harmonics of f. Harmonic h moves the modes of nodal diameter k; where k is above N/2 those of N − k, with conjugate rows.
//! With the weights w_i of a modal wheel w_i² is 2/N or 1/N, and the sum over the sectors N/2 or N, so that their product is 1. Of the mode of the
//! curve the amplitude a is given, P_1 = R_t a + …, and its equation gives the frequency: ω² = ω_t² − Re(R_tᴴ F_1)/a.
//! The imaginary part of that equation holds by itself: no energy is lost. Coriolis forces are left out.

mod balance;
mod end;
mod free_wheel;

use std::ops::RangeInclusive;

use balance::{Balance, Series};
pub use end::{BackboneEnd, Resonance};
pub use free_wheel::{FreeMode, FreeModes, FreeWheel};

/// Numbers of harmonics with which a curve is begun, and which it may reach; every frequency is held against that of twice as many.
const HARMONICS: RangeInclusive<usize> = 4..=16;

/// Change of the frequency by twice as many harmonics, relative, above which twice as many are taken.
const TRUNCATION: f64 = 1e-6;

/// Truncation, relative, above which a curve ends.
const UNRESOLVED: f64 = 1e-3;

/// Number of steps to the largest amplitude, unless shorter ones are needed.
const STEPS: f64 = 32.0;

/// Share of a step below which a curve is not followed any further.
const SHORTEST: f64 = 1.0 / 128.0;

/// Frequency over amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct Backbone {
    /// Row of [`FreeModes::contact`] that moves most in the linear mode, whose displacement by the mode is the amplitude.
    pub row: usize,
    /// Points in ascending amplitude, from 0 on.
    pub points: Vec<BackbonePoint>,
    /// Resonances between modes that the curve went past from one point to the next.
    pub passed: Vec<Resonance>,
    /// Reason for its end.
    pub end: BackboneEnd,
}

/// Point of a backbone curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BackbonePoint {
    /// Amplitude: displacement of [`Backbone::row`] by the mode of the curve in the first harmonic.
    pub amplitude: f64,
    /// Angular frequency ω, rad/s.
    pub omega: f64,
    /// Change of the frequency, relative, by the second half of the harmonics.
    pub truncation: f64,
    /// Number of harmonics.
    pub harmonics: usize,
}

impl FreeWheel<'_> {
    /// Backbone curve of `mode` up to the amplitude `largest`, or to where it cannot be followed.
    pub fn backbone(&self, mode: FreeMode, largest: f64) -> Backbone {
        let contact = self.modes[mode.nodal_diameter].contact.col(mode.rank);
        let sizes = contact.iter().map(|entry| entry.norm()).enumerate();
        let (row, size) = sizes.fold((0, 0.0), |most, each| if each.1 > most.1 { each } else { most });
        let linear = self.modes[mode.nodal_diameter].omega[mode.rank];
        let harmonics = *HARMONICS.start();
        let rest = BackbonePoint { amplitude: 0.0, omega: linear, truncation: 0.0, harmonics };
        let mut curve =
            Backbone { row, points: vec![rest], passed: Vec::new(), end: BackboneEnd::LargestAmplitude };
        if size == 0.0 {
            curve.end = BackboneEnd::StillContact;
            return curve;
        }
        let whole = largest / size / STEPS;
        let mut follower = Follower::new(self, mode);
        let mut step = whole;
        // The last step may end a round-off short of the largest amplitude.
        while follower.amplitude < whole * (STEPS - 1e-9) {
            let next = (follower.amplitude + step).min(whole * STEPS);
            match follower.reach(next) {
                Ok(found) => {
                    curve.points.push(BackbonePoint { amplitude: next * size, ..found });
                    curve.passed.extend(follower.passed());
                    step = whole.min(2.0 * step);
                }
                Err(_) if step > whole * SHORTEST => step *= 0.5,
                Err(failure) => {
                    curve.end = failure;
                    break;
                }
            }
        }
        curve
    }
}

/// March along a curve.
struct Follower<'a> {
    balance: Balance<'a>,
    harmonics: usize,
    /// Amplitude a of the last point.
    amplitude: f64,
    /// Motions at the last point and at that before.
    last: Series,
    before: Option<(f64, Series)>,
}

impl<'a> Follower<'a> {
    fn new(wheel: &'a FreeWheel<'a>, mode: FreeMode) -> Self {
        let balance = Balance::new(wheel, mode);
        let harmonics = *HARMONICS.start();
        let last = balance.at_rest(harmonics);
        Self { balance, harmonics, amplitude: 0.0, last, before: None }
    }

    /// Goes on to an amplitude; stays where it is on failure.
    fn reach(&mut self, amplitude: f64) -> Result<BackbonePoint, BackboneEnd> {
        let guess = match &self.before {
            None => self.balance.linear(self.harmonics, amplitude),
            Some((before, motion)) => {
                let share = (amplitude - self.amplitude) / (self.amplitude - before);
                self.last.extrapolated(motion, share)
            }
        };
        let mut harmonics = self.harmonics;
        let mut coarse = self.solved(guess.of(harmonics), amplitude)?;
        loop {
            let fine = self.solved(coarse.of(2 * harmonics), amplitude)?;
            let omega = fine.omega_squared.sqrt();
            let truncation = (omega - coarse.omega_squared.sqrt()).abs() / omega;
            if truncation <= TRUNCATION || 2 * harmonics > *HARMONICS.end() {
                if truncation > UNRESOLVED {
                    return Err(BackboneEnd::Unresolved { harmonics: 2 * harmonics });
                }
                let before = std::mem::replace(&mut self.last, fine);
                self.before = Some((self.amplitude, before));
                (self.amplitude, self.harmonics) = (amplitude, harmonics);
                // `FreeWheel::backbone` replaces the modal amplitude by the displacement.
                return Ok(BackbonePoint { amplitude, omega, truncation, harmonics: 2 * harmonics });
            }
            (coarse, harmonics) = (fine, 2 * harmonics);
        }
    }

    fn solved(&self, guess: Series, amplitude: f64) -> Result<Series, BackboneEnd> {
        match self.balance.solve(guess, amplitude) {
            Some(found) if found.omega_squared > 0.0 => Ok(found),
            Some(_) => Err(BackboneEnd::NoRestoringForce),
            None => Err(self.balance.nearest(&self.last, self.amplitude)),
        }
    }

    /// Resonances between the last two points.
    fn passed(&self) -> Vec<Resonance> {
        let Some((before_amplitude, before)) = &self.before else { return Vec::new() };
        self.balance.passed((before, *before_amplitude), (&self.last, self.amplitude))
    }
}

#[cfg(test)]
mod tests;
