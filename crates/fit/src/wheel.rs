//! Modes of the generated wheel at one point.

use rubmap_model::impeller::generate_like;
use rubmap_model::package::to_sector;
use rubmap_wheel::dynamics::reduction::{FreeInterfaceModes, free_interface_modes};

use crate::problem::Problem;

/// Lowest modes of the wheel at a point, of the nodal diameters of the targets, on a mesh with the degrees of freedom of that at point `like`.
///
/// # Errors
/// Message where the parameters there give no valid wheel, or its modes cannot be found.
pub(crate) fn modes_at(problem: &Problem, point: &[f64], like: &[f64]) -> Result<FreeInterfaceModes, String> {
    let [parameters, pattern] = [point, like].map(|point| problem.parameters(&problem.values(point)));
    let package = generate_like(&parameters?, &pattern?).map_err(|error| error.to_string())?;
    let sector = to_sector(package).map_err(|error| error.to_string())?;
    free_interface_modes(&sector, &problem.nodal_diameters(), problem.modes())
        .map_err(|error| error.to_string())
}
