//! The door between physics and service: plain data in, plain data out, a few verbs.
//!
//! - [`run::prepare`] reduces a sector (once per model and `modes_per_speed`);
//! - [`run::check`], [`run::run_speed`] and [`run::modal_analysis`] compute on the reduced sector;
//! - [`run::refine`] adds the speeds that a sweep lacks around its peaks;
//! - [`run::interaction_map`] and [`run::critical_speeds`] assemble the finished speeds of a sweep, [`run::refine`] asks for more;
//! - [`run::speed_histories`] simulates a speed once more and records what happens, [`run::force_map`] gathers contact over all speeds;
//! - [`kinds`] has what each kind of job is asked, plans, computes and answers: branches and run-ups leg by leg, campaigns design by design;
//! - [`run::run_ups`] and [`run::campaign`] put their results together;
//! - [`run::run_trial`] runs one speed to be compared with others: for studies ([`run::work_precision`]), for the choice of settings
//!   ([`run::next`], [`run::next_modes`]) and for the error of a finished sweep ([`run::error_estimate`]).

pub mod accuracy;
mod calibration;
mod check;
mod component;
mod contact;
mod diagram;
mod digits;
mod discretisation;
pub mod effects;
pub mod end_state;
pub mod error;
pub mod euler_load;
pub mod fields;
mod gauge;
mod histories;
pub mod kinds;
mod model;
pub mod monitor;
mod not_runnable;
mod own_load;
mod peak_to_peak;
mod plan;
mod prepare;
mod record;
mod refine;
pub mod request;
mod resolve;
pub mod resolved;
mod response_curve;
pub mod result;
pub mod run;
mod sensed;
mod speed;
mod speed_scene;
mod start;
mod steady;
mod stepping;
mod stiffening;
pub mod stress;
mod summary;
mod sweep_stress;
pub mod tip_growth;
mod tip_thickness;
mod tips;
mod validity;
mod wheel;
