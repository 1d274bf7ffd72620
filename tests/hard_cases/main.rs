//! Hard cases, which break lesser codes. Each file says what it threatens and what is guaranteed here; docs/stability.md is the table of them.

mod all_nodes_close;
#[path = "../properties/campaign.rs"]
mod campaign;
mod closing_clearances;
mod denormals;
mod double_eigenvalues;
#[path = "../properties/fixed.rs"]
mod fixed;
#[path = "../physics/fixtures.rs"]
#[allow(dead_code, reason = "shared with the physics tests, which use all of it")]
mod fixtures;
mod grazing;
mod identical_stiffness;
mod indefinite_stiffness;
mod indistinguishable_nodes;
mod linear_resonance;
mod lobe_counts;
mod measured_casings;
mod million_steps;
mod modes_at_pi;
mod near_equal_speeds;
mod nearly_dependent_bases;
#[path = "../oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the physics tests, which use all of it")]
mod oracle;
mod random_wheels;
mod restriction_inside;
mod rigid_boundary;
mod rotation_reversed;
mod run_ups;
mod scenes;
mod sector_counts;
mod stability_limit;
mod stiffness_contrast;
mod support;
mod symmetry_breaking;
#[path = "../physics/to_the_end.rs"]
mod to_the_end;
mod unbounded_growth;
mod units;
mod zero_clearance;
