//! Sources of models of impeller sectors: [`package`]s as users upload them, and the generator of [`impeller`]s.

pub mod impeller;
pub mod package;
