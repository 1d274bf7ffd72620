//! Finite-element generator against closed forms, another code and invariants.

mod annulus;
mod at_speed;
mod axis;
mod axis_found;
mod beam;
mod calculix;
#[path = "../properties/campaign.rs"]
mod campaign;
mod centrifugal;
mod conformity;
#[path = "../solid/deck.rs"]
mod deck;
mod disk;
mod disk_mesh;
mod eigen;
mod element;
mod euler;
#[path = "../properties/fixed.rs"]
mod fixed;
mod gaps;
mod gyroscopic;
mod impeller_a;
mod impeller_mesh;
mod mesh_closed_forms;
mod mesh_kinds;
#[path = "../solid/meshes.rs"]
mod meshes;
mod packed;
mod plate;
mod presets;
mod random_wheels;
mod sector;
mod shroud;
mod singular_mass;
mod skew_tip;
#[path = "../physics/to_the_end.rs"]
mod to_the_end;
mod wheel;
