//! Branches of periodic responses along one parameter of their scene: [`leg::branch_leg`] follows them some points further.

mod course;
mod crests;
mod events;
mod family;
mod kept;
pub(crate) mod leg;
pub(crate) mod plan;
mod told;

pub use course::Course;
