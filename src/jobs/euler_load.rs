//! The Euler force in the coordinates of a reduction, from the mesh and the basis.

use std::io;
use std::path::Path;

use super::error::Interruption;
use crate::analysis::euler_load::EulerLoad;
use crate::dynamics::reduction::ReducedWheel;
use crate::package::{self, Limits};
use crate::store::bases::{BasisFolder, OpenBasis};

/// Of a package from its file; `wheel` is the reduction beside which `basis` is kept. The inner error is that of files beside the reduction.
pub(super) fn from_package(
    package: &Path,
    (basis, wheel): (&BasisFolder, &ReducedWheel),
) -> Result<io::Result<EulerLoad>, Interruption> {
    let limits = Limits::default();
    let mesh = package::read_mesh(package, &limits).map_err(Interruption::stored_package)?;
    let Some(mesh) = mesh else { return Ok(Err(io::Error::other("the package has no mesh"))) };
    let nodes = package::read_nodes(package, &limits).map_err(Interruption::stored_package)?;
    let load = |basis: &OpenBasis| EulerLoad::of(&mesh, &nodes, basis.dofs(), |dof| basis.row(dof));
    Ok(basis.open(&wheel.harmonics[0]).and_then(|basis| load(&basis)))
}
