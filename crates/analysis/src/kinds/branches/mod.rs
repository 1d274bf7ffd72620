//! Branches of periodic responses along one parameter of their scene.

pub(crate) mod course;
pub(crate) mod crests;
pub(crate) mod events;
pub(crate) mod family;
pub(crate) mod kept;
pub(crate) mod kind;
pub(crate) mod leg;
pub(crate) mod plan;
pub mod request;
pub(crate) mod resolve;
pub mod resolved;
pub mod result;
pub(crate) mod told;

pub use kind::{BRANCHES, LEGS};
