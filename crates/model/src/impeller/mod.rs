//! Own finite-element models as packages: a parametric centrifugal impeller, and small models for tests.
//!
//! [`generate`] meshes the sector of its parameters and has it assembled ([`crate::assembly`]). Another geometry is another function that makes a
//! [`mesh::SectorMesh`] ([`cantilever()`], [`annulus()`]).

mod annulus;
mod blocks;
mod cantilever;
mod curves;
mod error;
mod geometry;
mod jacobian;
mod material;
pub mod mesh;
mod parameters;
mod plan;
mod preset;
mod ranges;
mod request;
#[cfg(feature = "schema")]
mod schema;
mod sector_mesh;
mod validate;

pub use annulus::{AnnulusParameters, annulus, annulus_mesh};
pub use cantilever::{CantileverParameters, cantilever, cantilever_mesh};
pub use error::{FieldProblem, ImpellerError};
pub use material::Material;
pub use parameters::{ImpellerParameters, MeshDensities, Splitter};
pub use plan::{GenerationPlan, plan_generation};
pub use preset::{PaperCasing, Preset};
pub use request::ImpellerRequest;
pub use sector_mesh::impeller_sector;

use crate::assembly::{PackageFacts, to_package};
use crate::package::raw::RawPackage;
use sector_mesh::sector_like;

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
    generate_like(parameters, parameters)
}

/// Makes the model package of one impeller sector with the degrees of freedom of the sector of `pattern`, which has the same numbers of
/// elements: [`generate`] ends the clamp at one of the mesh's stations, another one for another shape, so that its matrices are no smooth
/// function of the parameters.
///
/// # Errors
/// [`ImpellerError`] names the parameter or the element at fault.
pub fn generate_like(
    parameters: &ImpellerParameters,
    pattern: &ImpellerParameters,
) -> Result<RawPackage, ImpellerError> {
    let sector = sector_like(parameters, pattern)?;
    let name = format!(
        "rubmap impeller, {} sectors, outlet radius {} {}",
        parameters.sectors, parameters.outlet_radius, parameters.units.length
    );
    let facts = PackageFacts {
        name,
        units: parameters.units.clone(),
        top_speed_rad_s: parameters.top_speed_rad_s,
        gyroscopic: parameters.gyroscopic,
    };
    Ok(to_package(&facts, &sector.made_of(&parameters.material))?)
}
