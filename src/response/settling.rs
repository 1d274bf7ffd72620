//! Is the response steady? Revolutions are compared, never assumed equal (§9).

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What the end of a run looks like, revolution by revolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Repeats every revolution.
    Periodic,
    /// Repeats every `ratio` revolutions.
    Subharmonic,
    /// Steady in level but never repeating.
    Aperiodic,
    /// Still changing when the window began or ended.
    NotSettled,
}

/// Steady state, judged by comparing revolutions (§9).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Settling {
    /// The verdict.
    pub verdict: Verdict,
    /// Period in revolutions, for `periodic` (1) and `subharmonic`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<u32>,
    /// Revolutions after which the verdict holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_revolutions: Option<u32>,
    /// Largest change from one period (a revolution, if none repeats) to the next within the window, relative to the
    /// response; absent where the window has a single revolution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
}

/// Revolutions differ by less than this share of the response in a steady state. Spectral leakage of a slower
/// drift stays an order below engine-order peaks of that share.
const TOLERANCE: f64 = 1e-2;

/// Longest period looked for, in revolutions.
const LONGEST_PERIOD: usize = 8;

/// Level changes between the halves of the window that a steady, non-repeating response may show.
const LEVEL_TOLERANCE: f64 = 0.1;

/// Sensors whose response is below this share of the largest count as silent.
const NEGLIGIBLE: f64 = 1e-6;

/// Judges histories (`[sensor][sample]`, whole run) by their last `window` revolutions.
///
/// With x_r the samples of revolution r of one sensor about its mean over the window, a response repeats every m
/// revolutions from r0 on if ‖x_r − x_{r−m}‖ ≤ 1e-2 max‖x‖ for every sensor and all later r. It is periodic (m = 1) or
/// subharmonic (2 ≤ m ≤ 8) if that holds through the whole window, aperiodic if it never repeats but its level is the
/// same in both halves of the window, and not settled otherwise.
pub fn judge(histories: &[Vec<f64>], samples_per_revolution: usize, window: usize) -> Settling {
    let revolutions = histories.first().map_or(0, |line| line.len() / samples_per_revolution);
    let window_start = revolutions - window.min(revolutions);
    let lines: Vec<Line> =
        histories.iter().map(|line| Line::new(line, samples_per_revolution, window_start)).collect();
    let largest = lines.iter().fold(0.0f64, |m, line| m.max(line.scale));
    if largest == 0.0 {
        return Settling {
            verdict: Verdict::Periodic,
            ratio: Some(1),
            after_revolutions: Some(0),
            largest_change: Some(0.0),
        };
    }
    // A sensor that the response hardly reaches shows round-off, not a response.
    let scale = |line: &Line| line.scale.max(NEGLIGIBLE * largest);
    let change =
        |r: usize, m: usize| lines.iter().fold(0.0f64, |c, line| c.max(line.change(r, m) / scale(line)));
    let mut change_of_one = None;
    for period in 1..=LONGEST_PERIOD.min(window / 2) {
        let changes: Vec<f64> = (period..revolutions).map(|r| change(r, period)).collect();
        // changes[r − period] compares revolutions r and r − period; both must lie in the window.
        let within = &changes[window_start.min(changes.len())..];
        let largest = within.iter().fold(0.0f64, |m, &c| m.max(c));
        if period == 1 {
            change_of_one = Some(largest);
        }
        if !within.is_empty() && largest <= TOLERANCE {
            let unsettled = changes.iter().rposition(|&c| c > TOLERANCE);
            return Settling {
                verdict: if period == 1 { Verdict::Periodic } else { Verdict::Subharmonic },
                ratio: Some(period as u32),
                after_revolutions: Some(unsettled.map_or(0, |r| r + 1) as u32),
                largest_change: Some(largest),
            };
        }
    }
    let middle = window_start + (revolutions - window_start) / 2;
    let steady = window >= 4
        && lines.iter().all(|line| {
            let (first, second) = (line.level(window_start..middle), line.level(middle..revolutions));
            (first - second).abs() <= LEVEL_TOLERANCE * first.max(second).max(NEGLIGIBLE * largest)
        });
    Settling {
        verdict: if steady { Verdict::Aperiodic } else { Verdict::NotSettled },
        ratio: None,
        after_revolutions: None,
        largest_change: change_of_one,
    }
}

/// One sensor's history about its mean over the window, revolution by revolution.
struct Line<'a> {
    samples: &'a [f64],
    per_revolution: usize,
    mean: f64,
    /// Largest ‖x_r‖ in the window.
    scale: f64,
}

impl<'a> Line<'a> {
    fn new(samples: &'a [f64], per_revolution: usize, window_start: usize) -> Self {
        let window = &samples[window_start * per_revolution..];
        let mean = window.iter().sum::<f64>() / window.len().max(1) as f64;
        let mut line = Self { samples, per_revolution, mean, scale: 0.0 };
        let revolutions = window_start..samples.len() / per_revolution;
        line.scale = revolutions.map(|r| line.level(r..r + 1)).fold(0.0, f64::max);
        line
    }

    fn revolution(&self, r: usize) -> &[f64] {
        &self.samples[r * self.per_revolution..(r + 1) * self.per_revolution]
    }

    /// ‖x_r − x_{r−m}‖
    fn change(&self, r: usize, m: usize) -> f64 {
        let pairs = self.revolution(r).iter().zip(self.revolution(r - m));
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    /// Root mean square of ‖x_r‖ over the revolutions of `range`.
    fn level(&self, range: std::ops::Range<usize>) -> f64 {
        let count = range.len().max(1) as f64;
        let square = |r: usize| self.revolution(r).iter().map(|x| (x - self.mean).powi(2)).sum::<f64>();
        (range.map(square).sum::<f64>() / count).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn history(revolutions: usize, x: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        vec![(0..revolutions * 64).map(|n| x(n as f64 / 64.0)).collect()]
    }

    #[test]
    fn tells_the_four_verdicts_apart() {
        let decay = |t: f64| (-t / 2.0).exp();
        let periodic =
            judge(&history(40, |t| (TAU * 2.0 * t).sin() + decay(t) * (TAU * 2.3 * t).sin()), 64, 20);
        assert_eq!((periodic.verdict, periodic.ratio), (Verdict::Periodic, Some(1)));
        // The transient of amplitude e^{−t/2} is below 1 % after some nine revolutions.
        assert!((5..=14).contains(&periodic.after_revolutions.unwrap()), "{periodic:?}");
        let third = judge(&history(40, |t| (TAU * 2.0 * t).sin() + 0.2 * (TAU * t / 3.0).sin()), 64, 20);
        assert_eq!((third.verdict, third.ratio), (Verdict::Subharmonic, Some(3)));
        let torus =
            judge(&history(40, |t| (TAU * 2.0 * t).sin() + 0.3 * (TAU * 2f64.sqrt() * t).sin()), 64, 20);
        assert_eq!(torus.verdict, Verdict::Aperiodic);
        let growing = judge(&history(40, |t| (t / 10.0).exp() * (TAU * 2.37 * t).sin()), 64, 20);
        assert_eq!(growing.verdict, Verdict::NotSettled);
        assert_eq!(judge(&history(4, |_| 0.0), 64, 2).verdict, Verdict::Periodic);
        // A drifting ripple is not hidden by a large static deflection, nor by a large steady neighbour.
        let drift = |t: f64| 0.01 * (t / 10.0).exp() * (TAU * 2.37 * t).sin();
        assert_eq!(judge(&history(40, |t| 5.0 + drift(t)), 64, 20).verdict, Verdict::NotSettled);
        let mut two = history(40, |t| (TAU * 2.0 * t).sin());
        two.extend(history(40, drift));
        assert_eq!(judge(&two, 64, 20).verdict, Verdict::NotSettled);
        // One revolution has nothing to be compared with.
        let short = judge(&history(3, |t| t), 64, 1);
        assert_eq!((short.verdict, short.largest_change), (Verdict::NotSettled, None));
    }
}
