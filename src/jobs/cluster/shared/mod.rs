//! Tasks of a program with the feature `cluster`: those that machines share, and the workers that take them.

mod awake;
mod kind;
mod queues;
mod share;
pub(super) mod tasks;
pub(super) mod workers;
