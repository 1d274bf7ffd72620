//! Stress in the coordinates of a reduction: read, or made from its basis and stored.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::static_wheel::{StaticWheelError, static_wheel};
use crate::analysis::error::AnalysisError;
use crate::analysis::monitor::Monitor;
use crate::analysis::stress::{ReducedStress, StressMaker};
use crate::dynamics::reduction::{ReducedWheel, ReductionError};
use crate::package::{self, Limits};
use crate::store::bases::BasisFolder;

/// Inputs from which the stress is made.
#[derive(Debug)]
pub(super) struct Making {
    pub(super) package: PathBuf,
    pub(super) basis: BasisFolder,
    pub(super) wheel: Arc<ReducedWheel>,
    pub(super) excluded_radius: f64,
    pub(super) monitor: PhaseMonitor,
}

impl Making {
    /// Stress of the reduction; what is stored is not made again unless it is damaged. The inner error is that of files beside the reduction.
    pub(super) fn stress(&self) -> Result<io::Result<ReducedStress>, Interruption> {
        match self.read_or_make()? {
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                tracing::warn!(%error, "the stress of a reduction cannot be read; making it again");
                match self.basis.remove_stress(&self.wheel) {
                    Ok(()) => self.read_or_make(),
                    Err(error) => Ok(Err(error)),
                }
            }
            found => Ok(found),
        }
    }

    fn read_or_make(&self) -> Result<io::Result<ReducedStress>, Interruption> {
        let limits = Limits::default();
        let mesh = package::read_mesh(&self.package, &limits).map_err(Interruption::stored_package)?;
        let Some(mesh) = mesh else {
            return Ok(Err(io::Error::new(io::ErrorKind::InvalidData, "the package has no mesh")));
        };
        let nodes = package::read_nodes(&self.package, &limits).map_err(Interruption::stored_package)?;
        let maker = StressMaker::new(&mesh, &nodes);
        let places = maker.operator().places().len();
        for reduced in &self.wheel.harmonics {
            if self.basis.has_stress(reduced, places) {
                continue;
            }
            if self.monitor.is_cancelled() {
                return Err(Interruption::NotWanted);
            }
            let share = reduced.harmonic as f64 / self.wheel.harmonics.len() as f64;
            self.monitor
                .progress(share, &format!("stress of the basis, nodal diameter {}", reduced.harmonic));
            let made = self.basis.open(reduced).and_then(|basis| {
                let rows = maker.harmonic(reduced, basis.dofs(), &mut |_, dof| basis.row(dof))?;
                self.basis.keep_stress(reduced, &rows)
            });
            if let Err(error) = made {
                return Ok(Err(error));
            }
        }
        let watch = |share: f64, phase: &str| {
            self.monitor.progress(share, phase);
            !self.monitor.is_cancelled()
        };
        let fixed = static_wheel(&self.package, (&self.basis, &self.wheel), &maker, &watch)?.stress;
        let load = |harmonic: usize, kept: &[usize]| {
            self.basis.stress(&self.wheel.harmonics[harmonic], places, kept)
        };
        Ok(ReducedStress::load(&mesh, maker.operator(), &self.wheel, self.excluded_radius, fixed, load))
    }
}

impl From<StaticWheelError> for Interruption {
    fn from(error: StaticWheelError) -> Self {
        let error = match error {
            StaticWheelError::Package(error) => return Self::stored_package(error),
            StaticWheelError::Unsolved(error) => error,
        };
        match error {
            ReductionError::Cancelled => AnalysisError::Cancelled,
            ReductionError::Memory { needed_bytes, allowed_bytes } => {
                AnalysisError::Memory { needed_bytes, allowed_bytes }
            }
            ReductionError::Model(error) => error.into(),
        }
        .into()
    }
}
