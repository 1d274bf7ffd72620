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
    /// Passages of a lobe; 1 but for a response that is another one at every second, third … lobe. A revolution where there are no lobes.
    pub lobes: usize,
    /// The largest, largest first.
    pub multipliers: Vec<Multiplier>,
    /// What they say.
    pub stability: Stability,
    /// Passages that are taken in all, as shares of a revolution: products of the derivative among them.
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
        let mut revolutions = 0.0;
        for lobes in [1, passage.lobes()] {
            let mut longer = Passage::over_lobes(passage.simulation(), lobes)?;
            let image = longer.map(state)?;
            let share = longer.steps() as f64 / passage.simulation().steps_per_revolution as f64;
            revolutions += share;
            if lobes < passage.lobes() && repeats(state, &image) > REPEATS {
                continue;
            }
            let tangent = Tangent::of(&longer);
            let multipliers = multipliers(&tangent, count, hint);
            revolutions += share * tangent.products() as f64;
            return Ok(Self {
                lobes,
                stability: judge(&multipliers, passage.size()),
                multipliers,
                revolutions,
            });
        }
        unreachable!("a response repeats after a revolution")
    }

    /// Distance of the lines that what this multiplier belongs to adds, from those of the response: an engine order, and from any of its
    /// multiples by `lobe_count / self.lobes` (docs/method.md, Steady states).
    pub fn order_offset(&self, multiplier: &Multiplier, lobe_count: usize) -> f64 {
        let orders = lobe_count as f64 / self.lobes as f64;
        multiplier.value.arg().abs() / TAU * orders
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
