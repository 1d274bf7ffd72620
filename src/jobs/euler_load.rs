//! The Euler force in the coordinates of a reduction, from the mesh and the basis.

use std::io;
use std::path::Path;

use super::error::Interruption;
use crate::analysis::euler_load::EulerLoad;
use crate::dynamics::reduction::ReducedWheel;
use crate::package::{self, Limits};
use crate::store::bases::BasisFolder;
use crate::store::jobs::{Failure, FailureCause};

/// Euler force of a package, read from its file; `wheel` is the reduction beside which `basis` is stored. The inner error is that of files
/// beside the reduction.
pub(super) fn from_package(
    package: &Path,
    (basis, wheel): (&BasisFolder, &ReducedWheel),
) -> Result<io::Result<EulerLoad>, Interruption> {
    let limits = Limits::default();
    let mesh = package::read_mesh(package, &limits).map_err(Interruption::stored_package)?;
    let Some(mesh) = mesh else {
        let message = "the stored package has no elements, by which the Euler force acts".to_owned();
        return Err(Interruption::Failed(Failure {
            cause: FailureCause::Package,
            message,
            violations: Vec::new(),
        }));
    };
    let nodes = package::read_nodes(package, &limits).map_err(Interruption::stored_package)?;
    let harmonic = &wheel.harmonics[0];
    let own_dofs = nodes.iter().flat_map(|node| node.dofs.iter().flatten()).map(|dof| dof.dof + 1).max();
    Ok(EulerLoad::of(&mesh, &nodes, own_dofs.unwrap_or(0), |load| basis.project(harmonic, load)))
}
