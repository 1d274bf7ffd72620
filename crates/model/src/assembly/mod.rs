//! Matrices of a sector from its elements: `M`, `K(Ω) = K_e + K_σ(Ω) − Ω² M_spin` on the undeformed geometry, and G.
//!
//! Elements of one sector are summed in the cylindrical components of each node; the high face keeps its own rows (an unassembled sector).
//! [`to_package`] makes a package of them; the generator and the importer of meshes share it.

mod dofs;
mod gyroscopic;
mod matrices;
mod memory;
mod pattern;
mod prestress;
mod price;
mod sector;
mod sum;
mod to_package;

pub use dofs::SectorDofs;
pub use gyroscopic::gyroscopic_matrix;
pub use matrices::{RestMatrices, SectorMatrices};
pub use memory::assembly_bytes;
pub use prestress::{CanMove, PreStress};
pub use price::{AssemblyPrice, assembly_price};
pub use sector::{MeshedSector, TipNode};
pub(crate) use to_package::without_matrices;
pub use to_package::{PackageFacts, to_package};
