//! Run-up and run-down: a wheel that changes its speed (docs/method.md, Run-up and run-down).
//!
//! The speed Ω(t) is given, and with it the angle θ(t) = ∫Ω dt. A run is cut into segments that begin and end at samples of a revolution.
//! Within a segment the wheel is that of the mean speed, and its instants are equal steps of the angle; both ends are where θ(t) is, so
//! that angles do not drift, and in between they are off by no more than
//!
//! ```text
//! |θ − θ_s| ≤ max|Ω̇| T²/8        T: duration of the segment
//! ```
//!
//! Effects that depend on the angle (casing, engine orders) are thus exact to a stated tolerance; effects of the speed (K(Ω), damping
//! ratios, Coriolis forces) are those of the mean of a segment, an error of the same order. From one segment to the next the state is
//! handed on in the coordinates of the reduction, which do not change with the speed.

pub mod profile;
pub mod segments;
#[cfg(test)]
mod tests;
