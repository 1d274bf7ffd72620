//! Where something happens between points of a branch: it turns back, or its stability changes.

use super::{Branch, Lost, Motion};

/// Share of p to which a place is found.
pub const PLACE: f64 = 1e-6;

/// Most points between two that are looked at.
const LOOKS: usize = 30;

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

impl Branch<'_> {
    /// Where, between the first and the last of three points that follow each other, `height` of a point is largest; the point
    /// in the middle is higher than both. Found where a parabola through the three highest has its summit, again and again.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn summit<T: Clone>(
        &self,
        points: [(&Motion, T); 3],
        height: impl Fn(&Motion, &T) -> f64,
        tell: impl Fn(&Motion) -> Result<T, Lost>,
    ) -> Result<Place<T>, Lost> {
        let [(a, told_a), (b, told_b), (c, told_c)] = points;
        let (before, after) = (self.distance(a, b)?, self.distance(b, c)?);
        let start = |s: f64, motion: &Motion, told: T| (s, height(motion, &told), motion.value, told);
        let mut bracket = [start(-before, a, told_a), start(0.0, b, told_b), start(after, c, told_c)];
        let (mut best, mut error) = (b.clone(), f64::INFINITY);
        for _ in 0..LOOKS {
            let s = summit_of(bracket.each_ref().map(|(s, height, ..)| (*s, *height)));
            let found =
                if s < 0.0 { self.between(a, b, 1.0 + s / before)? } else { self.between(b, c, s / after)? };
            let told = tell(&found.motion)?;
            let here = (s, height(&found.motion, &told), found.motion.value, told);
            error = (here.2 - bracket[1].2).abs();
            if here.1 > bracket[1].1 {
                best = found.motion;
            }
            bracket = narrowed(bracket, here);
            if error <= PLACE * bracket[1].2.abs() {
                break;
            }
        }
        let [_, (_, _, _, told), _] = bracket;
        Ok(Place { motion: best, told, error })
    }

    /// Where between `a` and `b` the sign of `told` changes, which differs there: by chords (Illinois), also where it jumps. What is told is
    /// that of the last point where it is positive, if there was one.
    ///
    /// # Errors
    /// [`Lost`].
    pub fn crossing<T>(
        &self,
        (a, told_a): (&Motion, f64),
        (b, told_b): (&Motion, f64),
        tell: impl Fn(&Motion) -> Result<(f64, T), Lost>,
    ) -> Result<Option<Place<T>>, Lost> {
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
            if (high.2 - low.2).abs() <= PLACE * here.2.abs() {
                break;
            }
        }
        let error = (high.2 - low.2).abs();
        Ok(best.map(|(_, motion, told)| Place { motion, told, error }))
    }
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

/// The three that enclose the highest.
fn narrowed<T>([a, b, c]: [(f64, f64, f64, T); 3], new: (f64, f64, f64, T)) -> [(f64, f64, f64, T); 3] {
    match (new.0 < b.0, new.1 > b.1) {
        (true, true) => [a, new, b],
        (true, false) => [new, b, c],
        (false, true) => [b, new, c],
        (false, false) => [a, b, new],
    }
}
