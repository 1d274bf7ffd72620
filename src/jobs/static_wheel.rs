//! Wheel under its centrifugal load: read, or solved and stored beside the basis.

use std::path::Path;

use crate::analysis::stress::{StaticWheel, StressMaker};
use crate::dynamics::reduction::{ReducedWheel, ReductionError, Watch};
use crate::package::{self, Limits, PackageError};
use crate::store::bases::BasisFolder;

/// Reason why there is no static wheel.
#[derive(Debug, thiserror::Error)]
pub enum StaticWheelError {
    /// The package cannot be read.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// Wheel that cannot be solved.
    #[error(transparent)]
    Unsolved(#[from] ReductionError),
}

/// Static wheel of a package with a mesh and its nodes, which `maker` has; `wheel` is the reduction beside whose `basis` it is stored.
pub(super) fn static_wheel(
    package: &Path,
    (basis, wheel): (&BasisFolder, &ReducedWheel),
    maker: &StressMaker<'_>,
    watch: Watch<'_>,
) -> Result<StaticWheel, StaticWheelError> {
    if let Ok(fixed) = basis.static_wheel(wheel) {
        return Ok(fixed);
    }
    watch(0.0, "reading the package");
    let package = package::read(package, &Limits::default())?;
    let fixed = maker.fixed(&package.sector, watch)?;
    if let Err(error) = basis.keep_static_wheel(wheel, &fixed) {
        tracing::warn!(%error, "could not keep the static stress; going on without");
    }
    Ok(fixed)
}

/// Static wheel of a package, read from its file; `None` for a package without a mesh.
pub(super) fn from_package(
    package: &Path,
    (basis, wheel): (&BasisFolder, &ReducedWheel),
    watch: Watch<'_>,
) -> Result<Option<StaticWheel>, StaticWheelError> {
    let limits = Limits::default();
    let Some(mesh) = package::read_mesh(package, &limits)? else { return Ok(None) };
    let nodes = package::read_nodes(package, &limits)?;
    let maker = StressMaker::new(&mesh, &nodes);
    static_wheel(package, (basis, wheel), &maker, watch).map(Some)
}
