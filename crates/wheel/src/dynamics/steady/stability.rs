//! Stability of a periodic response, and how it is lost.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::multipliers::{Multiplier, multipliers};
use super::periodic::repeats;
use super::tangent::Tangent;
use crate::dynamics::integrate::{Passage, PassageError};

/// Stability of a periodic response: `stable` where all disturbances decay, `narrow` where they do so only if small, `flip`, `fold` or
/// `neimark_sacker` by the way in which a disturbance grows, `undecided` where the multipliers could not be found well enough.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// Disturbances all decay.
    Stable,
    /// Disturbances decay if they are small enough for the same nodes to touch at the same steps, but a march from a thousandth beside the
    /// response did not come back.
    Narrow,
    /// Disturbance that grows, and changes its sign from one passage to the next: the period doubles, which two lobes show on odd engine orders.
    Flip,
    /// Disturbance that grows in one direction: another response of the same period, or one of less symmetry, takes over.
    Fold,
    /// Disturbance that grows and turns: a second frequency, and lines split.
    NeimarkSacker,
    /// Multipliers that could not be found well enough to decide.
    Undecided,
}

/// Floquet multipliers of a response over whole passages of lobes.
#[derive(Debug, Clone, PartialEq)]
pub struct Floquet {
    /// Number of lobes that pass between repetitions; 1 except for a response that is another one at every second, third … lobe, and in
    /// scenes that tell the lobes apart. Revolutions where there are no lobes.
    pub lobes: usize,
    /// Number of [maps over a lobe](Passage::over_lobes) between repetitions; such maps are longer where effects tell lobes apart.
    pub passages: usize,
    /// Largest multipliers, in descending order.
    pub multipliers: Vec<Multiplier>,
    /// Stability that the multipliers show.
    pub stability: Stability,
    /// Engine orders of a response that repeats after these passages: all multiples of this number.
    pub orders: f64,
    /// Revolutions that it took to find the multipliers.
    pub revolutions: f64,
}

/// Residual ‖F(x) − x‖ / ‖x‖ up to which a response repeats after a number of lobes.
const REPEATS: f64 = 1e-6;

impl Floquet {
    /// Multipliers, `count` of them, of the response `state` that `passage` maps to itself. `hint`: a state with a share of the most
    /// lasting disturbance.
    ///
    /// # Errors
    /// As of [`Passage::map`].
    pub fn of(
        passage: &Passage<'_>,
        state: &[f64],
        hint: &[f64],
        count: usize,
    ) -> Result<Self, PassageError> {
        let over = |lobes: usize| -> Result<_, PassageError> {
            let mut over = Passage::over_lobes(passage.simulation(), lobes)?;
            let image = over.map(state)?;
            Ok((repeats(state, &image) <= REPEATS, over))
        };
        let (mut found, mut over_some) = over(1)?;
        let mut revolutions = 0.0;
        // Until all is as it was, and as long as the response itself takes.
        let one = over_some.steps();
        let longer = [over_some.lobes(), passage.steps() / one].into_iter().filter(|&lobes| lobes > 1);
        for lobes in longer {
            if !found && lobes * one > over_some.steps() {
                revolutions += over_some.revolutions();
                (found, over_some) = over(lobes)?;
            }
        }
        let passage = over_some;
        let passages = passage.steps() / one;
        let multipliers = multipliers(&Tangent::of(&passage), count, hint);
        revolutions += passage.revolutions();
        let orders = passage.simulation().steps_per_revolution as f64 / passage.steps() as f64;
        let lobes = passage.lobes_passed();
        let stability = judge(&multipliers, passage.size());
        Ok(Self { lobes, passages, stability, multipliers, orders, revolutions })
    }

    /// Distance, in engine orders, of the lines that a disturbance of this multiplier adds from those of the response, and from all
    /// multiples of [`Self::orders`] (docs/method.md, Steady states).
    pub fn order_offset(&self, multiplier: &Multiplier) -> f64 {
        multiplier.value.arg().abs() / TAU * self.orders
    }
}

fn judge(found: &[Multiplier], unknowns: usize) -> Stability {
    if unknowns == 0 {
        return Stability::Stable;
    }
    let Some(leading) = found.first() else { return Stability::Undecided };
    let (size, residual) = (leading.value.norm(), leading.residual);
    if size + residual < 1.0 {
        return Stability::Stable;
    }
    if size - residual <= 1.0 {
        return Stability::Undecided;
    }
    match leading.value.arg().abs() {
        0.0 => Stability::Fold,
        angle if angle >= PI => Stability::Flip,
        _ => Stability::NeimarkSacker,
    }
}
