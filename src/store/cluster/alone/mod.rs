//! Store of a program without the feature `cluster`: types that no value can have, with the names that [`crate::store`] uses.

pub mod address;
pub mod claims;
pub(super) mod error;
pub mod queue;
pub(super) mod remote;
#[cfg(test)]
pub(super) mod testing;
