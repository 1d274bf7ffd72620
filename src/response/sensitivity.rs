//! Can trajectories be compared? The growth of a tiny perturbation, from a run and its twin.
//!
//! The twin starts from a perturbed state. The distance between the two, relative to the response, is followed from revolution
//! to revolution; its growth rate while it is small is the largest Lyapunov exponent, as far as a run of that length can tell.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::growth::{Rate, rate};

/// What became of a tiny perturbation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Sensitivity {
    /// Whether it grew: trajectories then depend on round-off, and only statistics can be compared.
    pub chaotic: bool,
    /// Growth rate of the distance per revolution, natural logarithm; negative where it decays. Absent where too few
    /// revolutions lie between round-off and a hundredth of the response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_per_revolution: Option<f64>,
    /// Standard error of the rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_error: Option<f64>,
    /// Revolution by whose end the distance had passed a hundredth of the response, for good.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separated_after_revolutions: Option<u32>,
    /// Distance in the last revolution, relative to the response.
    pub last_distance: f64,
}

/// Trajectories farther apart than this share of the response have separated.
const SEPARATED: f64 = 1e-2;

/// Distances below this share of the response are round-off.
const ROUND_OFF: f64 = 1e-12;

/// A distance that has grown by this factor since the first revolution has grown.
const GROWN: f64 = 4.0;

/// A rate this many standard errors above 0 is one.
const CLEARLY: f64 = 3.0;

/// Judges a run and its twin, both `[sensor][sample]`, from revolution `from` on.
pub fn judge(run: &[Vec<f64>], twin: &[Vec<f64>], samples_per_revolution: usize, from: usize) -> Sensitivity {
    let revolutions = run.first().map_or(0, |line| line.len() / samples_per_revolution);
    let of = |value: &dyn Fn(usize, usize) -> f64, revolution: usize| -> f64 {
        let samples = revolution * samples_per_revolution..(revolution + 1) * samples_per_revolution;
        let sum = (0..run.len()).map(|sensor| samples.clone().map(|j| value(sensor, j).powi(2)).sum::<f64>());
        sum.sum::<f64>().sqrt()
    };
    // About the mean: a tip may lean steadily on the casing.
    let means: Vec<f64> = run.iter().map(|line| line.iter().sum::<f64>() / line.len() as f64).collect();
    let first = from.min(revolutions.saturating_sub(1));
    let response = (first..revolutions).map(|r| of(&|s, j| run[s][j] - means[s], r)).fold(0.0f64, f64::max);
    // Where nothing moves, nothing separates.
    let scale = if response > 0.0 { response } else { f64::INFINITY };
    let distances: Vec<f64> =
        (0..revolutions).map(|r| of(&|s, j| run[s][j] - twin[s][j], r) / scale).collect();
    let last = distances.last().copied().unwrap_or(0.0);
    let grown = last > GROWN * distances.first().copied().unwrap_or(0.0).max(ROUND_OFF);
    // From here on to the end.
    let separated = distances.iter().rposition(|&d| d <= SEPARATED).map_or(0, |near| near + 1);
    let separated = (grown && separated < revolutions).then_some(separated);
    let small =
        distances.iter().enumerate().skip(from).take(separated.unwrap_or(revolutions).saturating_sub(from));
    let line: Vec<(f64, f64)> =
        small.filter(|&(_, &d)| d > ROUND_OFF && d <= SEPARATED).map(|(r, &d)| (r as f64, d.ln())).collect();
    let fit = rate(&line);
    let grows = grown && fit.is_some_and(|Rate { value, error }| value > CLEARLY * error);
    Sensitivity {
        chaotic: separated.is_some() || grows,
        rate_per_revolution: fit.map(|rate| rate.value),
        rate_error: fit.map(|rate| rate.error),
        separated_after_revolutions: separated.map(|revolution| revolution as u32 + 1),
        last_distance: last,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const SAMPLES: usize = 16;

    /// A harmonic response about a mean, and the same with a perturbation of relative size `at(revolution)`.
    fn pair(at: impl Fn(f64) -> f64) -> [Vec<Vec<f64>>; 2] {
        let time = || (0..40 * SAMPLES).map(|j| j as f64 / SAMPLES as f64);
        let run = time().map(|t| 5.0 + (2.0 * TAU * t).sin()).collect();
        let twin = time().map(|t| 5.0 + (2.0 * TAU * t).sin() + at(t) * (3.0 * TAU * t).cos()).collect();
        [vec![run], vec![twin]]
    }

    #[test]
    fn finds_the_exponent_of_growth_and_decay() {
        for exponent in [0.1, -0.2] {
            let [run, twin] = pair(|t| 1e-7 * (exponent * t).exp());
            let found = judge(&run, &twin, SAMPLES, 2);
            assert!((found.rate_per_revolution.unwrap() - exponent).abs() < 0.01, "{found:?}");
            assert_eq!((found.chaotic, found.separated_after_revolutions), (exponent > 0.0, None));
        }
    }

    #[test]
    fn separation_for_good_is_said_and_one_that_heals_is_none() {
        let [run, twin] = pair(|t| (1e-7 * (0.8 * t).exp()).min(0.5));
        let found = judge(&run, &twin, SAMPLES, 2);
        assert!(found.chaotic && found.separated_after_revolutions == Some(15), "{found:?}");
        assert!((found.rate_per_revolution.unwrap() - 0.8).abs() < 0.02);
        let [run, twin] = pair(|t| if t < 10.0 { 0.1 } else { 0.1 * (10.0 - t).exp() });
        let found = judge(&run, &twin, SAMPLES, 2);
        assert!(!found.chaotic && found.separated_after_revolutions.is_none(), "{found:?}");
        // The same run twice.
        let found = judge(&run, &run, SAMPLES, 2);
        assert!(!found.chaotic && found.rate_per_revolution.is_none() && found.last_distance == 0.0);
    }

    #[test]
    fn what_decays_is_not_chaos() {
        // Motion that decays, and a perturbation that decays more slowly: in the end it is all there is.
        let decays = |rate: f64, amplitude: f64, t: f64| amplitude * (-rate * t).exp() * (TAU * t).sin();
        let time = || (0..40 * SAMPLES).map(|j| j as f64 / SAMPLES as f64);
        let run: Vec<f64> = time().map(|t| decays(1.5, 1.0, t)).collect();
        let twin = run.iter().zip(time()).map(|(x, t)| x + decays(0.3, 1e-7, t)).collect();
        assert!(!judge(&[run], &[twin], SAMPLES, 2).chaotic);
        // Nothing moves but the perturbation.
        let rest = vec![vec![0.0; 40 * SAMPLES]];
        let found = judge(&rest, &[time().map(|t| decays(0.0, 1e-7, t)).collect()], SAMPLES, 2);
        assert!(!found.chaotic && found.last_distance == 0.0, "{found:?}");
    }
}
