//! Decimation from steps to samples without aliasing (docs/method.md, Sampling).
//!
//! A sample is a weighted mean of the steps around it, the weights a windowed sinc (Kaiser): orders up to an eighth of the samples of a
//! revolution pass within 2e-5, orders from seven eighths on, which would fold onto them, are taken down by 94 dB. Orders in between fold
//! onto orders that nobody asked for. The window is taken as periodic, as its Fourier transform takes it, so that nothing is delayed and
//! nothing beyond it is needed.

use std::f64::consts::PI;

/// Number of intervals between samples that the weights reach on either side.
const REACH: usize = 4;

/// Kaiser's β for 94 dB, which takes the transition band that [`REACH`] intervals give: three quarters of the sampling rate.
const SHAPE: f64 = 0.1102 * (94.0 - 8.7);

/// Accumulator of steps into samples.
#[derive(Debug)]
pub(super) struct Decimation {
    /// Weights on the samples from `REACH` − 1 intervals before to `REACH` after the beginning of an interval, `[step within an interval][sample]`.
    weights: Vec<[f64; 2 * REACH]>,
    /// Number of values that are read at a step.
    width: usize,
    samples: usize,
    /// Weighted sums, `[sample][number]`.
    sums: Vec<f64>,
    /// Number of steps added.
    steps: usize,
}

impl Decimation {
    /// Decimation of `width` numbers a step, `interval` steps a sample, to `samples` in all.
    pub(super) fn new(width: usize, interval: usize, samples: usize) -> Self {
        let weight = |step: usize, sample: usize| {
            kernel(sample as f64 - (REACH - 1) as f64 - step as f64 / interval as f64)
        };
        let weights = |step: usize| std::array::from_fn(|sample| weight(step, sample));
        let mut weights: Vec<[f64; 2 * REACH]> = (0..interval).map(weights).collect();
        // A constant passes to the last digit.
        let sum: f64 = weights.iter().flatten().sum();
        weights.iter_mut().flatten().for_each(|weight| *weight /= sum);
        Self { weights, width, samples, sums: vec![0.0; width * samples], steps: 0 }
    }

    /// Reduces the number of samples to `samples`, before any step is added.
    pub(super) fn shorten(&mut self, samples: usize) {
        self.samples = samples;
        self.sums.truncate(self.width * samples);
    }

    /// Adds the next step.
    #[inline(always)]
    pub(super) fn add(&mut self, step: &[f64]) {
        self.steps += 1;
        let interval = self.weights.len();
        // The first sample ends the first interval.
        let begun = self.steps / interval + self.samples * REACH - REACH;
        for (place, &weight) in self.weights[self.steps % interval].iter().enumerate() {
            if weight != 0.0 {
                let sample = (begun + place) % self.samples;
                let sums = &mut self.sums[sample * self.width..][..self.width];
                for (sum, &value) in sums.iter_mut().zip(step) {
                    *sum += weight * value;
                }
            }
        }
    }

    /// Samples of the number with index `number`.
    pub(super) fn line(&self, number: usize) -> Vec<f64> {
        self.sums.iter().skip(number).step_by(self.width).copied().collect()
    }
}

/// Weight sinc, cut by Kaiser's window, `intervals` from its middle.
fn kernel(intervals: f64) -> f64 {
    let share = intervals / REACH as f64;
    if share.abs() >= 1.0 {
        return 0.0;
    }
    let sinc = if intervals == 0.0 {
        1.0
    } else if intervals.fract() == 0.0 {
        0.0
    } else {
        (PI * intervals).sin() / (PI * intervals)
    };
    sinc * bessel(SHAPE * (1.0 - share * share).sqrt()) / bessel(SHAPE)
}

/// Bessel function I₀ by its series.
fn bessel(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for n in 1..60 {
        term *= (0.5 * x / f64::from(n)).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use rubmap_numerics::spectrum::amplitudes;

    /// Samples of a tone of order `order` (and one more number, which is its double), 3 revolutions of 64.
    fn sampled(order: f64, interval: usize) -> Decimation {
        let (samples, revolutions) = (64, 3);
        let mut decimation = Decimation::new(2, interval, samples * revolutions);
        for step in 1..=samples * revolutions * interval {
            let phase = TAU * order * step as f64 / (samples * interval) as f64;
            decimation.add(&[(phase + 0.3).cos(), 2.0 * (phase + 0.3).cos()]);
        }
        decimation
    }

    #[test]
    fn tones_inside_the_band_pass_and_those_that_would_fold_onto_it_do_not() {
        for interval in [2, 3, 7, 20] {
            for order in [0.0, 1.0, 2.0 / 3.0, 5.0, 8.0] {
                let found = sampled(order, interval);
                for (number, factor) in [(0, 1.0), (1, 2.0)] {
                    for (sample, value) in found.line(number).into_iter().enumerate() {
                        let tone = factor * (TAU * order * (sample + 1) as f64 / 64.0 + 0.3).cos();
                        assert!((value - tone).abs() < 1e-4 * factor, "{interval} {order} {value} {tone}");
                    }
                }
            }
            // 64 − 8 and 64 + 8 are the first to fold onto 8 and below, 128 ± 8 the next.
            for order in [56.0, 60.0, 64.0, 72.0, 120.0, 131.0] {
                if 2.0 * order <= (64 * interval) as f64 {
                    let left = amplitudes(&sampled(order, interval).line(0), 30);
                    let most = left.iter().fold(0.0f64, |most, a| most.max(*a));
                    assert!(most < 1e-4, "{interval} {order} {most}");
                }
            }
        }
    }

    #[test]
    fn where_every_step_is_a_sample_nothing_changes() {
        let found = sampled(31.0, 1).line(0);
        for (sample, value) in found.into_iter().enumerate() {
            assert_eq!(value, (TAU * 31.0 * (sample + 1) as f64 / 64.0 + 0.3).cos());
        }
    }
}
