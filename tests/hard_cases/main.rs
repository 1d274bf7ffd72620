//! Cases that break lesser codes. Each file says what it threatens and what is guaranteed here; docs/stability.md is
//! the table of them.

mod double_eigenvalues;
#[path = "../physics/fixtures.rs"]
#[allow(dead_code, reason = "shared with the physics tests, which use all of it")]
mod fixtures;
mod identical_stiffness;
mod indefinite_stiffness;
mod linear_resonance;
mod lobe_counts;
mod near_equal_speeds;
mod nearly_dependent_bases;
#[path = "../oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the physics tests, which use all of it")]
mod oracle;
mod random_wheels;
mod rigid_boundary;
mod rotation_reversed;
mod sector_counts;
mod stiffness_contrast;
mod support;
mod units;
