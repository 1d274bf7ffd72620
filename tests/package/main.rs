//! Importer as its users meet it: good packages, bad ones, damaged ones, and what a good one becomes.

mod agreement;
mod bad;
mod bad_meshes;
mod calculix;
mod calculix_deck;
mod damaged;
mod equivalent;
mod findings;
#[path = "../properties/fixed.rs"]
mod fixed;
mod from_mesh;
mod from_pages;
mod gyroscopic;
mod joints;
mod looks;
mod mesh;
mod npz;
mod sample;
mod shared_cases;
mod shared_models;
mod wheel;
