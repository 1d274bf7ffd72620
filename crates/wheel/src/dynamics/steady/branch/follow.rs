//! Steps along a branch, point by point: predicted on the line through the last two, corrected across it.

use super::correct::{Found, dot, size};
use super::{Branch, Lost, Motion, add};
use crate::dynamics::initial::Stepped;

/// Arclength of the first step, and the least of any.
const FIRST: f64 = 0.01;
const LEAST: f64 = 1e-6;

/// Largest arclength of a step.
const MOST: f64 = 0.25;

/// Largest change of p in a step, as a share of its range: it sets how many points a picture of a branch has across.
pub const MOST_OF_SPAN: f64 = 0.02;

/// Factors by which a step grows and shrinks, and steps of Newton's method up to which it grows, from which on it shrinks.
const GROWTH: f64 = 1.4;
const SHRINKAGE: f64 = 0.5;
const EASY: usize = 4;
const HARD: usize = 7;

/// Cosine of the angle up to which a branch may turn within a step: a point beyond belongs to another branch.
const TURNS: f64 = 0.7;

/// Cosine of the angle up to which a branch may turn within a step so short that it may be a corner: branches have corners where another
/// node begins to touch.
const CORNER: f64 = 0.1;
const SHORT: f64 = 1e-3;

/// End of a branch so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Front {
    /// Last point.
    pub last: Motion,
    /// Point before the last; none where the branch begins.
    pub before: Option<Motion>,
    /// Direction of the first step, per unit of arclength.
    pub first: Motion,
    /// Arclength of the next step.
    pub step: f64,
}

/// Result of a step along a branch.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Next point, within the range.
    Point(Found),
    /// Next point, at the edge where the branch leaves the range.
    Edge(Found),
}

impl Front {
    /// Front at the beginning of a branch, to be followed towards larger (`sign` 1) or smaller values (−1).
    pub fn new(start: Motion, span: f64, sign: f64) -> Self {
        let first = Motion { value: sign * span, state: Stepped::default() };
        Self { last: start, before: None, first, step: FIRST }
    }

    /// Front at the beginning of a branch, to be followed in the direction of `state`, which is as large as the motion itself.
    pub fn aside(start: Motion, state: Stepped) -> Self {
        let first = Motion { value: 0.0, state };
        Self { last: start, before: None, first, step: FIRST }
    }

    /// Takes `found` as the last point.
    pub fn move_to(&mut self, found: Motion) {
        self.before = Some(std::mem::replace(&mut self.last, found));
    }
}

impl Branch<'_> {
    /// Solves for the next point of the branch, within `range`, and at its edge exactly; `front` then has the length of the next step, and
    /// has still to be moved. Where a step fails, shorter ones are tried.
    ///
    /// # Errors
    /// [`Lost`] of the shortest step that failed.
    pub fn next(&self, front: &mut Front, range: (f64, f64)) -> Result<Step, Lost> {
        loop {
            let along = self.direction(front)?;
            let of_span = MOST_OF_SPAN / (along.value.abs() / self.span).max(MOST_OF_SPAN / MOST);
            let step = front.step.min(of_span);
            let guess = Motion {
                value: front.last.value + step * along.value,
                state: add(&front.last.state, &along.state, step),
            };
            let ahead = guess.value >= front.last.value;
            let tried = if range.0 < guess.value && guess.value < range.1 {
                self.try_step(guess, &along, step, front).map(|found| {
                    (range.0 < found.motion.value && found.motion.value < range.1)
                        .then_some(Step::Point(found))
                })
            } else {
                Ok(None)
            };
            let tried = match tried {
                // Out of the range: to its edge.
                Ok(None) => {
                    let edge = if ahead { range.1 } else { range.0 };
                    self.edge(edge, &along, front).map(Step::Edge)
                }
                Ok(Some(point)) => Ok(point),
                Err(lost) => Err(lost),
            };
            match tried {
                Ok(taken) => {
                    let (Step::Point(found) | Step::Edge(found)) = &taken;
                    front.step = match found.steps {
                        ..=EASY => (step * GROWTH).min(MOST),
                        HARD.. => step * SHRINKAGE,
                        _ => step,
                    };
                    return Ok(taken);
                }
                Err(lost @ Lost::Cancelled) => return Err(lost),
                Err(lost) if step * SHRINKAGE < LEAST => return Err(lost),
                Err(_) => front.step = step * SHRINKAGE,
            }
        }
    }

    /// Point of the branch at `share` of the way from `a` to `b`, two of its points.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn between(&self, a: &Motion, b: &Motion, share: f64) -> Result<Found, Lost> {
        let way = self.difference(a, b)?;
        let guess = Motion { value: a.value + share * way.value, state: add(&a.state, &way.state, share) };
        let guess = Motion { state: self.carried(&guess.state, a.value, guess.value)?, ..guess };
        self.correct(guess, &way, a.value)
    }

    /// Arclength of the line from `a` to `b`.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn distance(&self, a: &Motion, b: &Motion) -> Result<f64, Lost> {
        let way = self.difference(a, b)?;
        Ok(self.product(&way, &way, a)?.sqrt())
    }

    fn try_step(&self, guess: Motion, along: &Motion, step: f64, front: &Front) -> Result<Found, Lost> {
        let at = front.last.value;
        let guess = Motion { state: self.carried(&guess.state, at, guess.value)?, ..guess };
        let found = self.correct(guess, along, at)?;
        let way = self.difference(&front.last, &found.motion)?;
        let [ahead, way, along] =
            [(&way, along), (&way, &way), (along, along)].map(|(a, b)| self.product(a, b, &front.last));
        let (ahead, way, along) = (ahead?, way?.sqrt(), along?.sqrt());
        // A first step over p knows nothing of what becomes of the motion.
        let knows = front.before.is_some() || front.first.value == 0.0;
        let turns = if step > SHORT { TURNS } else { CORNER };
        let turned = knows && ahead < turns * way * along;
        if turned || way > 2.0 * MOST { Err(Lost::Turned) } else { Ok(found) }
    }

    fn edge(&self, edge: f64, along: &Motion, front: &Front) -> Result<Found, Lost> {
        let share = if along.value == 0.0 { 0.0 } else { (edge - front.last.value) / along.value };
        let guess = Motion { value: edge, state: add(&front.last.state, &along.state, share) };
        let guess = Motion { state: self.carried(&guess.state, front.last.value, edge)?, ..guess };
        self.correct(guess, &Motion { value: self.span, state: Stepped::default() }, edge)
    }

    /// Direction in which the branch goes on, in the modes at the last point, of length one.
    fn direction(&self, front: &Front) -> Result<Motion, Lost> {
        let Some(before) = &front.before else { return Ok(front.first.clone()) };
        let back = self.difference(&front.last, before)?;
        let length = self.product(&back, &back, &front.last)?.sqrt();
        let scale = -1.0 / length;
        Ok(Motion { value: scale * back.value, state: add(&Stepped::default(), &back.state, scale) })
    }

    /// Difference b − a in the modes at a.
    fn difference(&self, a: &Motion, b: &Motion) -> Result<Motion, Lost> {
        let state = self.carried(&b.state, b.value, a.value)?;
        Ok(Motion { value: b.value - a.value, state: add(&state, &a.state, -1.0) })
    }

    /// Inner product of two directions at `at`, in the metric there.
    fn product(&self, a: &Motion, b: &Motion, at: &Motion) -> Result<f64, Lost> {
        let (inner, size) = self.at(at.value, |passage| {
            let size = size(&passage.state_of(&at.state));
            (dot(&passage.state_of(&a.state), &passage.state_of(&b.state)), size)
        })?;
        Ok(inner / (size * size) + a.value * b.value / (self.span * self.span))
    }
}
