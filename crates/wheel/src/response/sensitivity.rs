//! Sensitivity of trajectories: the growth of a tiny perturbation, from a run and its twin, tells whether they can be compared.
//!
//! The twin starts from a perturbed state. The distance between the two, relative to the response, is followed from revolution
//! to revolution. While it is small and after the transient, when both runs move on what attracts them, its growth rate is the largest
//! Lyapunov exponent: positive for chaos, zero for a torus (a quasi-periodic response), negative where the perturbation is
//! forgotten.

use serde::{Deserialize, Serialize};

use super::growth::{CLEARLY, Rate, SettledRate, settled_rate};
use super::settling::Verdict;

/// Growth of a tiny perturbation of the response: `chaotic` where the perturbation grows exponentially after the transient,
/// `quasi_periodic` where it neither grows nor decays and the response does not repeat, `stable` where it decays, or stays as it is beside
/// a response that repeats, `undecided` where the run is too short to say.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Growth {
    /// Perturbation that grows exponentially after the transient: trajectories depend on round-off, and only statistics can be compared.
    Chaotic,
    /// Perturbation that neither grows nor decays, beside a response that does not repeat.
    QuasiPeriodic,
    /// Perturbation that decays, or stays as it is beside a response that repeats.
    Stable,
    /// Run that is too short to say.
    #[default]
    Undecided,
}

/// Fate of a tiny perturbation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Sensitivity {
    /// Growth of the perturbation.
    #[serde(default)]
    pub growth: Growth,
    /// Growth rate of the distance per revolution after the transient, natural logarithm; negative where it decays. Absent where too few
    /// revolutions lie between round-off and a hundredth of the response, or the transient lasted to their end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_per_revolution: Option<f64>,
    /// Standard error of the rate, from eight or more blocks of revolutions: of their residuals, or of the slopes from one block to the
    /// next if those vary more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_error: Option<f64>,
    /// First revolution that the rate was fitted to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_from_revolution: Option<u32>,
    /// Revolution by whose end the distance had passed a hundredth of the response, for good.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separated_after_revolutions: Option<u32>,
    /// Distance between run and twin in the last revolution, relative to the response.
    pub last_distance: f64,
}

impl Sensitivity {
    /// Rate and its standard error in words, if there is one.
    pub fn rate_in_words(&self) -> Option<String> {
        let (rate, error, from) = (self.rate_per_revolution?, self.rate_error?, self.rate_from_revolution?);
        Some(format!("e^({rate:.3} ± {error:.3}) a revolution from revolution {from} on"))
    }
}

/// Share of the response from which on trajectories have separated.
const SEPARATED: f64 = 1e-2;

/// Share of the response below which distances are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Factor by which a distance has to change to have grown, or decayed. Neutral motion changes distances too, but no faster than in
/// proportion to time, and an exponential is not told from that over less.
const GROWN: f64 = 4.0;

/// Number of revolutions that are too few for a rate.
const FEW: usize = 10;

/// Number of revolutions over which a distance that stays small must grow, or stay as it is, before that is believed.
const LASTING: f64 = 20.0;

/// Judges a run and its twin, both `[sensor][sample]`, from revolution `from` on; `verdict` is that of the run.
pub fn judge(
    run: &[Vec<f64>],
    twin: &[Vec<f64>],
    samples_per_revolution: usize,
    from: usize,
    verdict: Verdict,
) -> Sensitivity {
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
    let near = &distances[..separated.unwrap_or(revolutions)];
    let forgotten = separated.is_none() && near.iter().skip(from).any(|&d| d <= ROUND_OFF);
    let small = near.iter().enumerate().skip(from).filter(|&(_, &d)| d > ROUND_OFF && d <= SEPARATED);
    let line: Vec<(f64, f64)> = small.map(|(revolution, &d)| (revolution as f64, d.ln())).collect();
    let settled = settled_rate(&line);
    let growth = match settled {
        _ if forgotten => Growth::Stable,
        Some(settled) => of_rate(settled, separated.is_some(), verdict),
        // Through orders of magnitude within fewer revolutions than a rate takes.
        None if separated.is_some() && line.len() < FEW => Growth::Chaotic,
        None => Growth::Undecided,
    };
    Sensitivity {
        growth,
        rate_per_revolution: settled.map(|settled| settled.rate.value),
        rate_error: settled.map(|settled| settled.rate.error),
        rate_from_revolution: settled.map(|settled| line[settled.transient].0 as u32 + 1),
        separated_after_revolutions: separated.map(|revolution| revolution as u32 + 1),
        last_distance: last,
    }
}

fn of_rate(settled: SettledRate, separated: bool, verdict: Verdict) -> Growth {
    let SettledRate { rate: Rate { value, error }, span, .. } = settled;
    let (clear, change) = (value.abs() > CLEARLY * error, GROWN.ln() / span);
    // What grows a little, or while the response itself still changes, may be a transient.
    let lasting = span >= LASTING;
    if clear && value > change && (separated || (lasting && verdict != Verdict::NotSettled)) {
        Growth::Chaotic
    } else if separated {
        // What carried them apart is not in this rate.
        Growth::Undecided
    } else if clear && value < -change {
        Growth::Stable
    } else if value.abs() > change || error > change || !lasting {
        Growth::Undecided
    } else if matches!(verdict, Verdict::Periodic | Verdict::Subharmonic) {
        Growth::Stable
    } else {
        Growth::QuasiPeriodic
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const SAMPLES: usize = 16;

    /// Harmonic response about a mean, and the same with a perturbation of relative size `at(revolution)`.
    fn pair(at: impl Fn(f64) -> f64) -> [Vec<Vec<f64>>; 2] {
        let time = || (0..40 * SAMPLES).map(|j| j as f64 / SAMPLES as f64);
        let run = time().map(|t| 5.0 + (2.0 * TAU * t).sin()).collect();
        let twin = time().map(|t| 5.0 + (2.0 * TAU * t).sin() + at(t) * (3.0 * TAU * t).cos()).collect();
        [vec![run], vec![twin]]
    }

    fn judged([run, twin]: &[Vec<Vec<f64>>; 2]) -> Sensitivity {
        judge(run, twin, SAMPLES, 2, Verdict::Aperiodic)
    }

    #[test]
    fn finds_the_exponent_of_growth_and_decay() {
        for (exponent, growth) in [(0.1, Growth::Chaotic), (-0.2, Growth::Stable)] {
            let found = judged(&pair(|t| 1e-7 * (exponent * t).exp()));
            assert!((found.rate_per_revolution.unwrap() - exponent).abs() < 0.01, "{found:?}");
            assert_eq!((found.growth, found.separated_after_revolutions), (growth, None));
        }
    }

    #[test]
    fn separation_for_good_is_said_and_one_that_heals_is_none() {
        let found = judged(&pair(|t| (1e-7 * (0.8 * t).exp()).min(0.5)));
        assert!(
            found.growth == Growth::Chaotic && found.separated_after_revolutions == Some(15),
            "{found:?}"
        );
        assert!((found.rate_per_revolution.unwrap() - 0.8).abs() < 0.02);
        let found = judged(&pair(|t| if t < 10.0 { 0.1 } else { 0.1 * (10.0 - t).exp() }));
        assert!(found.growth == Growth::Stable && found.separated_after_revolutions.is_none(), "{found:?}");
        // The same run twice.
        let [run, _] = pair(|_| 0.0);
        let found = judged(&[run.clone(), run]);
        assert_eq!((found.growth, found.rate_per_revolution), (Growth::Stable, None));
        assert_eq!(found.last_distance, 0.0);
    }

    #[test]
    fn what_decays_is_not_chaos() {
        // Motion that decays, and a perturbation that decays more slowly: in the end it is all there is.
        let decays = |rate: f64, amplitude: f64, t: f64| amplitude * (-rate * t).exp() * (TAU * t).sin();
        let time = || (0..40 * SAMPLES).map(|j| j as f64 / SAMPLES as f64);
        let run: Vec<f64> = time().map(|t| decays(1.5, 1.0, t)).collect();
        let twin = run.iter().zip(time()).map(|(x, t)| x + decays(0.3, 1e-7, t)).collect();
        assert_eq!(judged(&[vec![run], vec![twin]]).growth, Growth::Stable);
        // Nothing moves but the perturbation.
        let perturbation = time().map(|t| decays(0.0, 1e-7, t)).collect();
        let found = judged(&[vec![vec![0.0; 40 * SAMPLES]], vec![perturbation]]);
        assert!(found.growth == Growth::Stable && found.last_distance == 0.0, "{found:?}");
    }

    /// Orbits of a map's two coordinates from `start`, one iterate a revolution, and from `start` shifted by `by`.
    fn orbits(
        map: impl Fn([f64; 2]) -> [f64; 2],
        start: [f64; 2],
        by: f64,
        count: usize,
    ) -> [Vec<Vec<f64>>; 2] {
        [start, [start[0] + by, start[1]]].map(|start| {
            let orbit: Vec<_> = std::iter::successors(Some(start), |&at| Some(map(at))).take(count).collect();
            (0..2).map(|c| orbit.iter().map(|at| at[c]).collect()).collect()
        })
    }

    /// Hénon's map, with an exponent of 0.4192 an iterate.
    #[test]
    fn a_chaotic_map_has_its_exponent() {
        let [run, twin] = orbits(|[x, y]| [1.0 - 1.4 * x * x + y, 0.3 * x], [0.6, 0.2], 1e-10, 100);
        let found = judge(&run, &twin, 1, 2, Verdict::Aperiodic);
        assert!(found.growth == Growth::Chaotic && found.separated_after_revolutions.is_some(), "{found:?}");
        let (rate, error) = (found.rate_per_revolution.unwrap(), found.rate_error.unwrap());
        assert!((rate - 0.4192).abs() < CLEARLY * error && error < 0.05, "{found:?}");
    }

    /// Delayed logistic map x⁺ = a x (1 − x⁻): beyond a = 2 the fixed point 1 − 1/a gives way to a closed curve on which orbits turn with
    /// two frequencies. A perturbation grows by √(a − 1) an iterate as long as the orbit spirals outwards from the fixed point, and not at
    /// all on the curve. At a = 2.27 the curve has broken up into chaos.
    fn delayed(a: f64, count: usize) -> [Vec<Vec<f64>>; 2] {
        let fixed = 1.0 - 1.0 / a;
        orbits(|[x, before]| [a * x * (1.0 - before), x], [fixed + 0.01, fixed], 1e-8, count)
    }

    #[test]
    fn growth_over_a_transient_is_not_chaos() {
        let [run, twin] = delayed(2.1, 240);
        let found = judge(&run, &twin, 1, 2, Verdict::Aperiodic);
        assert_eq!(found.growth, Growth::QuasiPeriodic, "{found:?}");
        assert!(found.rate_from_revolution.unwrap() > 50, "{found:?}");
        let (rate, error) = (found.rate_per_revolution.unwrap(), found.rate_error.unwrap());
        assert!(rate.abs() < CLEARLY * error && error < 0.01, "{found:?}");
        // The distance has grown all the same.
        assert!(found.last_distance > 1e-6, "{found:?}");
        let [run, twin] = delayed(2.27, 240);
        let found = judge(&run, &twin, 1, 2, Verdict::Aperiodic);
        assert_eq!(found.growth, Growth::Chaotic, "{found:?}");
    }

    #[test]
    fn too_short_a_run_is_undecided() {
        let judged = |revolutions: usize, verdict: Verdict| {
            let [run, twin] = delayed(2.1, 240)
                .map(|lines| lines.iter().map(|line| line[240 - revolutions..].to_vec()).collect::<Vec<_>>());
            judge(&run, &twin, 1, 0, verdict).growth
        };
        assert_eq!(judged(12, Verdict::Aperiodic), Growth::Undecided);
        assert_eq!(judged(100, Verdict::Aperiodic), Growth::QuasiPeriodic);
        // While the orbit spirals outwards, growth is that of the response itself.
        let [run, twin] = delayed(2.1, 60);
        let growing = judge(&run, &twin, 1, 2, Verdict::NotSettled);
        assert!(growing.rate_per_revolution.unwrap() > 0.03, "{growing:?}");
        assert_eq!(growing.growth, Growth::Undecided);
        // Beside a response that repeats, what does not grow is no second frequency.
        let [run, twin] = pair(|_| 1e-7);
        assert_eq!(judge(&run, &twin, SAMPLES, 2, Verdict::Periodic).growth, Growth::Stable);
    }
}
