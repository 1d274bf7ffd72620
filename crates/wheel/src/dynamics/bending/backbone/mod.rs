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
mod response;

use std::ops::RangeInclusive;

use balance::{Balance, Series, UNRESOLVED};
pub use end::{BackboneEnd, Resonance};
pub use free_wheel::{FreeMode, FreeModes, FreeWheel};

/// Numbers of harmonics with which a curve is begun, and which it may reach; every frequency is held against that of twice as many.
const HARMONICS: RangeInclusive<usize> = 4..=16;

/// Change of the frequency by twice as many harmonics, relative, above which twice as many are taken.
const TRUNCATION: f64 = 1e-6;

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
            Backbone { row, points: vec![rest], passed: Vec::new(), end: BackboneEnd::StillContact };
        if size > 0.0 {
            curve.end = Follower::new(self, mode).march(largest / size, |follower, found| {
                curve.points.push(BackbonePoint { amplitude: size * found.amplitude, ..found });
                curve.passed.extend(follower.passed());
            });
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
    /// Motion at the last point.
    last: Series,
    /// Amplitude of the point before, and its motion per amplitude.
    before: Option<(f64, Series)>,
}

impl<'a> Follower<'a> {
    fn new(wheel: &'a FreeWheel<'a>, mode: FreeMode) -> Self {
        let balance = Balance::new(wheel, mode);
        let harmonics = *HARMONICS.start();
        let last = balance.linear(harmonics, 0.0);
        Self { balance, harmonics, amplitude: 0.0, last, before: None }
    }

    /// Goes on to the modal amplitude `largest`, and calls `reached` at every point. Returns why it ends.
    fn march(&mut self, largest: f64, mut reached: impl FnMut(&Self, BackbonePoint)) -> BackboneEnd {
        let whole = largest / STEPS;
        let mut step = whole;
        // The last step may end a round-off short of the largest amplitude.
        while self.amplitude < whole * (STEPS - 1e-9) {
            match self.reach((self.amplitude + step).min(largest)) {
                Ok(found) => {
                    reached(self, found);
                    step = whole.min(2.0 * step);
                }
                Err(_) if step > whole * SHORTEST => step *= 0.5,
                Err(failure) => return failure,
            }
        }
        BackboneEnd::LargestAmplitude
    }

    /// Goes on to a modal amplitude, which the point has for its own; stays where it is on failure.
    fn reach(&mut self, amplitude: f64) -> Result<BackbonePoint, BackboneEnd> {
        let guess = self.guess(amplitude);
        let mut harmonics = self.harmonics;
        let mut coarse = self.solved(guess.of(harmonics), amplitude, &guess)?;
        loop {
            let fine = self.solved(coarse.of(2 * harmonics), amplitude, &guess)?;
            let omega = fine.omega_squared.sqrt();
            let truncation = (omega - coarse.omega_squared.sqrt()).abs() / omega;
            if truncation <= TRUNCATION || 2 * harmonics > *HARMONICS.end() {
                if truncation > UNRESOLVED {
                    return Err(BackboneEnd::Unresolved { harmonics: 2 * harmonics });
                }
                let shape = self.shape();
                self.before = Some((self.amplitude, shape));
                (self.amplitude, self.last, self.harmonics) = (amplitude, fine, harmonics);
                return Ok(BackbonePoint { amplitude, omega, truncation, harmonics: 2 * harmonics });
            }
            (coarse, harmonics) = (fine, 2 * harmonics);
        }
    }

    /// Motion per amplitude at the last point.
    fn shape(&self) -> Series {
        match self.amplitude {
            0.0 => self.balance.linear(self.harmonics, 1.0),
            amplitude => self.last.scaled(1.0 / amplitude),
        }
    }

    /// Motion of an amplitude as the last two points lead to it: motion per amplitude by a straight line over the amplitude, ω² over its square,
    /// of which it is a function where nothing is near.
    fn guess(&self, amplitude: f64) -> Series {
        let shape = self.shape();
        let Some((before, shape_before)) = &self.before else { return shape.scaled(amplitude) };
        let share = (amplitude - self.amplitude) / (self.amplitude - before);
        let of_squares = share * (amplitude + self.amplitude) / (self.amplitude + before);
        shape.extrapolated(shape_before, share, of_squares).scaled(amplitude)
    }

    /// Motion that Newton's method finds from `first`, on the branch that leads to `extrapolated`.
    fn solved(&self, first: Series, amplitude: f64, extrapolated: &Series) -> Result<Series, BackboneEnd> {
        let found = self.balance.solve(first, amplitude);
        match found.filter(|found| !self.balance.strays(found, extrapolated, amplitude)) {
            Some(found) if found.omega_squared > 0.0 => Ok(found),
            Some(_) => Err(BackboneEnd::NoRestoringForce),
            None => Err(self.end(amplitude)),
        }
    }

    /// Reason why nothing was found at an amplitude beyond the last point. At rest no mode responds: the linear motion tells.
    fn end(&self, amplitude: f64) -> BackboneEnd {
        let resonance = match self.amplitude {
            0.0 => self.balance.nearest(&self.guess(amplitude), amplitude),
            last => self.balance.nearest(&self.last, last),
        };
        resonance.map_or(BackboneEnd::NotFound, BackboneEnd::AtResonance)
    }

    /// Resonances between the last two points.
    fn passed(&self) -> Vec<Resonance> {
        let Some((amplitude, shape)) = &self.before else { return Vec::new() };
        self.balance.passed((&shape.scaled(*amplitude), *amplitude), (&self.last, self.amplitude))
    }
}

#[cfg(test)]
mod tests;
