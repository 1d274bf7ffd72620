//! Tasks of a program without the feature `cluster`: none is shared.

pub(super) mod tasks;
pub(super) mod workers;
