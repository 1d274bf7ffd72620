//! Verbs of the analysis under one name: all that the service may ask of the physics.

pub use crate::accuracy::choice::next;
pub use crate::accuracy::climb::{Next, Resources};
pub use crate::accuracy::control::{FinerRun, control_requests, error_estimate};
pub use crate::accuracy::modes::{NextModes, next_modes};
pub use crate::accuracy::study::work_precision;
pub use crate::accuracy::trial::run_trial;
pub use crate::branches::Course;
pub use crate::branches::leg::branch_leg;
pub use crate::branches::plan::{branches_memory, plan_branches};
pub use crate::calibration::Calibration;
pub use crate::campaign::answer::campaign;
pub use crate::campaign::more::more_designs;
pub use crate::campaign::plan::plan_campaign;
pub use crate::check::check;
pub use crate::contact::{force_map, force_row};
pub use crate::effects::casing::convert::{clearances, heights};
pub use crate::effects::casing::measured::{LineError, MeasuredLine, measured_casing};
pub use crate::histories::{histories_wanted, speed_histories};
pub use crate::modal::modal_analysis;
pub use crate::model::{MeshFacts, ModelFacts, ReducedSector};
pub use crate::plan::{histories_memory, most_basis_bytes, plan_modal_analysis, plan_sweep, trial_memory};
pub use crate::prepare::prepare;
pub use crate::refine::refine;
pub use crate::request::Setting;
pub use crate::resolve::branches::resolve_branches;
pub use crate::resolve::campaign::{CampaignDesigns, ComparedModel, resolve_campaign};
pub use crate::resolve::case_study::{histories_of, resolve_case_study};
pub use crate::resolve::run_up::resolve_run_ups;
pub use crate::resolve::sensors::{name_nodes, place_sensors};
pub use crate::resolve::study::resolve_study;
pub use crate::resolve::{resolve_modal_analysis, resolve_sweep};
pub use crate::resolved::TrialRequest;
pub use crate::result::{
    Choice, ErrorEstimate, Estimate, Histories, ModalAnalysisPlan, ModesChoice, PlacedSensor, Refinement,
    SweepPlan, Trial, WorkPrecision,
};
pub use crate::run_up::march::{RunUpCourse, run_up_leg};
pub use crate::run_up::plan::{plan_run_ups, run_ups_memory};
pub use crate::run_up::told::{run_ups, spectrogram};
pub use crate::speed::run_speed;
pub use crate::summary::{
    critical_indices, critical_speeds, fixed_frame_orders, fixed_frame_row, interaction_map,
    map_engine_orders, map_row, nothing_completed,
};
pub use crate::sweep_stress::sweep_stress;
pub use crate::tips::wheel_critical_speeds;
pub use rubmap_wheel::revision::{REVISION, VERSION};
pub use rubmap_wheel::vectors::vectors;
