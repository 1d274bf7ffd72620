//! A model from the parameters of the generator: one task from beginning to end.

use std::io::BufWriter;

use super::engine::{Engine, Live};
use super::error::Halt;
use super::finish;
use super::progress::PhaseMonitor;
use crate::analysis::monitor::Monitor;
use crate::analysis::run::ModelFacts;
use crate::impeller::{ImpellerParameters, generate, impeller_sector};
use crate::package::{self, Limits, PackageError};
use crate::store::StoreError;

/// Generates the package, reads it back as if it had been uploaded, and keeps it as a model.
pub(super) async fn run(engine: &Engine, job: &Live, parameters: &ImpellerParameters) -> Result<(), Halt> {
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let wanted = |fraction: f64, phase: &str| {
        monitor.progress(fraction, phase);
        if monitor.is_cancelled() { Err(Halt::NotWanted) } else { Ok(()) }
    };

    wanted(0.0, "meshing")?;
    let asked = parameters.clone();
    let nodes =
        engine.pool.run(move || impeller_sector(&asked).map(|sector| sector.mesh.nodes.len())).await??;

    wanted(0.05, "waiting for memory")?;
    // Until the package is read back: each step may hold all the matrices.
    let _memory = engine.memory.claim(3 * nodes as u64).await;
    wanted(0.05, "assembling matrices, solving the centrifugal pre-stress")?;
    let asked = parameters.clone();
    let package = engine.pool.run_parallel(move || generate(&asked)).await??;

    wanted(0.5, "writing the package")?;
    let (file, upload) = engine.store.new_upload().map_err(StoreError::File)?.into_parts();
    // Nothing is wrong with the package yet: what fails is the disk.
    let unwritten = |error: PackageError| StoreError::File(std::io::Error::other(error));
    engine.pool.run(move || package::write(&package, BufWriter::new(file))).await?.map_err(unwritten)?;

    wanted(0.8, "checking the package")?;
    let path = upload.to_path_buf();
    let read = move || {
        package::read(&path, &Limits::default()).map(|read| (ModelFacts::of(&read.sector), read.digest))
    };
    let (facts, id) = engine.pool.run_parallel(read).await?.map_err(Halt::generated_package)?;

    wanted(0.95, "keeping the model")?;
    let (_, new) = engine.store.insert_model(&id, &facts, upload).await?;
    tracing::info!(job.id = %job.id, model.id = id, name = facts.name, new, "generated a model");
    finish::complete(engine, job, &[], Some(&id)).await
}
