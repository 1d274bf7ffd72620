//! Model of a sector from its mesh: what the file and the settings do not say is found from the geometry.
//!
//! ```text
//! MeshFile, MeshSettings ──▶ materials ─▶ body ─▶ surface ─▶ cyclic ─▶ clamp ─▶ tip ──▶ MeshedSector ─▶ assembly ─▶ RawPackage
//! ```

mod anywhere;
mod body;
mod chains;
mod clamp;
mod conforming;
mod contact_points;
mod cyclic;
mod edges;
pub mod error;
mod found;
mod look;
mod materials;
mod matrices;
mod midline;
mod opposite;
mod parts;
mod patches;
mod sector;
mod sets;
mod settings;
mod shroud;
mod surface;
mod tip;
mod turned;
mod upload;
mod way;

pub use clamp::ClampSource;
pub use error::FromMeshError;
pub use found::Found;
pub use look::{LookRefusal, LookStep, MeshChain, MeshLook, look};
pub use matrices::{FileMatrices, package_with_matrices};
pub use parts::{MeshPatch, MeshRole};
pub use sector::{Sector, sector};
pub use settings::MeshSettings;
pub use tip::TipSource;
pub use upload::{look_at_mesh, sector_of_mesh, sector_of_package};
