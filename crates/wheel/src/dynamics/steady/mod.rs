//! Steady states directly (docs/method.md, Steady states): periodic responses as fixed points of the map over a passage, and
//! whether they last.
//!
//! [`periodic`] finds them, [`tangent`] is the derivative of the map, and [`multipliers`] are its eigenvalues there.

pub mod multipliers;
#[cfg(test)]
mod one_sided_spring;
pub mod periodic;
pub mod tangent;
#[cfg(test)]
mod tests;
