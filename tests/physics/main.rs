//! Physics against independent truth: explicitly assembled wheels, a literal dense integrator, invariants.

mod coriolis;
mod cyclic_structure;
mod dense_agreement;
mod fields;
#[path = "../properties/fixed.rs"]
mod fixed;
mod fixtures;
mod histories;
mod impeller_a;
mod invariants;
mod modal_criterion;
mod node_sensors;
#[path = "../oracle/mod.rs"]
mod oracle;
mod plain_agreement;
mod run_ups;
mod schemes;
mod sweep;
mod to_the_end;
