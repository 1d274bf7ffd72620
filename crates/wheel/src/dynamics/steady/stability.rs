//! Whether a periodic response lasts, and how it would end if not.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::multipliers::{Multiplier, multipliers};
use super::periodic::repeats;
use super::tangent::Tangent;
use crate::dynamics::integrate::{Passage, PassageError};

/// What becomes of what disturbs a periodic response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// All of it decays.
    Stable,
    /// It decays if it is small enough for the same nodes to touch at the same steps, but a march from a thousandth beside the response did
    /// not come back.
    Narrow,
    /// It grows, and changes its sign from one passage to the next: the period doubles, which two lobes show on odd engine orders.
    Flip,
    /// It grows in one direction: another response of the same period, or one of less symmetry, takes over.
    Fold,
    /// It grows and turns: a second frequency, and lines split.
    NeimarkSacker,
    /// The multipliers could not be found well enough to tell.
    Undecided,
}

/// The multipliers of a response over whole passages of lobes.
#[derive(Debug, Clone, PartialEq)]
pub struct Floquet {
    /// Passages of a lobe; 1 but for a response that is another one at every second, third … lobe, and in scenes that tell the lobes apart.
    /// Revolutions where there are no lobes.
    pub lobes: usize,
    /// The same in [passages over a lobe](Passage::over_lobes), which are longer where effects tell lobes apart.
    pub passages: usize,
    /// The largest, largest first.
    pub multipliers: Vec<Multiplier>,
    /// What they say.
    pub stability: Stability,
    /// Engine orders of what repeats with these passages: all multiples of this.
    pub orders: f64,
    /// Revolutions that it took to find them.
    pub revolutions: f64,
}

/// ‖F(x) − x‖ / ‖x‖ up to which a response repeats after so many lobes.
const REPEATS: f64 = 1e-6;

impl Floquet {
    /// `count` multipliers of the response `state` that `passage` maps to itself. `hint`: a state with a share of what disturbs it longest.
    ///
    /// # Errors
    /// As of [`Passage::map`].
    pub fn of(
        passage: &Passage<'_>,
        (state, hint): (&[f64], &[f64]),
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
