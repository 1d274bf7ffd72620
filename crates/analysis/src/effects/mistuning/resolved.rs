//! Mistuning, its alternatives resolved.

use super::request;
use crate::effects::asked::Asked;
use crate::error::Violation;

/// Relative stiffness deviations of the sectors.
#[derive(Debug, Clone, PartialEq)]
pub enum Mistuning {
    /// Given deviations: δ of every sector.
    Given(Vec<f64>),
    /// Normally distributed deviations.
    Drawn {
        /// Standard deviation of δ.
        spread: f64,
        /// Seed of the distribution; the same seed gives the same wheel.
        seed: u64,
    },
}

impl Asked for Option<request::Mistuning> {
    type Resolved = Option<Mistuning>;

    fn resolve(self, refuse: &mut dyn FnMut(Violation)) -> Option<Mistuning> {
        let request::Mistuning { deviations, spread, seed } = self?;
        if seed.is_some() && spread.is_none() {
            refuse(Violation::new(
                "/scene/mistuning/seed",
                "a seed belongs to `spread`: given deviations need none",
            ));
        }
        match (deviations, spread) {
            (Some(deviations), None) => Some(Mistuning::Given(deviations)),
            (None, Some(spread)) => Some(Mistuning::Drawn { spread, seed: seed.unwrap_or(0) }),
            _ => {
                refuse(Violation::new(
                    "/scene/mistuning",
                    "give either `deviations`, one per sector, or `spread` (with a `seed`)",
                ));
                None
            }
        }
    }

    fn of(resolved: Option<Mistuning>) -> Self {
        Some(match resolved? {
            Mistuning::Given(deviations) => {
                request::Mistuning { deviations: Some(deviations), spread: None, seed: None }
            }
            Mistuning::Drawn { spread, seed } => {
                request::Mistuning { deviations: None, spread: Some(spread), seed: Some(seed) }
            }
        })
    }
}
