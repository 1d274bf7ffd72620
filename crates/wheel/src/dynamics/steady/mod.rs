//! Steady states, found directly (docs/method.md, Steady states): periodic responses as fixed points of a return map, and their stability.
//!
//! [`response`] is the whole of it for a scene: [`periodic`] finds a response, [`stability`] judges it. [`tangent`] is the derivative of
//! the map and [`multipliers`] are its eigenvalues. [`branch`] follows a response while a number of its scene changes.

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
