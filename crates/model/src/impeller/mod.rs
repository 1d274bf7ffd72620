//! Own finite-element models as packages: a parametric centrifugal impeller, and small models for tests.
//!
//! [`generate`] runs top to bottom: parameters → sector mesh → M, `K_e` → centrifugal pre-stress → `K_σ` and spin
//! softening → package. Everything after the mesh knows only [`mesh::SectorMesh`], so another geometry is another
//! function that makes one ([`cantilever()`], [`annulus()`]), and another element is another [`element::Hexahedron`].
//!
//! The matrices are honest: `K(Ω) = K_e + K_σ(Ω) − Ω² M_spin` on the undeformed geometry, exactly linear in Ω²
//! (docs/method.md, Centrifugal stiffening). Where asked for, the gyroscopic matrix of Coriolis forces joins them.

mod annulus;
mod assembly;
mod blocks;
mod cantilever;
mod curves;
mod dofs;
pub mod element;
mod error;
mod geometry;
mod gyroscopic;
mod jacobian;
mod material;
mod matrices;
mod memory;
pub mod mesh;
mod parameters;
mod pattern;
mod plan;
mod preset;
mod prestress;
mod ranges;
mod request;
#[cfg(feature = "schema")]
mod schema;
mod sector_mesh;
mod to_package;
mod validate;

pub use annulus::{AnnulusParameters, annulus, annulus_mesh};
pub use assembly::cylindrical_frame;
pub use cantilever::{CantileverParameters, cantilever, cantilever_mesh};
pub use dofs::SectorDofs;
pub use error::{FieldProblem, ImpellerError};
pub use gyroscopic::gyroscopic_matrix;
pub use material::Material;
pub use matrices::{RestMatrices, SectorMatrices};
pub use memory::generation_bytes;
pub use parameters::{ImpellerParameters, MeshDensities, Splitter};
pub use plan::{GenerationPlan, plan_generation};
pub use preset::{PaperCasing, Preset};
pub use prestress::PreStress;
pub use request::ImpellerRequest;
pub use sector_mesh::impeller_sector;
pub use to_package::to_package;

use crate::package::raw::RawPackage;

/// Makes the model package of one impeller sector.
///
/// ```
/// use rubmap_model::impeller::{ImpellerParameters, MeshDensities, generate};
/// use rubmap_model::package::to_sector;
/// use rubmap_wheel::dynamics::modal_wheel::natural_frequencies;
/// use rubmap_wheel::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
///
/// // The demo's impeller, coarser.
/// let mesh = MeshDensities { between_contact_nodes: 1, blade_height: 2, blade_thickness: 1, half_passage: 1, disk: 1 };
/// let parameters = ImpellerParameters { contact_nodes: 3, mesh, ..ImpellerParameters::default() };
/// let sector = to_sector(generate(&parameters)?)?;
/// assert_eq!((sector.sectors, sector.contact.len()), (10, 3));
///
/// // Rotation stiffens it.
/// let reduced = reduce(&sector, &ReductionOptions::new(5), &NoCheckpoints, &|_, _| true)?;
/// let lowest = |speed_rad_s| natural_frequencies(&reduced.harmonics[2], speed_rad_s, true).map(|omega| omega[0]);
/// assert!(lowest(parameters.top_speed_rad_s)? > lowest(0.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ImpellerError`] names the parameter or the element at fault.
pub fn generate(parameters: &ImpellerParameters) -> Result<RawPackage, ImpellerError> {
    let sector = impeller_sector(parameters)?;
    let name = format!(
        "rubmap impeller, {} sectors, outlet radius {} {}",
        parameters.sectors, parameters.outlet_radius, parameters.units.length
    );
    let mut package =
        to_package(&name, &sector, &parameters.material, &parameters.units, parameters.top_speed_rad_s)?;
    if parameters.gyroscopic {
        package.manifest.gyroscopic = Some("g.npz".to_owned());
        package.gyroscopic = Some(gyroscopic_matrix(&sector, &parameters.material)?);
    }
    Ok(package)
}
