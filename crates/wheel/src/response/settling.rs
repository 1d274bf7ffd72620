//! Settling of a response: revolutions are compared, never assumed equal (docs/method.md, Reading responses).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::side_bands::SideBands;
use rubmap_numerics::spectrum::amplitudes;

/// State of the response at the end of a run, judged revolution by revolution: `periodic` where it repeats every revolution, `subharmonic`
/// where it repeats every `ratio` revolutions, `aperiodic` where it is steady in level but never repeats, `not_settled` where it was still
/// changing when the window began or ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Response that repeats every revolution.
    Periodic,
    /// Response that repeats every `ratio` revolutions.
    Subharmonic,
    /// Response that is steady in level but never repeats.
    Aperiodic,
    /// Response that was still changing when the window began or ended.
    NotSettled,
}

/// Steady state of a response, judged by comparing revolutions (docs/method.md, Reading responses).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Settling {
    /// Verdict on the response.
    pub verdict: Verdict,
    /// Period in revolutions, for `periodic` (1) and `subharmonic`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<u32>,
    /// Period in passages of the casing's lobes, of which a revolution has as many as there are lobes: 1 is the forced
    /// response, 2 a doubled period, which two lobes show on odd engine orders. Absent without lobes that may be touched, or
    /// where nothing repeats.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe_passages: Option<u32>,
    /// Distance δ of the strongest side bands from their engine order, as a fraction of Ω; for `aperiodic` responses whose
    /// side bands stand clear of the floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side_band_spacing: Option<f64>,
    /// Revolutions after which the verdict holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_revolutions: Option<u32>,
    /// Largest change from one period (a revolution, if none repeats) to the next within the window, relative to the
    /// response; absent where the window has a single revolution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
}

impl Settling {
    /// Checks the verdict against the strongest pair of side bands in the window: an aperiodic response takes its spacing, and one that
    /// seems to repeat every few revolutions, though its side bands do not, is aperiodic. Side bands of some per cent drift by less than
    /// the tolerance over a period that they nearly fit.
    #[must_use]
    pub fn beside(mut self, strongest: Option<&SideBands>) -> Self {
        let Some(pair) = strongest else { return self };
        if let (Verdict::Subharmonic, Some(ratio)) = (self.verdict, self.ratio) {
            let beats = f64::from(ratio) * pair.spacing;
            if (beats - beats.round()).abs() <= f64::from(ratio) * LOCATED * pair.resolution {
                return self;
            }
            self = Self {
                verdict: Verdict::Aperiodic,
                ratio: None,
                lobe_passages: None,
                after_revolutions: None,
                ..self
            };
        }
        if self.verdict == Verdict::Aperiodic {
            self.side_band_spacing = Some(pair.spacing);
        }
        self
    }
}

/// Share of the response by which revolutions may differ in a steady state. Spectral leakage of a slower drift stays an order below
/// engine-order peaks of that share.
const TOLERANCE: f64 = 1e-2;

/// Accuracy to which side bands are located, in bins, at worst.
const LOCATED: f64 = 0.25;

/// Longest period that is searched, in revolutions.
const LONGEST_PERIOD: usize = 8;

/// Largest change of a steady response over the whole window: of its level between the halves, or, where it repeats, of any revolution from
/// the last one of its phase. Without it a beat of hundreds of revolutions would pass for periodic.
const LEVEL_TOLERANCE: f64 = 0.1;

/// Share of the largest response below which sensors count as silent.
const NEGLIGIBLE: f64 = 1e-6;

/// Judges histories (`[sensor][sample]`, whole run) by their last `window` revolutions.
///
/// With x_r the samples of revolution r of one sensor about its mean over the window, a response repeats every m revolutions from r0 on if
/// ‖x_r − x_{r−m}‖ ≤ 1e-2 max‖x‖ for every sensor and all later r. It is periodic (m = 1) or subharmonic (2 ≤ m ≤ 8, at most half the
/// window) if that holds through the whole window and no revolution in it differs by more than a tenth from the last one of its phase,
/// aperiodic if it never repeats but its level is the same in both halves of the window, and not settled otherwise. `lobes` pass each blade
/// in a revolution; without lobes there are no passages to count.
pub fn judge(
    histories: &[Vec<f64>],
    samples_per_revolution: usize,
    window: usize,
    lobes: Option<u32>,
) -> Settling {
    let revolutions = histories.first().map_or(0, |line| line.len() / samples_per_revolution);
    let window_start = revolutions - window.min(revolutions);
    let lines: Vec<Line> =
        histories.iter().map(|line| Line::new(line, samples_per_revolution, window_start)).collect();
    let largest = lines.iter().fold(0.0f64, |m, line| m.max(line.scale));
    if largest == 0.0 {
        return Settling {
            verdict: Verdict::Periodic,
            ratio: Some(1),
            lobe_passages: lobes.map(|_| 1),
            side_band_spacing: None,
            after_revolutions: Some(0),
            largest_change: Some(0.0),
        };
    }
    // A sensor that the response hardly reaches shows round-off, not a response.
    let scale = |line: &Line| line.scale.max(NEGLIGIBLE * largest);
    let change =
        |r: usize, s: usize| lines.iter().fold(0.0f64, |c, line| c.max(line.change(r, s) / scale(line)));
    let mut change_of_one = None;
    for period in 1..=LONGEST_PERIOD.min(window / 2) {
        let changes: Vec<f64> = (period..revolutions).map(|r| change(r, r - period)).collect();
        // changes[r − period] compares revolutions r and r − period; both must lie in the window.
        let within = &changes[window_start.min(changes.len())..];
        let largest = within.iter().fold(0.0f64, |m, &c| m.max(c));
        if period == 1 {
            change_of_one = Some(largest);
        }
        let last = |r: usize| revolutions - 1 - (revolutions - 1 - r) % period;
        let keeps = || (window_start..revolutions).all(|r| change(r, last(r)) <= LEVEL_TOLERANCE);
        if !within.is_empty() && largest <= TOLERANCE && keeps() {
            let unsettled = changes.iter().rposition(|&c| c > TOLERANCE);
            return Settling {
                verdict: if period == 1 { Verdict::Periodic } else { Verdict::Subharmonic },
                ratio: Some(period as u32),
                lobe_passages: lobes.map(|lobes| {
                    let start = revolutions - window / period * period;
                    lobe_passages(&lines, scale, start, lobes, lobes * period as u32)
                }),
                side_band_spacing: None,
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
        lobe_passages: None,
        side_band_spacing: None,
        after_revolutions: None,
        largest_change: change_of_one,
    }
}

/// Fewest passages of `lobes` after which `lines` repeat; they do so after `most` of them from revolution `start` on.
///
/// ‖x(φ + τ) − x(φ)‖² over a revolution is Σ 2a_q² sin²(πqτ) per sample by Parseval, a_q being the line at order q: a change
/// like that between revolutions, wherever τ falls between the samples.
fn lobe_passages(
    lines: &[Line<'_>],
    scale: impl Fn(&Line<'_>) -> f64,
    start: usize,
    lobes: u32,
    most: u32,
) -> u32 {
    let spectra: Vec<Vec<f64>> = lines.iter().map(|line| line.spectrum(start)).collect();
    let repeats = |passages: u32| {
        lines.iter().zip(&spectra).all(|(line, spectrum)| {
            let revolutions = (line.samples.len() / line.per_revolution - start) as f64;
            let turn = PI * f64::from(passages) / (f64::from(lobes) * revolutions);
            let moved = |(bin, a): (usize, &f64)| 2.0 * (a * (turn * bin as f64).sin()).powi(2);
            let square: f64 = spectrum.iter().enumerate().map(moved).sum();
            (line.per_revolution as f64 * square).sqrt() <= TOLERANCE * scale(line)
        })
    };
    (1..most).find(|passages| most.is_multiple_of(*passages) && repeats(*passages)).unwrap_or(most)
}

/// History of one sensor about its mean over the window, revolution by revolution.
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

    /// Distance ‖x_r − x_s‖ of two revolutions.
    fn change(&self, r: usize, s: usize) -> f64 {
        let pairs = self.revolution(r).iter().zip(self.revolution(s));
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    /// Amplitudes of the samples from revolution `start` on.
    fn spectrum(&self, start: usize) -> Vec<f64> {
        let samples = &self.samples[start * self.per_revolution..];
        amplitudes(samples, samples.len() / 2 + 1)
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
    use crate::response::side_bands::side_bands;
    use std::f64::consts::TAU;

    fn history(revolutions: usize, x: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        vec![(0..revolutions * 64).map(|n| x(n as f64 / 64.0)).collect()]
    }

    #[test]
    fn tells_the_four_verdicts_apart() {
        let decay = |t: f64| (-t / 2.0).exp();
        let periodic =
            judge(&history(40, |t| (TAU * 2.0 * t).sin() + decay(t) * (TAU * 2.3 * t).sin()), 64, 20, None);
        assert_eq!((periodic.verdict, periodic.ratio), (Verdict::Periodic, Some(1)));
        // The transient of amplitude e^{−t/2} is below 1 % after some nine revolutions.
        assert!((5..=14).contains(&periodic.after_revolutions.unwrap()), "{periodic:?}");
        let third =
            judge(&history(40, |t| (TAU * 2.0 * t).sin() + 0.2 * (TAU * t / 3.0).sin()), 64, 20, None);
        assert_eq!((third.verdict, third.ratio), (Verdict::Subharmonic, Some(3)));
        let torus = judge(
            &history(40, |t| (TAU * 2.0 * t).sin() + 0.3 * (TAU * 2f64.sqrt() * t).sin()),
            64,
            20,
            None,
        );
        assert_eq!(torus.verdict, Verdict::Aperiodic);
        let growing = judge(&history(40, |t| (t / 10.0).exp() * (TAU * 2.37 * t).sin()), 64, 20, None);
        assert_eq!(growing.verdict, Verdict::NotSettled);
        assert_eq!(judge(&history(4, |_| 0.0), 64, 2, None).verdict, Verdict::Periodic);
        // A drifting ripple is not hidden by a large static deflection, nor by a large steady neighbour.
        let drift = |t: f64| 0.01 * (t / 10.0).exp() * (TAU * 2.37 * t).sin();
        assert_eq!(judge(&history(40, |t| 5.0 + drift(t)), 64, 20, None).verdict, Verdict::NotSettled);
        let mut two = history(40, |t| (TAU * 2.0 * t).sin());
        two.extend(history(40, drift));
        assert_eq!(judge(&two, 64, 20, None).verdict, Verdict::NotSettled);
        // One revolution has nothing to be compared with.
        let short = judge(&history(3, |t| t), 64, 1, None);
        assert_eq!((short.verdict, short.largest_change), (Verdict::NotSettled, None));
    }

    #[test]
    fn periods_of_several_revolutions_are_counted_in_short_and_long_windows() {
        for (ratio, window) in
            [(2, 4), (2, 20), (2, 400), (3, 20), (3, 301), (4, 8), (4, 20), (4, 402), (8, 16)]
        {
            let x = |t: f64| {
                (TAU * 2.0 * t).sin()
                    + 0.05 * (TAU * 5.0 * t / f64::from(ratio)).cos()
                    + 0.04 * (TAU * t / f64::from(ratio)).cos()
            };
            let found = judge(&history(window + 3, x), 64, window, None);
            assert_eq!(
                (found.verdict, found.ratio),
                (Verdict::Subharmonic, Some(ratio)),
                "{window}: {found:?}"
            );
        }
        // Half orders everywhere, among them those of the odd ones.
        let halves =
            |t: f64| (1..=9).map(|half| (TAU * 0.5 * f64::from(half) * t).sin() / f64::from(half)).sum();
        assert_eq!(judge(&history(30, halves), 64, 20, None).ratio, Some(2));
        // A window of less than two periods cannot show them.
        let four = |t: f64| (TAU * 2.0 * t).sin() + 0.2 * (TAU * t / 4.0).sin();
        assert_eq!(judge(&history(30, four), 64, 7, None).ratio, None);
    }

    #[test]
    fn a_slow_beat_is_not_periodic_in_a_window_that_shows_it() {
        let beat =
            |distance: f64| move |t: f64| (TAU * 2.0 * t).sin() + 0.3 * (TAU * (2.5 + distance) * t).sin();
        // A thousandth of a period from one pair of revolutions to the next.
        assert_eq!(judge(&history(520, beat(5e-4)), 64, 500, None).verdict, Verdict::Aperiodic);
        assert_eq!(judge(&history(40, beat(5e-4)), 64, 20, None).ratio, Some(2));
    }

    #[test]
    fn side_bands_that_nearly_fit_a_period_do_not_repeat() {
        // Seen on the demo impeller: four revolutions hold 1.08 beats, weak enough to pass for one.
        let split = |spacing: f64| {
            move |t: f64| {
                let pair = (TAU * (1.0 + spacing) * t).sin() + (TAU * (1.0 - spacing) * t).cos();
                (TAU * 2.0 * t).sin() + 0.008 * pair
            }
        };
        for (spacing, verdict) in [(0.2697, Verdict::Aperiodic), (0.25, Verdict::Subharmonic)] {
            let samples = history(60, split(spacing));
            let alone = judge(&samples, 64, 20, None);
            assert_eq!((alone.verdict, alone.ratio), (Verdict::Subharmonic, Some(4)), "{alone:?}");
            let pairs = side_bands(&samples[0][40 * 64..], 20, 8);
            let held = alone.clone().beside(pairs.first());
            assert_eq!(held.verdict, verdict, "{held:?}");
            match held.side_band_spacing {
                Some(found) => assert!((found - spacing).abs() < 0.005, "{held:?}"),
                None => assert_eq!(held, alone),
            }
            assert_eq!(alone.clone().beside(None), alone);
        }
    }

    #[test]
    fn periods_are_counted_in_passages_of_lobes() {
        let passages =
            |lobes: u32, x: &dyn Fn(f64) -> f64| judge(&history(40, x), 64, 20, Some(lobes)).lobe_passages;
        let order = |k: f64, t: f64| (TAU * k * t).sin();
        let forced = |t: f64| order(2.0, t) + 0.2 * order(4.0, t) + 0.1 * order(6.0, t);
        assert_eq!(passages(2, &forced), Some(1));
        // The paper's area E: odd engine orders under two lobes, periodic in the revolution.
        assert_eq!(passages(2, &|t| forced(t) + 0.05 * order(1.0, t) + 0.02 * order(3.0, t)), Some(2));
        assert_eq!(passages(2, &|t| forced(t) + 0.05 * order(0.5, t)), Some(4));
        assert_eq!(passages(2, &|t| forced(t) + 0.05 * order(2.0 / 3.0, t)), Some(3));
        // Three lobes, which 64 samples a revolution do not divide.
        assert_eq!(passages(3, &|t| order(3.0, t) + 0.3 * order(6.0, t)), Some(1));
        assert_eq!(passages(3, &|t| order(3.0, t) + 0.3 * order(1.5, t)), Some(2));
        assert_eq!(passages(3, &|t| order(3.0, t) + 0.3 * order(1.0, t)), Some(3));
        assert_eq!(passages(2, &|t| order(2.0, t) + 0.3 * order(2f64.sqrt(), t)), None);
        assert_eq!(passages(2, &|_| 0.0), Some(1));
    }
}
