//! List of the kinds of jobs.

use super::branches::kind::BRANCHES;
use super::campaign::kind::CAMPAIGN;
use super::case_study::kind::CASE_STUDY;
use super::kind::Kind;
use super::modal_analysis::kind::MODAL_ANALYSIS;
use super::run_up::kind::RUN_UP;
use super::study::kind::STUDY;
use super::sweep::kind::SWEEP;

/// Kinds of jobs that compute from models, in the order in which people meet them.
pub static KINDS: &[&Kind] = &[&SWEEP, &MODAL_ANALYSIS, &CASE_STUDY, &BRANCHES, &RUN_UP, &CAMPAIGN, &STUDY];
