//! Store of a program with the feature `cluster`: what processes on several machines share, on a PostgreSQL server and in object storage.

pub mod address;
pub mod claims;
pub mod copy;
pub(super) mod error;
mod failure;
pub mod machines;
mod objects;
pub mod queue;
pub(super) mod remote;
#[cfg(test)]
pub(super) mod testing;
#[cfg(test)]
mod tests;
