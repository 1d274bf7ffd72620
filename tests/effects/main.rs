//! Effects of a scene in time: held against a literal model of the same equations, alone, in pairs and all together,
//! against closed forms, and in the limits in which they vanish.

mod agreement;
mod closed_forms;
mod disc;
mod door;
#[path = "../physics/fixtures.rs"]
#[allow(dead_code, reason = "shared with the physics tests, which use all of it")]
mod fixtures;
mod frequencies;
#[path = "../oracle/heights.rs"]
mod heights;
mod limits;
mod literal;
mod period_doubling;
mod random_scenes;
mod responses;
mod scene;
#[path = "../hard_cases/support.rs"]
#[allow(dead_code, reason = "shared with the hard cases, which use all of it")]
mod support;
