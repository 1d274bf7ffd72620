//! Kinds of jobs: a folder and a row of the [`list`] for each.
//!
//! The folder has the request, the resolved request, the check that leads from one to the other, the plan, the computation and the results;
//! its `kind.rs` puts them together as a [`kind::Kind`]. Adding one: CONTRIBUTING, A kind of job.

pub mod branches;
pub mod campaign;
pub mod case_study;
pub mod document;
pub mod kind;
pub mod list;
pub mod modal_analysis;
pub mod name;
pub mod plan;
pub mod run_up;
pub mod study;
pub mod sweep;
