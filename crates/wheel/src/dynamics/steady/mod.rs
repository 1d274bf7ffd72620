//! Steady states directly (docs/method.md, Steady states): periodic responses as fixed points of the map over a passage, and
//! whether they last.
//!
//! [`response`] is the whole of it for a scene: [`periodic`] finds a response, [`stability`] says whether it lasts. [`tangent`] is the
//! derivative of the map and [`multipliers`] are its eigenvalues. [`branch`] follows a response while a number of its scene changes.

pub mod branch;
mod coupling;
mod damping;
#[cfg(test)]
mod harmonic_balance;
pub mod multipliers;
#[cfg(test)]
mod one_sided_spring;
pub mod periodic;
pub mod response;
pub mod stability;
pub mod tangent;
#[cfg(test)]
mod tests;
