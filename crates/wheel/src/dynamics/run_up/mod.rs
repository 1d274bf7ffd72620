//! A wheel that changes its speed (docs/method.md, Run-up and run-down).
//!
//! The speed is given, Ω(t), and its angle θ(t) = ∫Ω dt. A run is cut into segments that begin and end at samples of a revolution. Within
//! one the wheel is that of its mean speed, and its instants are equal steps of the angle; both ends are where θ(t) is, so that angles do
//! not drift, and in between they are off by no more than
//!
//! ```text
//! |θ − θ_s| ≤ max|Ω̇| T²/8        T: how long the segment takes
//! ```
//!
//! What acts by the angle (casing, engine orders) is thus exact to a stated tolerance, what acts by the speed (K(Ω), damping ratios,
//! Coriolis forces) is of the mean of a segment, an error of the same order. From one segment to the next the state is handed on in the
//! coordinates of the reduction, which do not change with the speed.

pub mod profile;
pub mod segments;
#[cfg(test)]
mod tests;
