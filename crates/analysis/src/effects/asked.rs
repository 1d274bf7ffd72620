//! What a request says in a field of its scene, and what that comes to.

use crate::error::Violation;

/// A field of a scene as a request has it.
pub(crate) trait Asked {
    /// The same with its alternatives told apart.
    type Resolved;

    /// What was asked for; `refuse` hears of fields that together say too much or too little, of which something harmless is made.
    fn resolve(self, refuse: &mut dyn FnMut(Violation)) -> Self::Resolved;

    /// As a request would ask for it.
    fn of(resolved: Self::Resolved) -> Self;
}

/// What can be said in one way only.
pub(crate) trait Plain {}

impl Plain for bool {}

impl<T: Plain> Asked for T {
    type Resolved = T;

    fn resolve(self, _: &mut dyn FnMut(Violation)) -> T {
        self
    }

    fn of(resolved: T) -> T {
        resolved
    }
}
