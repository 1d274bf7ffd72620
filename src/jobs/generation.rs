//! Generation of a model from the parameters of the generator: one task from beginning to end.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::patience::{patiently, until_written};
use super::progress::PhaseMonitor;
use crate::analysis::monitor::Monitor;
use crate::assembly::assembly_bytes;
use crate::impeller::{ImpellerError, generate, impeller_sector};
use crate::import::CheckedPackage;
use crate::kinds::generation::Generation;
use crate::package::Limits;
use crate::store::limits;

/// Generates the package, reads it back as if it had been uploaded, and stores it as a model.
pub(super) async fn run(engine: &Engine, job: &Live) -> Result<(), Interruption> {
    let Some(Generation { parameters }) = job.request.get() else { return Ok(()) };
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let wanted = |fraction: f64, phase: &str| {
        monitor.progress(fraction, phase);
        if monitor.is_cancelled() { Err(Interruption::NotWanted) } else { Ok(()) }
    };

    wanted(0.0, "meshing")?;
    let asked = parameters.clone();
    let (nodes, needed_bytes) = engine
        .computing
        .run(&job.watch, move || {
            let sector = impeller_sector(&asked)?.made_of(&asked.material);
            Ok::<_, ImpellerError>((sector.mesh.nodes.len(), assembly_bytes(&sector)))
        })
        .await??;

    wanted(0.05, "waiting for memory")?;
    // Memory is held until the package is read back: each step may hold all the matrices.
    let mut allowance = engine.memory.claim(3 * nodes as u64).await;
    if !allowance.allows(needed_bytes) && !allowance.is_most() {
        drop(allowance);
        allowance = engine.memory.claim_most().await;
    }
    if let Some(allowed) = allowance.bytes.filter(|_| !allowance.allows(needed_bytes)) {
        return Err(Interruption::generation_memory(needed_bytes, allowed));
    }
    wanted(0.05, "assembling matrices, solving the centrifugal pre-stress")?;
    let asked = parameters.clone();
    let package = engine.computing.run_parallel(&job.watch, move || generate(&asked)).await??;

    wanted(0.5, "writing the package")?;
    let package = Arc::new(package);
    let write = || engine.importer.write(Arc::clone(&package));
    let upload = until_written(&job.watch, write).await??;
    drop(package);

    wanted(0.8, "checking the package")?;
    let read = move || CheckedPackage::read(upload, &Limits::default());
    let package =
        engine.computing.run_parallel(&job.watch, read).await?.map_err(Interruption::generated_package)?;

    wanted(0.95, "keeping the model")?;
    // The model has had its place among the owner's models since the job was accepted.
    let limits = limits::Limits { models: None, ..engine.limits };
    // The model gets the labels that the job has by now.
    let find = || engine.store.job(job.id);
    let labels = patiently(&job.watch, find).await?.map(|job| job.head.labels).unwrap_or_default();
    let store = || engine.importer.store(&job.owner, limits, &labels, &package);
    let (_, new) = until_written(&job.watch, store).await?.map_err(Interruption::limit)?;
    let CheckedPackage { facts, id, .. } = &package;
    tracing::info!(job.id = %job.id, model.id = id, name = facts.name, new, "generated a model");
    finish::complete(engine, job, &[], Some(id)).await
}
