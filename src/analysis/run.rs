//! The verbs.

use super::error::{AnalysisError, Violation};
use super::monitor::Monitor;
use super::request::{ModalAnalysisRequest, SweepRequest};
use super::result::{Campbell, CriticalSpeeds, InteractionMap, ReductionReport, SpeedResult};
use crate::dynamics::sector::{SectorModel, Units};
use serde::{Deserialize, Serialize};

/// A reduced sector: all that simulations need of a model. Computed once per (model, `modes_per_speed`) and stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedSector {
    /// Units of the model.
    pub units: Units,
    /// What the reduction found and cost.
    pub report: ReductionReport,
}

/// The few facts about a model that requests are checked against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
pub struct ModelFacts {
    /// Free text of the user.
    pub name: String,
    /// Number of sectors N.
    pub sectors: u32,
    /// Number of contact nodes.
    pub contact_nodes: u32,
    /// Own DOF of a sector (internal with the low face, and contact).
    pub own_dofs: u32,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Units.
    pub units: Units,
}

impl ModelFacts {
    /// The facts of `sector`.
    pub fn of(_sector: &SectorModel) -> Self {
        unimplemented!()
    }
}

/// Checks a sweep request against its model and fills in defaults (sensors); all violations at once.
pub fn resolve_sweep(_request: SweepRequest, _facts: &ModelFacts) -> Result<SweepRequest, Vec<Violation>> {
    unimplemented!()
}

/// Checks a modal-analysis request against its model; all violations at once.
pub fn resolve_modal_analysis(
    _request: ModalAnalysisRequest,
    _facts: &ModelFacts,
) -> Result<ModalAnalysisRequest, Vec<Violation>> {
    unimplemented!()
}

/// Reduces a sector (METHOD §2–§4). Deterministic; runs on the calling thread.
pub fn prepare(
    _sector: &SectorModel,
    _modes_per_speed: u32,
    _monitor: &dyn Monitor,
) -> Result<ReducedSector, AnalysisError> {
    unimplemented!()
}

/// Checks what only the reduced sector can tell, before any speed runs: a fixed step against the stability limit at
/// every speed of the sweep.
pub fn check(
    _reduced: &ReducedSector,
    _request: &SweepRequest,
    _monitor: &dyn Monitor,
) -> Result<(), AnalysisError> {
    unimplemented!()
}

/// Simulates speed `index` of a sweep. Deterministic; runs on the calling thread. A speed that diverges or cannot be
/// evaluated is a result (with its status), not an error; the only error is cancellation.
pub fn run_speed(
    _reduced: &ReducedSector,
    _request: &SweepRequest,
    _index: usize,
    _monitor: &dyn Monitor,
) -> Result<SpeedResult, AnalysisError> {
    unimplemented!()
}

/// Natural frequencies over speed and the linear criterion.
pub fn modal_analysis(
    _reduced: &ReducedSector,
    _request: &ModalAnalysisRequest,
    _monitor: &dyn Monitor,
) -> Result<Campbell, AnalysisError> {
    unimplemented!()
}

/// The interaction map of `sensor` (index into the request's sensors) from the speeds finished so far.
pub fn interaction_map(
    _request: &SweepRequest,
    _units: &Units,
    _finished: &[SpeedResult],
    _sensor: usize,
    _nodal_diameter: Option<u32>,
) -> InteractionMap {
    unimplemented!()
}

/// Critical speeds of a sweep from all its speeds, beside the linear prediction.
pub fn critical_speeds(
    _reduced: &ReducedSector,
    _request: &SweepRequest,
    _finished: &[SpeedResult],
) -> Result<CriticalSpeeds, AnalysisError> {
    unimplemented!()
}
