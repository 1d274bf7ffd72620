//! Branches of periodic responses over a number of their scene: [`leg::branch_leg`] follows them some points further.

mod course;
mod events;
mod family;
pub(crate) mod leg;
mod told;

pub use course::Course;
pub(crate) use family::KEPT;
