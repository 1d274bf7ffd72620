//! The verbs, gathered under one name: what the service may ask of the physics.

pub use super::accuracy::choice::{Choice, Next, Resources, next};
pub use super::accuracy::control::{ErrorEstimate, FinerRun, control_requests, error_estimate};
pub use super::accuracy::modes::{ModesChoice, NextModes, next_modes};
pub use super::accuracy::study::{Histories, WorkPrecision, work_precision};
pub use super::accuracy::study_request::{StudyRequest, resolve_study};
pub use super::accuracy::trial::{Setting, Trial, TrialRequest, run_trial};
pub use super::calibration::Calibration;
pub use super::modal::modal_analysis;
pub use super::model::{ModelFacts, ReducedSector, prepare};
pub use super::plan::{
    Estimate, ModalAnalysisPlan, SweepPlan, plan_modal_analysis, plan_sweep, trial_memory,
};
pub use super::refine::{Refinement, refine};
pub use super::resolve::{resolve_modal_analysis, resolve_sweep};
pub use super::speed::run_speed;
pub use super::stepping::check;
pub use super::summary::{critical_speeds, interaction_map, map_row, nothing_completed};

/// Version of the code, stamped on every result.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
