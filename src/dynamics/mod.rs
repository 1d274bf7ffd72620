//! The physics: cyclic structure, reduction, contact and time integration, in the words of METHOD.md.

pub mod error;
pub mod sector;
