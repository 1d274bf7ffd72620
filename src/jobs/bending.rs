//! Bending of second order of a reduction, from the mesh of its package and its basis.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::computing::Computing;
use super::error::Interruption;
use super::mesh::mesh_and_nodes;
use super::progress::PhaseMonitor;
use crate::analysis::error::AnalysisError;
use crate::analysis::monitor::Monitor;
use crate::analysis::run::{self, NotMeasured};
use crate::dynamics::bending::BladeBending;
use crate::dynamics::reduction::ReducedWheel;
use crate::memory::Memory;
use crate::store::bases::BasisFolder;
use crate::store::jobs::{Failure, FailureCause};

/// Inputs from which the bending is made.
#[derive(Debug)]
pub(super) struct Making {
    pub(super) package: PathBuf,
    pub(super) basis: BasisFolder,
    pub(super) wheel: Arc<ReducedWheel>,
    pub(super) coordinates: usize,
    pub(super) memory: Arc<Memory>,
    pub(super) monitor: PhaseMonitor,
}

/// Makes the bending. The inner error is that of files beside the reduction.
pub(super) async fn make(
    computing: &Computing,
    making: Making,
) -> Result<io::Result<BladeBending>, Interruption> {
    let Making { package, basis, wheel, coordinates, memory, monitor } = making;
    monitor.progress(0.0, "reading the package");
    let read = computing.run(monitor.watch(), move || mesh_and_nodes(&package)).await??;
    let Some((mesh, nodes)) = read else {
        return Err(failed(
            FailureCause::Package,
            "the stored package has no elements, which bend".to_owned(),
        ));
    };
    monitor.progress(0.0, "waiting for memory that other jobs hold");
    let held = memory.hold(run::bending_bytes(&mesh, coordinates)).await;
    let _memory = held.map_err(Interruption::bending_memory)?;
    let watch = monitor.watch().clone();
    let compute = move || {
        let mut product =
            |harmonic: usize, columns: faer::MatRef<'_, faer::c64>| basis.product(&wheel, harmonic, columns);
        let mut project = |harmonic: usize, load: &[f64]| basis.project(&wheel.harmonics[harmonic], load);
        let maps: (run::BasisProduct<'_>, run::BasisProjection<'_>) = (&mut product, &mut project);
        run::blade_bending((&mesh, &nodes), &wheel, coordinates, maps, &monitor)
    };
    match computing.run_parallel(&watch, compute).await? {
        Ok(made) => Ok(Ok(made)),
        Err(NotMeasured::Basis(error)) => Ok(Err(error)),
        Err(NotMeasured::Cancelled) => Err(AnalysisError::Cancelled.into()),
        Err(error) => Err(failed(FailureCause::Model, format!("the bending of second order: {error}"))),
    }
}

fn failed(cause: FailureCause, message: String) -> Interruption {
    Interruption::Failed(Failure { cause, message, violations: Vec::new() })
}
