//! Validity of linear theory, measured once all speeds of a sweep are finished.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::mesh::mesh_and_nodes;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::error::AnalysisError;
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::Point;
use crate::analysis::run::{self, MeasuredMotion, NotMeasured, ReducedSector};
use crate::dynamics::nodes::SectorNode;
use crate::solid::mesh::SectorMesh;

/// Measures validity at the speeds of a finished sweep that matter and stores the points with it; points without a doubt, and those of models
/// without a mesh or a basis, stay as they are.
pub(super) async fn measured(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    reduced: &Arc<ReducedSector>,
    mut points: Vec<Point>,
) -> Result<Vec<Point>, Interruption> {
    let speeds = run::speeds_to_measure(request, reduced, &points);
    if speeds.is_empty() || request.fields() == Some(false) {
        return Ok(points);
    }
    let package = engine.store.package(request.model()).await?;
    let read = move || mesh_and_nodes(&package);
    let Some(sector) = engine.computing.run(&job.watch, read).await?? else { return Ok(points) };
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let beside = engine.reductions.of_sweep(request, monitor).await?;
    let measured = measured_motions(engine, job, request, &beside, (sector, &speeds)).await?;
    if let Err(error) = &measured {
        tracing::warn!(job.id = %job.id, %error, "the validity of linear theory cannot be measured");
    }
    run::judge_by_measures(&mut points, (reduced, request), &measured);
    patiently(&job.watch, || engine.store.revise_points(job.id, &points)).await?;
    tracing::info!(job.id = %job.id, speeds = speeds.len(), "measured the validity of linear theory");
    Ok(points)
}

/// Measures the largest motion of each of `speeds`; the inner error says why none could be measured.
async fn measured_motions(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    reduced: &Arc<ReducedSector>,
    ((mesh, nodes), speeds): ((SectorMesh, Vec<SectorNode>), &[u32]),
) -> Result<Result<Vec<MeasuredMotion>, NotMeasured>, Interruption> {
    let mut motions = Vec::with_capacity(speeds.len());
    for &index in speeds {
        let bytes = job.speed_bytes.load(Ordering::Relaxed);
        let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
        let (reduced, request) = (Arc::clone(reduced), request.clone());
        let monitor = PhaseMonitor::uncounted(job.watch.clone());
        let simulate = move || run::largest_motion(&reduced, &request, index, &monitor);
        motions.extend(engine.computing.run(&job.watch, simulate).await??);
    }
    let bytes = run::measuring_bytes(&mesh, motions.len());
    let Ok(_memory) = engine.memory.hold(bytes).await else {
        return Ok(Err(NotMeasured::Memory { bytes }));
    };
    let wheel = Arc::clone(&reduced.wheel);
    let basis = engine.store.basis(request.model(), request.modes_per_speed());
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let measure = move || {
        let mut product =
            |harmonic: usize, columns: faer::MatRef<'_, faer::c64>| basis.product(&wheel, harmonic, columns);
        run::measure((&mesh, &nodes), &wheel, &motions, &mut product, &monitor)
    };
    match engine.computing.run_parallel(&job.watch, measure).await? {
        Err(NotMeasured::Cancelled) => Err(AnalysisError::Cancelled.into()),
        measured => Ok(measured),
    }
}
