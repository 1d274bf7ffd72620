//! Verbs of the analysis under one name: all that the service may ask of the physics.

pub use crate::accuracy::choice::next;
pub use crate::accuracy::climb::{Next, Resources};
pub use crate::accuracy::control::{FinerRun, control_requests, error_estimate};
pub use crate::accuracy::modes::{NextModes, next_modes};
pub use crate::accuracy::trial::run_trial;
pub use crate::calibration::Calibration;
pub use crate::check::check;
pub use crate::contact::{force_map, force_row};
pub use crate::effects::casing::convert::{clearances, heights};
pub use crate::effects::casing::measured::{LineError, MeasuredLine, measured_casing};
pub use crate::fields::BasisProduct;
pub use crate::histories::{histories_wanted, speed_histories};
pub use crate::kinds::campaign::answer::campaign;
pub use crate::kinds::modal_analysis::compute::modal_analysis;
pub use crate::kinds::run_up::march::run_up_leg;
pub use crate::kinds::run_up::resolve::resolve_run_ups;
pub use crate::kinds::run_up::told::{run_ups, spectrogram};
pub use crate::kinds::study::resolve::resolve_study;
pub use crate::kinds::study::work_precision::work_precision;
pub use crate::measured::{judge_by_measures, largest_motion, speeds_to_measure};
pub use crate::model::{MeshFacts, ModelFacts, ReducedSector};
pub use crate::nonlinear::{
    BasisProjection, LargestMotion, MeasuredMotion, NotMeasured, bending_bytes, blade_bending, measure,
    measuring_bytes,
};
pub use crate::plan::{histories_memory, most_basis_bytes, trial_memory};
pub use crate::prepare::prepare;
pub use crate::refine::refine;
pub use crate::request::Setting;
pub use crate::resolve::sensors::{name_nodes, place_sensors};
pub use crate::resolve::{resolve_modal_analysis, resolve_sweep};
pub use crate::resolved::TrialRequest;
pub use crate::result::{
    Choice, ErrorEstimate, Estimate, Histories, ModalAnalysisPlan, ModesChoice, PlacedSensor, Refinement,
    SweepPlan, Trial, WorkPrecision,
};
pub use crate::speed::run_speed;
pub use crate::summary::{
    critical_indices, critical_speeds, driven_crossings, fixed_frame_orders, fixed_frame_row,
    interaction_map, map_engine_orders, map_row, nothing_completed,
};
pub use crate::sweep_stress::{strengths_of_sweep, sweep_stress};
pub use crate::tips::wheel_critical_speeds;
pub use crate::verdict::{Evidence, judge, level};
pub use rubmap_wheel::revision::{REVISION, VERSION};
pub use rubmap_wheel::vectors::vectors;
