//! Detection of a motion that repeats: states at the ends of revolutions are compared (docs/method.md, Steady states).

use super::super::flexible_casing::CasingMotion;
use super::super::oscillators::Oscillators;
use super::revolutions::{Repeated, Repeats};
use super::simulation::Simulation;
use crate::dynamics::clearance_change::ClearanceChange;

/// Longest period that is searched, in revolutions.
const LONGEST: usize = 8;

/// Number of periods over which the rate of changes is read: from one to the next it swings.
const BASE: usize = 4;

/// Number of periods at all ends of revolutions of which the motion has to repeat.
const LASTING: usize = 5;

/// Fewest revolutions, after the ramp, of a run that ends because its motion repeats.
pub const LEAST_MARCHED: u64 = (1 + BASE + LASTING) as u64;

/// Share below which changes are round-off, and have no rate.
const ROUND_OFF: f64 = 1e-10;

/// Share of motion forbidden by the symmetry below which it is round-off.
const VANISHED: f64 = 1e-13;

/// Share of motion forbidden by the symmetry below which it counts as round-off if it stays constant. The amount of round-off depends on
/// the wheel (6e-16 of the motion were seen, and 1.3e-13).
const FAINT: f64 = 1e-11;

/// Growth over [`BASE`] periods up to which forbidden motion counts as constant, about a steady level of round-off: a tenth a period. From
/// [`FAINT`] on more than a hundred of them would have to follow until it could be seen.
const STAYS: f64 = 1.5;

/// Comparison of states at the ends of revolutions.
#[derive(Debug)]
pub(super) struct Repetition {
    share: f64,
    /// Revolutions before which nothing is compared (`first`), and before which nothing ends (`least`).
    first: usize,
    least: usize,
    /// Periods that a window is made of, the shortest first.
    periods: Vec<usize>,
    /// Share of the slowest free motion that remains after a revolution.
    slowest: f64,
    /// Index of every number of the oscillators, and the factor of its increment that gives it the number's unit. Numbers that the symmetry
    /// of the scene forbids come first.
    numbers: Vec<(usize, f64)>,
    forbidden: usize,
    /// Ends of revolutions, the latest last.
    ends: Vec<End>,
    /// Change since the end of a revolution a period before, `[period][end of a revolution]`.
    changes: Vec<Vec<f64>>,
    /// Share of motion that the symmetry forbids, at every end of a revolution.
    asymmetries: Vec<f64>,
}

/// State at the end of a revolution.
#[derive(Debug)]
struct End {
    wheel: Vec<f64>,
    casing: Vec<f64>,
}

impl Repetition {
    pub(super) fn new(simulation: &Simulation<'_>, repeats: Repeats, oscillators: &Oscillators) -> Self {
        let Simulation { wheel, scheme, damping, casing, effects, .. } = *simulation;
        let (step, turn) =
            (simulation.step_s(), simulation.step_s() * simulation.steps_per_revolution as f64);
        let (mut slowest, mut numbers, mut allowed) = (0.0f64, Vec::new(), Vec::new());
        for (harmonic, modes) in wheel.harmonics.iter().enumerate() {
            for family in 0..scheme.integrated_modes(modes.omega.len()) {
                let omega = modes.omega[family];
                let zeta = damping.map_or(0.0, |damping| damping.ratio(harmonic, family));
                slowest = slowest.max((-zeta * omega * turn).exp());
                let unit = if omega > 0.0 { (omega * step).recip() } else { 1.0 };
                let kind =
                    if modes.harmonic.is_multiple_of(repeats.symmetry) { &mut allowed } else { &mut numbers };
                kind.extend(oscillators.places(harmonic, family).map(|place| (place, unit)));
            }
        }
        let forbidden = numbers.len();
        numbers.extend(allowed);
        let window = simulation.window_revolutions;
        let periods: Vec<usize> =
            (1..=LONGEST.min(window)).filter(|&period| window.is_multiple_of(period)).collect();
        Self {
            share: repeats.share,
            first: casing
                .map_or(0.0, |casing| casing.ramp_revolutions)
                .max(effects.clearance_change.map_or(0.0, ClearanceChange::ends_after))
                .ceil() as usize,
            least: repeats.least,
            slowest,
            numbers,
            forbidden,
            ends: Vec::with_capacity(LONGEST + 1),
            changes: vec![Vec::with_capacity(simulation.revolutions); periods.len()],
            periods,
            asymmetries: Vec::with_capacity(simulation.revolutions),
        }
    }

    /// Compares the end of a revolution, the `after`th from the start; returns the motion if it repeats.
    pub(super) fn look(
        &mut self,
        after: usize,
        oscillators: &Oscillators,
        casing: Option<&CasingMotion>,
    ) -> Option<Repeated> {
        if after < self.first {
            return None;
        }
        let (z, d) = oscillators.state();
        let positions = self.numbers.iter().map(|&(place, _)| z[place]);
        let increments = self.numbers.iter().map(|&(place, unit)| d[place] * unit);
        let now = End {
            wheel: positions.chain(increments).collect(),
            casing: casing.map_or_else(Vec::new, |casing| casing.state().collect()),
        };
        for (&period, changes) in self.periods.iter().zip(&mut self.changes) {
            if let Some(before) = self.ends.len().checked_sub(period) {
                changes.push(now.change(&self.ends[before]));
            }
        }
        self.asymmetries.push(now.share_of(self.forbidden));
        if self.ends.len() == LONGEST {
            self.ends.remove(0);
        }
        self.ends.push(now);
        if after < self.least {
            return None;
        }
        self.periods.iter().zip(&self.changes).find_map(|(&period, changes)| {
            let remaining = (0..LASTING * period).map(|back| self.remaining(period, changes, back));
            let remaining = remaining.fold(0.0, f64::max);
            (remaining <= self.share && self.is_symmetric(period)).then_some(Repeated {
                after,
                period,
                remaining,
            })
        })
    }

    /// Whether motion that the symmetry forbids dies out, or has done so.
    fn is_symmetric(&self, period: usize) -> bool {
        let earlier = self.asymmetries.iter().rev().skip(BASE * period);
        let mut pairs = self.asymmetries.iter().rev().zip(earlier).take(LASTING * period);
        pairs.all(|(&now, &then)| now < then || now <= VANISHED || (now <= FAINT && now < STAYS * then))
    }

    /// Sum of all changes to come, as it looked `back` revolutions ago: changes of a period shrink on as they did, and no faster than free motion.
    fn remaining(&self, period: usize, changes: &[f64], back: usize) -> f64 {
        let Some(before) = changes.len().checked_sub(1 + back + BASE * period) else { return f64::INFINITY };
        let (then, now) = (changes[before], changes[before + BASE * period]);
        if now <= ROUND_OFF {
            return now;
        }
        let rate = (now / then).powf(1.0 / BASE as f64).max(self.slowest.powi(period as i32));
        if rate < 1.0 { now * rate / (1.0 - rate) } else { f64::INFINITY }
    }
}

impl End {
    /// Share of the first `count` positions and increments in those of the wheel.
    fn share_of(&self, count: usize) -> f64 {
        let squares = |numbers: &[f64]| numbers.iter().map(|x| x * x).sum::<f64>();
        let (z, d) = self.wheel.split_at(self.wheel.len() / 2);
        let part = squares(&z[..count]) + squares(&d[..count]);
        if part > 0.0 { (part / squares(&self.wheel)).sqrt() } else { 0.0 }
    }

    /// Change since `before`, relative: that of the wheel or of the casing, whichever is larger.
    fn change(&self, before: &Self) -> f64 {
        let of = |now: &[f64], before: &[f64]| {
            let away = now.iter().zip(before).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
            let size = now.iter().map(|x| x * x).sum::<f64>();
            if away > 0.0 { (away / size).sqrt() } else { 0.0 }
        };
        of(&self.wheel, &before.wheel).max(of(&self.casing, &before.casing))
    }
}
