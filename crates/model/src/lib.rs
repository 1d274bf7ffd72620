//! Where models of impeller sectors come from: [`package`]s as users upload them, and the generator of [`impeller`]s.

pub mod impeller;
pub mod package;
