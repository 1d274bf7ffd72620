//! Sources of fields of a model: its stored reduction, the basis beside it, and its nodes and elements.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::engine::Engine;
use super::handle::Jobs;
use super::static_wheel::{self, StaticWheelError};
use crate::analysis::fields::{BasisProduct, FieldSector};
use crate::analysis::run::ReducedSector;
use crate::analysis::stress::StaticWheel;
use crate::dynamics::reduction::{ReducedWheel, ReductionError};
use crate::package::{self, Limits, PackageError};
use crate::store::StoreError;
use crate::store::bases::BasisFolder;

/// Bytes of memory for each own DOF: tables of the package as they are read, nodes, the stress operator.
const DOF_MEMORY: u64 = 6 << 10;

/// Memory in bytes of a sector as [`field_sector`] reads it.
pub fn sector_memory(own_dofs: u32) -> u64 {
    u64::from(own_dofs) * DOF_MEMORY
}

/// Reads nodes and elements of a package of so many `sectors`.
///
/// # Errors
/// Errors of reading the package.
pub fn field_sector(package: &Path, sectors: usize) -> Result<FieldSector, PackageError> {
    let limits = Limits::default();
    let nodes = package::read_nodes(package, &limits)?;
    let mesh = package::read_mesh(package, &limits)?;
    let axis = package::read_places(package, &limits)?.axis;
    FieldSector::new(sectors, axis, nodes, mesh)
        .ok_or_else(|| PackageError::Io { source: io::Error::other("its axis has no direction") })
}

/// Bytes of a column for each own DOF and nodal diameter: what the basis gives, displacement, and stress twice.
const COLUMN_MEMORY: u64 = 16 * (1 + 1 + 2 * 2);

/// Source of fields of a model: its stored reduction, the basis beside it, and its package.
#[derive(Debug, Clone)]
pub struct FieldSource {
    reduced: Arc<ReducedSector>,
    basis: BasisFolder,
    package: PathBuf,
    /// Model and modes per speed of the reduction, and the engine that has it in memory.
    of: (Arc<Engine>, String, u32),
}

impl Jobs {
    /// Source of fields of `model`, if it has been reduced with so many modes.
    ///
    /// # Errors
    /// Errors of the store.
    pub async fn field_source(
        &self,
        model: &str,
        modes_per_speed: u32,
    ) -> Result<Option<FieldSource>, StoreError> {
        let store = &self.engine.store;
        let reduced = self.engine.reductions.stored(model, modes_per_speed).await?;
        let Some(reduced) = reduced else { return Ok(None) };
        Ok(Some(FieldSource {
            reduced,
            basis: store.basis(model, modes_per_speed),
            package: store.package(model).await?,
            of: (Arc::clone(&self.engine), model.to_owned(), modes_per_speed),
        }))
    }

    /// Wheel under its centrifugal load, solved if nobody has asked for it or for stress before; `None` for a package without a mesh.
    ///
    /// # Errors
    /// A package that cannot be read, or a wheel that cannot be solved.
    pub async fn static_wheel(
        &self,
        source: &FieldSource,
        own_dofs: u32,
    ) -> Result<Option<StaticWheel>, StaticWheelError> {
        // As much as a reduction, if it must be solved.
        let memory = self.engine.memory.claim(own_dofs.into()).await;
        let source = source.clone();
        let made = tokio::task::spawn_blocking(move || {
            let _memory = memory;
            static_wheel::from_package(&source.package, (&source.basis, &source.reduced.wheel), &|_, _| true)
        });
        made.await.unwrap_or(Err(StaticWheelError::Unsolved(ReductionError::Cancelled)))
    }
}

impl FieldSource {
    /// Reduction from which the fields are made.
    pub fn reduced(&self) -> &ReducedSector {
        &self.reduced
    }

    /// Whether the casing is on the side that the axis points to: the blades are seen from there.
    pub fn opens_along_axis(&self) -> bool {
        self.reduced.wheel.contact.iter().map(|node| node.normal[2]).sum::<f64>() >= 0.0
    }

    /// Memory in bytes that a field with so many columns of each nodal diameter takes while it is made and written.
    pub fn memory(&self, own_dofs: u32, columns: usize) -> u64 {
        let harmonics = self.reduced.wheel.harmonics.len() as u64;
        u64::from(own_dofs) * (DOF_MEMORY + COLUMN_MEMORY * columns as u64 * harmonics)
    }

    /// Reads nodes and elements, with what stress needs if it is wanted. Stress is claimed outside a radius about contact nodes, which
    /// is their mean distance where none is given.
    ///
    /// # Errors
    /// Errors of reading the package.
    pub fn sector(&self, stress: bool, excluded_radius: Option<f64>) -> Result<FieldSector, PackageError> {
        let sector = field_sector(&self.package, self.reduced.wheel.sectors)?;
        Ok(if stress { sector.with_stress(excluded_radius) } else { sector })
    }

    /// Calls `make` with the wheel and products of its basis.
    pub fn with_basis<T>(&self, make: impl FnOnce(&ReducedWheel, BasisProduct<'_>) -> T) -> T {
        let wheel = &self.reduced.wheel;
        make(wheel, &mut |harmonic, columns| {
            self.basis.product(wheel, harmonic, columns).inspect_err(|_| {
                let (engine, model, modes_per_speed) = &self.of;
                engine.reductions.forget(model, *modes_per_speed);
            })
        })
    }
}
