//! Recurrence of a scene: times after which it looks the same from its wheel, once it has fully grown.
//!
//! After a time t, in revolutions, the scene may look to every sector as it looked before to the one b places ahead. This is so if
//!
//! ```text
//! k (t − b/N) ∈ ℤ            every order k: lobes of the casing, engine orders of forces
//! (1 − κ) t − b/N ∈ ℤ        an orbit of whirl ratio κ
//! δ_{s+b} = δ_s              deviations of mistuned sectors
//! ```
//!
//! An elastic casing, which is the same all around, has moved on by t − b/N, as seen by the sectors with their new numbers. These times are
//! the multiples of the shortest one, which therefore divides the revolutions after which the scene is the same again.

use num_integer::gcd;

use super::passage_error::PassageError;
use super::simulation::Simulation;
use crate::dynamics::effects::FrictionLaw;
use crate::dynamics::orbit::Orbit;

/// Largest number of revolutions that an orbit may take to come round.
const MOST_REVOLUTIONS: usize = 8;

/// Largest distance of a whirl ratio from a fraction: a phase as far off changes no response that is found to 1e-8.
const FRACTION: f64 = 1e-12;

/// Recurrence: a time in steps, and the number b of sectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Recurrence {
    pub(super) steps: usize,
    pub(super) turn: usize,
}

/// Orders, orbit and mistuning of a scene, which determine its recurrences.
#[derive(Debug)]
pub(super) struct Recurrences<'a> {
    /// Steps per revolution.
    steps: usize,
    /// Number N of sectors around.
    around: usize,
    /// Greatest common divisor of all orders; 0 where there are none.
    order: usize,
    /// Lobes of the casing, if it has any.
    lobes: Option<usize>,
    deviations: Option<&'a [f64]>,
    /// Turns 1 − κ of the orbit as a fraction.
    orbit: Option<(i64, usize)>,
}

impl<'a> Recurrences<'a> {
    /// Recurrences of the scene of `simulation`.
    ///
    /// # Errors
    /// [`PassageError::Coating`], [`PassageError::ClearanceChange`], [`PassageError::Disc`], [`PassageError::Bending`] and
    /// [`PassageError::Orbit`].
    pub(super) fn of(simulation: &Simulation<'a>) -> Result<Self, PassageError> {
        let effects = &simulation.effects;
        let touching = simulation.casing.is_some();
        if touching && effects.coating.is_some() {
            return Err(PassageError::Coating);
        }
        if touching && effects.clearance_change.is_some() {
            return Err(PassageError::ClearanceChange);
        }
        if touching && effects.friction.is_some_and(|friction| friction.law == FrictionLaw::Disc) {
            return Err(PassageError::Disc);
        }
        if effects.bending.is_some() {
            return Err(PassageError::Bending);
        }
        let orbit = match effects.orbit.filter(|_| touching) {
            Some(Orbit { whirl_ratio, .. }) => Some(turns(whirl_ratio)?),
            None => None,
        };
        let restriction = simulation.casing.and_then(|casing| casing.restriction.as_ref());
        let lobes = restriction.map(|restriction| restriction.repeats() as usize).filter(|lobes| *lobes > 0);
        let orders = effects.excitation.iter().map(|excitation| excitation.order as usize);
        Ok(Self {
            steps: simulation.steps_per_revolution,
            around: simulation.wheel.around(),
            order: orders.chain(lobes).fold(0, gcd),
            lobes,
            deviations: effects.mistuning,
            orbit,
        })
    }

    /// Revolutions after which the scene is the same again.
    pub(super) fn revolutions(&self) -> usize {
        self.orbit.map_or(1, |(_, revolutions)| revolutions)
    }

    /// Recurrence of whole revolutions, after which the scene is the same again.
    pub(super) fn whole(&self) -> Recurrence {
        Recurrence { steps: self.revolutions() * self.steps, turn: 0 }
    }

    /// Recurrence after one lobe if nothing distinguishes the lobes, [`Self::whole`] otherwise.
    pub(super) fn lobe(&self) -> Recurrence {
        let lobes = self.lobes.filter(|lobes| self.steps.is_multiple_of(*lobes));
        let lobe = lobes.map(|lobes| Recurrence { steps: self.steps / lobes, turn: 0 });
        lobe.filter(|&lobe| self.holds(lobe)).unwrap_or(self.whole())
    }

    /// Shortest recurrence that whole steps allow; that of a sector where nothing turns past the wheel.
    pub(super) fn shortest(&self) -> Recurrence {
        let whole = self.whole();
        let of = |steps: usize| {
            (0..self.around).map(|turn| Recurrence { steps, turn }).find(|&short| self.holds(short))
        };
        let divisors = (1..whole.steps).filter(|&steps| whole.steps.is_multiple_of(steps));
        divisors.filter_map(of).next().unwrap_or(whole)
    }

    fn holds(&self, Recurrence { steps, turn }: Recurrence) -> bool {
        let integer = |number: usize| number as i128;
        let (time, turned) = (integer(steps * self.around), integer(turn * self.steps));
        let revolution = integer(self.steps * self.around);
        let still = self.order == 0 && self.orbit.is_none_or(|(turns, _)| turns == 0);
        let order = integer(if still { self.around } else { self.order });
        let orbit = self.orbit.is_none_or(|(turns, per)| {
            let per = integer(per);
            (i128::from(turns) * time - turned * per) % (revolution * per) == 0
        });
        let alike = self.deviations.is_none_or(|deviations| {
            let turned = deviations.iter().cycle().skip(turn % deviations.len().max(1));
            deviations.iter().zip(turned).all(|(one, other)| one == other)
        });
        (order * (time - turned)) % revolution == 0 && orbit && alike
    }
}

/// Revolutions of a [map over a lobe](super::Passage::over_lobes) of a scene with these lobes, engine orders and whirl ratio, whose steps
/// it divides; 1 where the orbit never comes round.
pub fn revolutions_over_lobe(
    lobes: Option<u32>,
    orders: impl Iterator<Item = u32>,
    whirl_ratio: Option<f64>,
) -> f64 {
    let lobes = lobes.map(|count| count.max(1) as usize);
    let steps = lobes.unwrap_or(1);
    let order = orders.map(|order| order as usize).chain(lobes).fold(0, gcd);
    let orbit = whirl_ratio.and_then(|whirl_ratio| fraction(1.0 - whirl_ratio));
    let of = Recurrences { steps, around: 1, order, lobes, deviations: None, orbit };
    of.lobe().steps as f64 / steps as f64
}

/// Whether an orbit of this whirl ratio returns soon enough for periodic responses.
///
/// # Errors
/// [`PassageError::Orbit`].
pub fn comes_round(whirl_ratio: f64) -> Result<(), PassageError> {
    turns(whirl_ratio).map(|_| ())
}

/// Turns 1 − κ as a fraction.
fn turns(whirl_ratio: f64) -> Result<(i64, usize), PassageError> {
    fraction(1.0 - whirl_ratio).ok_or(PassageError::Orbit { whirl_ratio, most: MOST_REVOLUTIONS })
}

/// Fraction of few revolutions that equals `value`.
fn fraction(value: f64) -> Option<(i64, usize)> {
    let off = |per: usize| {
        let turns = value * per as f64;
        ((turns - turns.round()).abs() <= FRACTION).then_some((turns.round() as i64, per))
    };
    (1..=MOST_REVOLUTIONS).find_map(off)
}
