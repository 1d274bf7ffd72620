//! Sources of models of impeller sectors: [`package`]s as users upload them, the [`assembly`] of meshes, and the generator of [`impeller`]s.

pub mod assembly;
pub mod from_mesh;
pub mod impeller;
pub mod package;
