//! Fields of a scene as a request has them, and how they are resolved.

use crate::error::Violation;

/// A field of a scene as a request has it.
pub(crate) trait Asked {
    /// Resolved form of the field, its alternatives told apart.
    type Resolved;

    /// Resolves the field; `refuse` is given violations of fields that together say too much or too little, of which something harmless is made.
    fn resolve(self, refuse: &mut dyn FnMut(Violation)) -> Self::Resolved;

    /// Writes the field as a request would ask for it.
    fn of(resolved: Self::Resolved) -> Self;
}

/// Marker of fields that can be said in one way only: their resolved form is the same type.
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
