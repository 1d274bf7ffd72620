//! Kinds of jobs: a folder and a row of the [`list`] for each.
//!
//! The folder has the request, the request as it is resolved, the check of one against the other, the plan and the computation; its
//! `mod.rs` puts them together as a [`kind::Kind`]. Nothing outside knows a kind by name except the routes of its results.

pub mod branches;
pub mod campaign;
pub mod case_study;
pub mod document;
pub mod kind;
pub mod list;
pub mod modal_analysis;
pub mod plan;
pub mod run_up;
pub mod study;
pub mod sweep;
