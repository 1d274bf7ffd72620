//! Location of special points between points of a branch: where it turns back, or its stability changes.

use super::correct::Found;
use super::{Branch, Lost, Motion};
use crate::dynamics::initial::Stepped;

/// Share of p to which a point is located.
pub const LOCATED: f64 = 1e-6;

/// Share of the wider side at which golden section tries a point.
const GOLDEN: f64 = 0.382;

/// Largest number of points between two that are tried.
const LOOKS: usize = 30;

/// Special point of a branch that was located: a fold, a change of stability, or a maximum.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialPoint<T> {
    /// Motion at the point.
    pub motion: Motion,
    /// Data that the caller computed of the motion.
    pub told: T,
    /// Error of the location, in p.
    pub error: f64,
}

/// Point that was tried.
#[derive(Clone)]
struct Look<T> {
    /// Arclength, along the chords between the first points.
    along: f64,
    motion: Motion,
    told: T,
}

impl Branch<'_> {
    /// Point where `height` of a point is largest between the first and the last of three consecutive points, of which the middle one is no lower
    /// than both. It is located at the summit of a parabola through the three highest, again and again; by golden section where that does not halve
    /// its steps (Brent 1973, chapter 5). `blur` is the error of a point's height: wherever tried points are as high within it, the summit may be.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn summit<T: Clone>(
        &self,
        points: [(&Motion, T); 3],
        height: impl Fn(&Motion, &T) -> f64,
        blur: impl Fn(&T) -> f64,
        tell: impl Fn(&Motion) -> Result<T, Lost>,
    ) -> Result<SpecialPoint<T>, Lost> {
        let [(a, of_a), (b, of_b), (c, of_c)] = points;
        let (before, after) = (self.distance(a, b)?, self.distance(b, c)?);
        let look = |along: f64, motion: &Motion, told: T| Look { along, motion: motion.clone(), told };
        let mut points = vec![look(-before, a, of_a), look(0.0, b, of_b), look(after, c, of_c)];
        let mut error = f64::INFINITY;
        let mut steps = [f64::INFINITY; 2];
        for _ in 0..LOOKS {
            let highest = highest(&points, &height);
            let beside = [highest - 1, highest, highest + 1].map(|index| &points[index]);
            let [before, at, after] = beside;
            let parabola = summit_of(beside.map(|look| (look.along, height(&look.motion, &look.told))));
            let wider = if after.along - at.along > at.along - before.along { after } else { before };
            let along = if (parabola - at.along).abs() <= 0.5 * steps[0] {
                parabola
            } else {
                at.along + GOLDEN * (wider.along - at.along)
            };
            steps = [steps[1], (along - at.along).abs()];
            let (from, to) = if along < at.along { (before, at) } else { (at, after) };
            let share = (along - from.along) / (to.along - from.along);
            let Found { motion, .. } = self.between(&from.motion, &to.motion, share)?;
            error = (motion.value - at.motion.value).abs();
            let told = tell(&motion)?;
            let settled = error <= LOCATED * motion.value.abs();
            points.insert(highest + usize::from(along > at.along), Look { along, motion, told });
            if settled {
                break;
            }
        }
        let Look { motion, told, .. } = points[highest(&points, &height)].clone();
        let least = height(&motion, &told) - blur(&told);
        let as_high = points.iter().filter(|look| height(&look.motion, &look.told) >= least);
        let error = as_high.map(|look| (look.motion.value - motion.value).abs()).fold(error, f64::max);
        Ok(SpecialPoint { motion, told, error })
    }

    /// Point between `a` and `b` at which the sign of `told` changes, which differs there: by chords (Illinois), also where it jumps. The
    /// data returned are those of the last point where it is positive, if there was one.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn crossing<T>(
        &self,
        (a, told_a): (&Motion, f64),
        (b, told_b): (&Motion, f64),
        tell: impl Fn(&Motion) -> Result<(f64, T), Lost>,
    ) -> Result<Option<SpecialPoint<T>>, Lost> {
        let (mut low, mut high) = ((0.0, told_a, a.value), (1.0, told_b, b.value));
        let mut best = None::<(f64, Motion, T)>;
        let mut last_side = None;
        for _ in 0..LOOKS {
            let margin = 0.01 * (high.0 - low.0);
            let chord = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let share = chord.clamp(low.0 + margin, high.0 - margin);
            let found = self.between(a, b, share)?;
            let (sign, told) = tell(&found.motion)?;
            let here = (share, sign, found.motion.value);
            if sign > 0.0 || best.as_ref().is_none_or(|(best, ..)| *best <= 0.0) {
                best = Some((sign, found.motion, told));
            }
            let is_low = (sign < 0.0) == (told_a < 0.0);
            // An end that stays weighs half the next time.
            let stays = last_side == Some(is_low);
            last_side = Some(is_low);
            if is_low {
                low = here;
                high.1 *= if stays { 0.5 } else { 1.0 };
            } else {
                high = here;
                low.1 *= if stays { 0.5 } else { 1.0 };
            }
            if (high.2 - low.2).abs() <= LOCATED * here.2.abs() {
                break;
            }
        }
        let error = (high.2 - low.2).abs();
        Ok(best.map(|(_, motion, told)| SpecialPoint { motion, told, error }))
    }
}

/// Safety factor of [`off_by_steps`]: for the part of an error of first order, and of jumps, that agree by chance.
const SAFETY: f64 = 2.0;

/// Growth of a motion at a place, with more steps of time than the branch was followed with.
#[derive(Debug, Clone, Copy)]
pub struct FinerGrowth {
    /// Factor of the number of steps.
    pub times: f64,
    /// Growth that changes its sign at the place.
    pub growth: f64,
}

/// Error of a zero in p from finite steps of time: `2 · max_k |g_k − g| k/(k − 1) / |slope|`, where g is the growth at the place, `here`,
/// g_k the growth with k times the steps, and slope is dg/dp. Contacts that begin and end within a step leave multipliers an error of first
/// order, which jumps wherever one moves into the next step.
pub fn off_by_steps(here: f64, slope: f64, finer: &[FinerGrowth]) -> f64 {
    let off = finer.iter().map(|finer| (finer.growth - here).abs() * finer.times / (finer.times - 1.0));
    SAFETY * off.fold(0.0, f64::max) / slope.abs()
}

impl Branch<'_> {
    /// Solves for this branch's motion at `coarse.value`, starting from a motion with `times` times fewer steps.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn with_more_steps(&self, coarse: &Motion, times: f64) -> Result<Motion, Lost> {
        let mut guess = coarse.clone();
        guess.state.modes.iter_mut().for_each(|mode| mode.increment *= 1.0 / times);
        guess.state.casing.iter_mut().for_each(|wave| wave.increment = wave.increment.map(|x| x / times));
        let along = Motion { value: self.span, state: Stepped::default() };
        Ok(self.correct(guess, &along, coarse.value)?.motion)
    }
}

/// Summit of the parabola through three points, kept away from the middle one, which is the highest.
fn summit_of([(a, f), (b, g), (c, h)]: [(f64, f64); 3]) -> f64 {
    let (left, right) = ((b - a) * (g - h), (b - c) * (g - f));
    let s = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right);
    let margin = 1e-3 * (b - a).min(c - b);
    let (low, high) = (a + margin, c - margin);
    let s = if s.is_finite() { s.clamp(low, high) } else { 0.5 * (b + if c - b > b - a { c } else { a }) };
    if (s - b).abs() >= margin {
        s
    } else if c - b > b - a {
        b + margin
    } else {
        b - margin
    }
}

/// Index of the highest point among those that have another on either side.
fn highest<T>(points: &[Look<T>], height: impl Fn(&Motion, &T) -> f64) -> usize {
    let height = |&index: &usize| height(&points[index].motion, &points[index].told);
    (1..points.len() - 1).max_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(1)
}
