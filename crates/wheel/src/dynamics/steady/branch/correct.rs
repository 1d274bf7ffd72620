//! Correction from beside a branch to it: Newton's method for its point in a plane.
//!
//! ```text
//! [ I − T   −∂P/∂p ] [ δx ]   [ P(x) − x ]
//! [  τ_x      τ_p  ] [ δp ] = [     0    ]        τ: the direction in which the branch is followed
//! ```
//!
//! The last line keeps the matrix regular where I − T is not: at a fold (Keller). All in units of the metric
//! ds² = (‖δx‖/‖x‖)² + (δp/span)². T is exact, ∂P/∂p a difference of two maps.

use super::{Branch, Lost, Motion, add};
use crate::dynamics::steady::periodic::repeats;
use crate::dynamics::steady::tangent::Tangent;
use rubmap_numerics::gmres;

/// Residual ‖P(x) − x‖ / ‖x‖ at which a point is found.
pub const FOUND: f64 = 1e-8;

/// Largest number of steps of Newton's method: from a good prediction it takes two to four.
const STEPS: usize = 8;

/// Tolerance to which the equations of a Newton step are solved, and their most products.
const SOLVED: f64 = 1e-3;
const PRODUCTS: usize = 200;

/// Shares of a Newton step that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];

/// Relative change of p, or of the span if that is more, over which the map is differenced.
const DIFFERENCE: f64 = 1e-7;

/// Point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Motion at the point.
    pub motion: Motion,
    /// Residual ‖P(x) − x‖ / ‖x‖.
    pub residual: f64,
    /// Number of steps of Newton's method.
    pub steps: usize,
    /// Revolutions of the wheel that the correction took.
    pub revolutions: f64,
}

/// Motion beside a branch.
struct Beside {
    motion: Motion,
    state: Vec<f64>,
    /// Difference P(x) − x.
    off: Vec<f64>,
    residual: f64,
}

impl Branch<'_> {
    /// Solves for the point of the branch that lies beside `guess` in the plane across `along`, a direction of the scene at `at`.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn correct(&self, guess: Motion, along: &Motion, at: f64) -> Result<Found, Lost> {
        let mut revolutions = 0.0;
        let mut best = self.beside(guess, &mut revolutions)?;
        for steps in 0..=STEPS {
            if best.residual <= FOUND {
                return Ok(Found { motion: best.motion, residual: best.residual, steps, revolutions });
            }
            let step = self.step(&best, along, at, &mut revolutions)?;
            let better = SHARES.into_iter().find_map(|share| {
                let value = best.motion.value + share * step.value;
                let moved = add(&best.motion.state, &step.state, share);
                let beside = self
                    .carried(&moved, best.motion.value, value)
                    .and_then(|state| self.beside(Motion { value, state }, &mut revolutions));
                match beside {
                    Ok(beside) if beside.residual > (1.0 - 0.1 * share) * best.residual => None,
                    Err(Lost::Unreachable(_) | Lost::Passage(_)) => None,
                    other => Some(other),
                }
            });
            let Some(better) = better else { break };
            best = better?;
        }
        Err(Lost::NotFound { residual: best.residual })
    }

    /// Residual ‖P(x) − x‖ / ‖x‖ of a motion.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn off(&self, motion: &Motion) -> Result<f64, Lost> {
        Ok(self.beside(motion.clone(), &mut 0.0)?.residual)
    }

    /// Whether the changes of two motions over a lap, P(x) − x, point one way at `a` and the other at `b`.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn turns_about(&self, a: &Motion, b: &Motion) -> Result<bool, Lost> {
        let [at_a, at_b] = [a, b].map(|motion| self.beside(motion.clone(), &mut 0.0));
        let (at_a, at_b) = (at_a?.off, at_b?.off);
        let at_a = self.at(a.value, |passage| passage.stepped(&at_a))?;
        let at_a = self.carried(&at_a, a.value, b.value)?;
        self.at(b.value, |passage| dot(&passage.state_of(&at_a), &at_b) < 0.0)
    }

    fn beside(&self, motion: Motion, revolutions: &mut f64) -> Result<Beside, Lost> {
        let (state, image) = self.at(motion.value, |passage| {
            let state = passage.state_of(&motion.state);
            let image = passage.map(&state);
            *revolutions += passage.revolutions();
            image.map(|image| (state, image))
        })??;
        let off = image.iter().zip(&state).map(|(image, x)| image - x).collect();
        Ok(Beside { residual: repeats(&state, &image), motion, state, off })
    }

    /// Newton step from `best`, in the modes there.
    fn step(&self, best: &Beside, along: &Motion, at: f64, revolutions: &mut f64) -> Result<Motion, Lost> {
        let value = best.motion.value;
        let change = DIFFERENCE * value.abs().max(self.span);
        let slope = self.slope(best, change, revolutions)?;
        let direction = self.carried(&along.state, at, value)?;
        let size = size(&best.state);
        let span = self.span;
        self.at(value, |passage| {
            // What touches on its way is to be that of this state.
            passage.map(&best.state)?;
            let across: Vec<f64> = passage.state_of(&direction).iter().map(|x| x / size).collect();
            let across_value = along.value / span;
            let mut right: Vec<f64> = best.off.iter().map(|x| x / size).collect();
            right.push(0.0);
            let tangent = Tangent::of(passage);
            let product = |y: &[f64]| {
                let (&p, x) = y.split_last().unwrap_or((&0.0, &[]));
                let mut moved = x.to_vec();
                tangent.follow(&mut moved);
                let rows = x.iter().zip(&moved).zip(&slope);
                let mut left: Vec<f64> = rows.map(|((x, t), s)| x - t - s * p * span / size).collect();
                left.push(dot(&across, x) + across_value * p);
                left
            };
            let mut step = gmres::solve(product, &right, SOLVED, PRODUCTS).x;
            let by = step.pop().unwrap_or(0.0) * span;
            step.iter_mut().for_each(|x| *x *= size);
            let state = passage.stepped(&step);
            *revolutions += passage.revolutions();
            Ok(Motion { value: by, state })
        })?
    }

    /// Slope ∂(P(x) − x)/∂p at a fixed motion.
    fn slope(&self, best: &Beside, change: f64, revolutions: &mut f64) -> Result<Vec<f64>, Lost> {
        let (here, there) = (best.motion.value, best.motion.value + change);
        let moved = self.carried(&best.motion.state, here, there)?;
        let off = self.at(there, |passage| {
            let state = passage.state_of(&moved);
            let image = passage.map(&state);
            *revolutions += passage.revolutions();
            image.map(|image| {
                let off: Vec<f64> = image.iter().zip(&state).map(|(image, x)| image - x).collect();
                passage.stepped(&off)
            })
        })??;
        let off = self.carried(&off, there, here)?;
        let off = self.at(here, |passage| passage.state_of(&off))?;
        Ok(off.iter().zip(&best.off).map(|(there, here)| (there - here) / change).collect())
    }
}

/// Norm ‖x‖, by which changes are measured; 1 at rest.
pub(super) fn size(x: &[f64]) -> f64 {
    let length = dot(x, x).sqrt();
    if length > 0.0 { length } else { 1.0 }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
