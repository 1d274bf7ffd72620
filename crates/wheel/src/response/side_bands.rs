//! Pairs of spectral lines about integer engine orders: the frequency split of the paper's Figs 12–14.
//!
//! A response with a second frequency beside the engine orders has lines at k ± δ. With a Hann window over the whole
//! revolutions at the end of a run an engine order keeps to its own bin and the two beside it, so that a pair is seen from a
//! spacing of two bins on, however weak it is. Between bins, a line's place and amplitude follow from the ratio r of its
//! two largest bins (Grandke, IEEE Trans. Instrum. Meas. 32, 1983):
//!
//! ```text
//! place = m + d,   d = (2r − 1)/(r + 1),   amplitude = a_m πd(1 − d²)/sin πd
//! ```

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use rubmap_numerics::spectrum::amplitudes;

/// Pair of spectral lines at engine orders k ± δ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SideBands {
    /// Integer engine order k in the middle.
    pub engine_order: u32,
    /// Spacing δ as a fraction of an engine order, of Ω, at most 1/2; interpolated between the bins of the window.
    pub spacing: f64,
    /// Width of a bin, 1/`window_revolutions`. Pairs closer than two of them to their middle are not told from it.
    pub resolution: f64,
    /// Amplitude at k itself, length. In a split response it may be the smallest of the three.
    pub carrier: f64,
    /// Amplitude at k − δ, length.
    pub lower: f64,
    /// Amplitude at k + δ, length.
    pub upper: f64,
}

impl SideBands {
    /// Amplitude of the weaker line, by which a pair is judged.
    pub fn weaker(&self) -> f64 {
        self.lower.min(self.upper)
    }
}

/// Number of times that a line must be as high as the floor, the lower quartile of the bins between the engine orders nearby, to stand
/// clear of it: of noise, one bin in 10⁸ is.
const CLEAR: f64 = 8.0;

/// Share of the strongest line below which lines are ignored.
const SIGNIFICANT: f64 = 1e-3;

/// Difference, in bins, that the distances of two lines from the middle may have for them to be a pair.
const SYMMETRIC: f64 = 0.3;

/// Reach of an engine order with a Hann window to either side, in bins.
const REACH: usize = 1;

/// Largest number of orders reported, those with the strongest pairs.
const MOST: usize = 4;

/// Pairs about the engine orders 1 … `max_engine_order` in `window`, which is a whole number of `revolutions`: pairs that stand clear of
/// the floor, at most one for each order and four together, by ascending order.
pub fn side_bands(window: &[f64], revolutions: usize, max_engine_order: usize) -> Vec<SideBands> {
    let highest = max_engine_order.min((window.len() / (2 * revolutions)).saturating_sub(1));
    if highest == 0 {
        return Vec::new();
    }
    let amplitude = amplitudes(&hann(window), (highest + 1) * revolutions + 1);
    let strongest = amplitude[REACH + 1..].iter().fold(0.0f64, |m, &a| m.max(a));
    let spectrum = Spectrum { amplitude: &amplitude, revolutions, least: SIGNIFICANT * strongest };
    let mut pairs: Vec<_> = (1..=highest).filter_map(|order| spectrum.pair_about(order)).collect();
    pairs.sort_by(|a, b| b.weaker().total_cmp(&a.weaker()));
    pairs.truncate(MOST);
    pairs.sort_by_key(|pair| pair.engine_order);
    pairs
}

/// Samples under a Hann window of mean 1: a line on a bin keeps its amplitude.
fn hann(samples: &[f64]) -> Vec<f64> {
    let step = TAU / samples.len() as f64;
    samples.iter().enumerate().map(|(n, x)| x * (1.0 - (step * n as f64).cos())).collect()
}

/// Spectral line beside an engine order.
struct Line {
    /// Distance of the line from the engine order, in bins.
    distance: f64,
    amplitude: f64,
}

struct Spectrum<'a> {
    amplitude: &'a [f64],
    /// Number of bins to an engine order.
    revolutions: usize,
    least: f64,
}

impl Spectrum<'_> {
    fn pair_about(&self, order: usize) -> Option<SideBands> {
        let centre = order * self.revolutions;
        let least = self.least.max(CLEAR * self.floor_about(centre)?);
        let lower = self.lines_beside(|distance| centre - distance, least);
        let upper = self.lines_beside(|distance| centre + distance, least);
        // Both ascend in the distance, a line is bins away from the next: each has one counterpart at most.
        let mut best: Option<(&Line, &Line)> = None;
        let mut from = 0;
        for low in &lower {
            while upper.get(from).is_some_and(|high| high.distance < low.distance - SYMMETRIC) {
                from += 1;
            }
            let Some(high) = upper.get(from).filter(|high| high.distance <= low.distance + SYMMETRIC) else {
                continue;
            };
            let weaker = |(a, b): (&Line, &Line)| a.amplitude.min(b.amplitude);
            if best.is_none_or(|best| weaker((low, high)) > weaker(best)) {
                best = Some((low, high));
            }
        }
        let (low, high) = best?;
        let resolution = 1.0 / self.revolutions as f64;
        Some(SideBands {
            engine_order: order as u32,
            spacing: (0.5 * (low.distance + high.distance) * resolution).min(0.5),
            resolution,
            carrier: self.amplitude[centre],
            lower: low.amplitude,
            upper: high.amplitude,
        })
    }

    /// Lower quartile of the bins within one engine order of `centre` that no engine order reaches; none if the window is
    /// too short to have any.
    fn floor_about(&self, centre: usize) -> Option<f64> {
        let around = centre - self.revolutions..=centre + self.revolutions;
        let between = |bin: &usize| {
            let beyond = bin % self.revolutions;
            beyond.min(self.revolutions - beyond) > REACH
        };
        let mut floor: Vec<f64> = around.filter(between).map(|bin| self.amplitude[bin]).collect();
        let quartile = floor.len() / 4;
        (!floor.is_empty()).then(|| *floor.select_nth_unstable_by(quartile, f64::total_cmp).1)
    }

    /// Local maxima of at least `least` up to half an engine order away, at bins `place(distance)`; ascending in the
    /// distance.
    fn lines_beside(&self, place: impl Fn(usize) -> usize, least: f64) -> Vec<Line> {
        let at = |distance: usize| self.amplitude[place(distance)];
        let half = 0.5 * self.revolutions as f64;
        let mut lines = Vec::new();
        // One bin beyond the half: a line there may lie on either side of it.
        for distance in REACH + 1..=(self.revolutions / 2 + 1).min(self.revolutions.saturating_sub(REACH + 1))
        {
            let here = at(distance);
            let outer = at(distance + 1);
            // The bin next to the centre is the engine order's, as is that next to the next one.
            let inner = (distance > REACH + 1).then(|| at(distance - 1));
            if here < least || outer > here || inner.is_some_and(|inner| inner > here) {
                continue;
            }
            let (neighbour, outwards) = match inner {
                Some(inner) if inner > outer => (inner, -1.0),
                _ => (outer, 1.0),
            };
            let ratio = neighbour / here;
            let offset = (2.0 * ratio - 1.0) / (ratio + 1.0);
            let found = distance as f64 + outwards * offset;
            // Nearer, it is what an engine order changes within the window.
            if (REACH as f64 + 0.5..=half + SYMMETRIC).contains(&found) {
                lines.push(Line { distance: found, amplitude: here / hann_line(offset) });
            }
        }
        lines
    }
}

/// Amplitude that a bin at distance `offset`, in bins, reads of a line of amplitude 1 under a Hann window.
fn hann_line(offset: f64) -> f64 {
    if offset.abs() < 1e-9 { 1.0 } else { (PI * offset).sin() / (PI * offset * (1.0 - offset * offset)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: usize = 64;

    fn window(revolutions: usize, x: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..revolutions * SAMPLES).map(|n| x(n as f64 / SAMPLES as f64)).collect()
    }

    /// Random number, uniform in (−1, 1).
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn cos(order: f64, t: f64) -> f64 {
        (TAU * order * t).cos()
    }

    #[test]
    fn a_modulated_engine_order_has_its_pair_wherever_it_falls_between_bins() {
        for revolutions in [20, 33, 200] {
            for bins in [2.6, 3.0, 3.5, 4.25, 6.9] {
                let spacing = bins / revolutions as f64;
                let x = |t: f64| 0.7 + (1.0 + 0.2 * cos(spacing, t + 0.1)) * cos(2.0, t + 0.3);
                let samples = window(revolutions, x);
                let found = side_bands(&samples, revolutions, 6);
                assert_eq!(found.len(), 1, "{revolutions} {bins}: {found:?}");
                let SideBands { engine_order, spacing: at, resolution, carrier, lower, upper } = found[0];
                assert_eq!((engine_order, resolution), (2, 1.0 / revolutions as f64));
                // The mirrored line, five bins away or more, leaks some per cent.
                assert!((at - spacing).abs() < 0.03 * resolution, "{at} for {spacing}");
                for (amplitude, expected) in [(carrier, 1.0), (lower, 0.1), (upper, 0.1)] {
                    assert!((amplitude - expected).abs() < 0.03 * expected, "{bins}: {amplitude}");
                }
                // Parseval: the three lines carry the signal's energy. A window cuts off a part of a beat.
                let mean = samples.iter().sum::<f64>() / samples.len() as f64;
                let energy = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / samples.len() as f64;
                let lines = 0.5 * (carrier.powi(2) + lower.powi(2) + upper.powi(2));
                assert!((lines - energy).abs() < 0.06 * energy, "{bins}: {lines} of {energy}");
            }
        }
    }

    #[test]
    fn a_split_order_needs_no_carrier() {
        // As in the paper: the even orders stay, the odd ones split into two.
        let x = |t: f64| {
            let split = |k: f64, a: f64| a * (cos(k + 0.13, t) + 0.8 * cos(k - 0.13, t + 0.2));
            cos(2.0, t) + 0.3 * cos(4.0, t + 0.1) + split(1.0, 0.1) + split(3.0, 0.05) + split(5.0, 0.02)
        };
        let found = side_bands(&window(40, x), 40, 8);
        assert_eq!(found.iter().map(|pair| pair.engine_order).collect::<Vec<_>>(), [1, 3, 5]);
        for (pair, amplitude) in found.iter().zip([0.1, 0.05, 0.02]) {
            assert!((pair.spacing - 0.13).abs() < 0.05 * pair.resolution, "{pair:?}");
            assert!((pair.upper - amplitude).abs() < 0.02 * amplitude, "{pair:?}");
            assert!((pair.lower - 0.8 * amplitude).abs() < 0.02 * amplitude, "{pair:?}");
            assert!(pair.carrier < 0.1 * pair.lower, "{pair:?}");
        }
    }

    #[test]
    fn a_doubled_period_is_a_pair_half_an_order_away() {
        for revolutions in [8, 20] {
            let found = side_bands(
                &window(revolutions, |t| cos(2.0, t) + 0.2 * cos(1.5, t) + 0.1 * cos(2.5, t)),
                revolutions,
                8,
            );
            let of_two = found.iter().find(|pair| pair.engine_order == 2).unwrap();
            assert!((of_two.spacing - 0.5).abs() < 1e-9, "{of_two:?}");
            assert!((of_two.lower - 0.2).abs() < 1e-9 && (of_two.upper - 0.1).abs() < 1e-9, "{of_two:?}");
        }
    }

    #[test]
    fn what_is_no_pair_is_not_reported() {
        let clean = |t: f64| cos(2.0, t) + 0.3 * cos(3.0, t);
        assert!(side_bands(&window(20, clean), 20, 8).is_empty(), "engine orders alone");
        let decaying = |t: f64| clean(t) + 0.3 * (-t / 5.0).exp() * cos(2.37, t);
        assert!(side_bands(&window(20, decaying), 20, 8).is_empty(), "a transient is a single line");
        let close = |t: f64| clean(t) * (1.0 + 0.2 * cos(0.03, t));
        assert!(side_bands(&window(20, close), 20, 8).is_empty(), "within the window's resolution");
        for seed in 1..=50 {
            let mut state = seed;
            let white: Vec<f64> =
                (0..40 * SAMPLES).map(|n| clean(n as f64 / SAMPLES as f64) + noise(&mut state)).collect();
            assert!(side_bands(&white, 40, 16).is_empty(), "noise, seed {seed}");
        }
        // Six revolutions have no bins that a pair in the middle leaves free, one has none at all.
        assert!(side_bands(&window(6, |t| clean(t) * (1.0 + 0.2 * cos(0.5, t))), 6, 8).is_empty());
        assert!(side_bands(&window(1, clean), 1, 8).is_empty());
    }

    #[test]
    fn a_pair_in_noise_is_found_where_it_stands_out() {
        let mut state = 3;
        let samples: Vec<f64> = (0..100 * SAMPLES)
            .map(|n| {
                let t = n as f64 / SAMPLES as f64;
                cos(2.0, t) * (1.0 + 0.4 * cos(0.217, t)) + 0.3 * noise(&mut state)
            })
            .collect();
        let found = side_bands(&samples, 100, 16);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].spacing - 0.217).abs() < 0.2 * found[0].resolution, "{found:?}");
        assert!((found[0].lower - 0.2).abs() < 0.02, "{found:?}");
    }
}
