//! Where something happens between points of a branch: it turns back, or its stability changes.

use faer::Mat;
use faer::prelude::Solve;

use super::correct::Found;
use super::{Branch, Lost, Motion};

/// Share of p to which a place is found.
pub const PLACE: f64 = 1e-6;

/// Share of the wider side at which golden section looks.
const GOLDEN: f64 = 0.382;

/// Most points between two that are looked at.
const LOOKS: usize = 30;

/// Points between two that tell how uneven they are, and as many within this share of a crossing.
const SAMPLES: u32 = 12;
const NEAR: f64 = 0.2;

/// Degree of the curve through them.
const MOST_DEGREE: usize = 4;

/// A jump, and what comes of several, over the most that is left of them: with 500 to 4,000 steps per period of a one-sided spring flips are
/// off by 0.6 to 7 times as much.
const JUMP: f64 = 16.0;

/// A place that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Place<T> {
    /// The point there.
    pub motion: Motion,
    /// What was asked of it.
    pub told: T,
    /// How far away it may be, in p.
    pub error: f64,
}

/// A point that was looked at.
#[derive(Clone)]
struct Look<T> {
    /// Arclength, along the chords between the first points.
    along: f64,
    motion: Motion,
    told: T,
}

impl Branch<'_> {
    /// Where, between the first and the last of three points that follow each other, `height` of a point is largest; the point
    /// in the middle is no lower than both. Found where a parabola through the three highest has its summit, again and again; by golden section
    /// where that does not halve its steps (Brent 1973, chapter 5). `blur` is how far off the height that is told of a point may be: wherever
    /// points that were looked at are as high as that, the summit may be.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn summit<T: Clone>(
        &self,
        points: [(&Motion, T); 3],
        height: impl Fn(&Motion, &T) -> f64,
        blur: impl Fn(&T) -> f64,
        tell: impl Fn(&Motion) -> Result<T, Lost>,
    ) -> Result<Place<T>, Lost> {
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
            let settled = error <= PLACE * motion.value.abs();
            points.insert(highest + usize::from(along > at.along), Look { along, motion, told });
            if settled {
                break;
            }
        }
        let Look { motion, told, .. } = points[highest(&points, &height)].clone();
        let least = height(&motion, &told) - blur(&told);
        let as_high = points.iter().filter(|look| height(&look.motion, &look.told) >= least);
        let error = as_high.map(|look| (look.motion.value - motion.value).abs()).fold(error, f64::max);
        Ok(Place { motion, told, error })
    }

    /// Where between `a` and `b` the sign of `told` changes, which differs there: by chords (Illinois), also where it jumps. What is told is
    /// that of the last point where it is positive, if there was one.
    ///
    /// Multipliers jump a little wherever a contact moves from one step of time into the next, so that they cross zero anywhere that their slope
    /// takes to make up for such a jump. How far they jump is told by points all over between `a` and `b` that are `alike`, by what is left of
    /// them over a smooth curve; the error is as much over its slope.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn crossing<T>(
        &self,
        (a, told_a): (&Motion, f64),
        (b, told_b): (&Motion, f64),
        tell: impl Fn(&Motion) -> Result<(f64, T), Lost>,
        alike: impl Fn(&T, &T) -> bool,
    ) -> Result<Option<Place<T>>, Lost> {
        let (mut low, mut high) = ((0.0, told_a, a.value), (1.0, told_b, b.value));
        let mut best = None::<(f64, f64, Motion, T)>;
        let mut last_side = None;
        for _ in 0..LOOKS {
            let margin = 0.01 * (high.0 - low.0);
            let chord = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let share = chord.clamp(low.0 + margin, high.0 - margin);
            let found = self.between(a, b, share)?;
            let (sign, told) = tell(&found.motion)?;
            let here = (share, sign, found.motion.value);
            if sign > 0.0 || best.as_ref().is_none_or(|(best, ..)| *best <= 0.0) {
                best = Some((sign, share, found.motion, told));
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
            if (high.2 - low.2).abs() <= PLACE * here.2.abs() {
                break;
            }
        }
        let bracket = (high.2 - low.2).abs();
        let Some((_, share, motion, told)) = best else { return Ok(None) };
        let mut samples = Vec::new();
        // All over, and near by, where the rest may be of another kind.
        let spread = |k: u32| (f64::from(k) + 0.5) / f64::from(SAMPLES);
        let near = |k: u32| share + NEAR * (2.0 * spread(k) - 1.0);
        let shares = (0..SAMPLES).map(spread).chain((0..SAMPLES).map(near));
        for share in shares.filter(|share| (0.0..=1.0).contains(share)) {
            let looked = self.between(a, b, share).and_then(|found| tell(&found.motion));
            match looked {
                Ok((value, other)) if alike(&told, &other) => samples.push((share, value)),
                Err(Lost::Cancelled) => return Err(Lost::Cancelled),
                _ => {}
            }
        }
        let uneven = unevenness(&samples, share).map_or(0.0, |uneven| uneven * (b.value - a.value).abs());
        Ok(Some(Place { motion, told, error: bracket.max(uneven) }))
    }
}

/// How far, in shares, a crossing at `at` may be off for what is left of `samples` over a polynomial through them; none of fewer than six.
fn unevenness(samples: &[(f64, f64)], at: f64) -> Option<f64> {
    let degree = samples.len().checked_sub(5)?.min(MOST_DEGREE);
    if degree == 0 {
        return None;
    }
    let powers = |share: f64| {
        let x = 2.0 * share - 1.0;
        // Chebyshev's, of which the normal equations stay well-conditioned.
        (0..=degree).map(move |n| (n as f64 * x.clamp(-1.0, 1.0).acos()).cos())
    };
    let rows: Vec<Vec<f64>> = samples.iter().map(|&(share, _)| powers(share).collect()).collect();
    let sum = |of: &dyn Fn(usize) -> f64| (0..samples.len()).map(of).sum::<f64>();
    let normal = Mat::from_fn(degree + 1, degree + 1, |i, j| sum(&|k| rows[k][i] * rows[k][j]));
    let right = Mat::from_fn(degree + 1, 1, |i, _| sum(&|k| rows[k][i] * samples[k].1));
    let fitted = normal.partial_piv_lu().solve(right);
    let value = |share: f64| powers(share).enumerate().map(|(n, power)| fitted[(n, 0)] * power).sum::<f64>();
    let left = samples.iter().map(|&(share, told)| (told - value(share)).abs()).fold(0.0, f64::max);
    let by = 1e-3;
    let (before, behind) = ((at - by).max(0.0), (at + by).min(1.0));
    let slope = (value(behind) - value(before)) / (behind - before);
    // What is left of a jump is a half of it at most, and less where the curve follows it.
    Some((JUMP * left / slope.abs()).min(1.0)).filter(|uneven| uneven.is_finite())
}

/// Of the parabola through three points, kept away from the middle one, which is the highest.
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

/// Of those that have another on either side.
fn highest<T>(points: &[Look<T>], height: impl Fn(&Motion, &T) -> f64) -> usize {
    let height = |&index: &usize| height(&points[index].motion, &points[index].told);
    (1..points.len() - 1).max_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(1)
}
