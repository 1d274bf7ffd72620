//! The accuracy dial: given, or still to be chosen.

use crate::request::{Accuracy, AutoOr, Budget};

/// Fixed-interface modes kept per stiffness speed and nodal diameter, k, where nobody says otherwise.
pub(crate) const DEFAULT_MODES_PER_SPEED: u32 = 20;

/// Fixed-interface modes kept per stiffness speed and nodal diameter, the accuracy dial k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Modes {
    /// Given number.
    Given(u32),
    /// Number to be chosen for an aim, by pilot runs or reductions.
    Sought(Aim),
}

/// Aim that is asked for in place of knobs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// Error to stay below.
    Accuracy(Accuracy),
    /// Time to keep to.
    Budget(Budget),
}

impl Modes {
    /// Reads the three fields of a request, which together say one thing; a number goes before an aim, being what was chosen for it.
    pub(crate) fn of(modes_per_speed: AutoOr, accuracy: Option<Accuracy>, budget: Option<Budget>) -> Self {
        match (modes_per_speed, accuracy, budget) {
            (AutoOr::Fixed(modes), ..) => Self::Given(modes),
            (AutoOr::Auto, Some(accuracy), _) => Self::Sought(Aim::Accuracy(accuracy)),
            (AutoOr::Auto, None, Some(budget)) => Self::Sought(Aim::Budget(budget)),
            (AutoOr::Auto, None, None) => Self::Given(DEFAULT_MODES_PER_SPEED),
        }
    }

    /// Writes the three fields of a request: `modes_per_speed`, `accuracy` and `budget`.
    pub(crate) fn fields(self) -> (AutoOr, Option<Accuracy>, Option<Budget>) {
        match self {
            Self::Given(modes) => (AutoOr::Fixed(modes), None, None),
            Self::Sought(Aim::Accuracy(accuracy)) => (AutoOr::Auto, Some(accuracy), None),
            Self::Sought(Aim::Budget(budget)) => (AutoOr::Auto, None, Some(budget)),
        }
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k, once they are known.
    pub fn given(self) -> Option<u32> {
        match self {
            Self::Given(modes) => Some(modes),
            Self::Sought(_) => None,
        }
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k; the default while they are sought.
    pub(crate) fn or_usual(self) -> u32 {
        self.given().unwrap_or(DEFAULT_MODES_PER_SPEED)
    }
}
