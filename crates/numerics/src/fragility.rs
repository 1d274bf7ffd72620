//! The probability that something holds as a function of one number: a fragility curve, P(x) = Φ(a + bx), from cases that held and
//! cases that did not.
//!
//! Whatever else varies between cases gives each a threshold, at which it changes from one to the other; the curve takes thresholds for
//! normally distributed. Fitted by maximum likelihood (Bliss, 1935; Shinozuka et al., J. Eng. Mech. 126, 2000, 1224–1231).

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

/// Result of fitting a fragility curve to cases in which a condition held or did not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fragility {
    /// Condition that held in all cases.
    Always,
    /// Condition that held in no case.
    Never,
    /// Cases that held and cases that did not lie apart: all thresholds may be the same, anywhere between these two.
    Apart {
        /// Largest x of the cases below.
        below: f64,
        /// Smallest x of the cases above.
        above: f64,
        /// Whether the condition holds above.
        rising: bool,
    },
    /// Curve of cases that overlap: some that held lie among those that did not.
    Curve(Curve),
}

/// Fragility curve P(x) = Φ(a + bx), about the mean of the cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    center: f64,
    a: f64,
    b: f64,
    /// Variances of a and b, and their covariance.
    covariance: (f64, f64, f64),
}

/// Point at which a curve has a given probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Position x; infinite where the curve does not change.
    pub x: f64,
    /// Interval in which the true x lies with the confidence that was asked for, by Fieller's theorem; an end is infinite where the cases
    /// do not bound it.
    pub interval: (f64, f64),
}

/// Change of a coefficient, as a share of its standard error, below which for all of them Fisher scoring stops.
const CONVERGED: f64 = 1e-10;
const MOST_ITERATIONS: usize = 100;

/// Fits the cases (x, whether the condition holds). None without cases, and where arithmetic overflows.
pub fn fit(cases: &[(f64, bool)]) -> Option<Fragility> {
    let xs = |wanted: bool| cases.iter().filter(move |(_, holds)| *holds == wanted).map(|(x, _)| *x);
    let ends =
        |wanted: bool| xs(wanted).map(|x| (x, x)).reduce(|(low, high), (x, _)| (low.min(x), high.max(x)));
    let (held, not) = match (ends(true), ends(false)) {
        (None, None) => return None,
        (Some(_), None) => return Some(Fragility::Always),
        (None, Some(_)) => return Some(Fragility::Never),
        (Some(held), Some(not)) => (held, not),
    };
    // Where the two overlap, and only there, the likelihood has a maximum (Albert and Anderson, 1984).
    if not.1 <= held.0 && not.0 < held.1 {
        return Some(Fragility::Apart { below: not.1, above: held.0, rising: true });
    }
    if held.1 <= not.0 && held.0 < not.1 {
        return Some(Fragility::Apart { below: held.1, above: not.0, rising: false });
    }
    maximum_likelihood(cases).map(Fragility::Curve)
}

/// Interval of x in which the probability may be met, for cases that lie apart ([`Fragility::Apart`]), with this `confidence`; an end is
/// infinite where there are too few.
///
/// Were the probability less than p at some x, it would be so at all x before, and n cases there would all hold with a chance of less than
/// pⁿ; beyond the n-th that held, where this is half of what the confidence leaves, it is no less than p. Cases that did not hold bound the
/// other end alike.
pub fn open_of_apart(cases: &[(f64, bool)], rising: bool, probability: f64, confidence: f64) -> (f64, f64) {
    let chance = 0.5 * (1.0 - confidence);
    let needed = |p: f64| (chance.ln() / p.ln()).ceil().max(1.0) as usize;
    // From the gap outwards.
    let sign = if rising { 1.0 } else { -1.0 };
    let nth = |wanted: bool, sign: f64, n: usize| {
        let of = cases.iter().filter(|(_, holds)| *holds == wanted);
        let mut outwards: Vec<f64> = of.map(|(x, _)| sign * x).collect();
        outwards.sort_by(f64::total_cmp);
        sign * outwards.get(n - 1).copied().unwrap_or(f64::INFINITY)
    };
    let held = nth(true, sign, needed(probability));
    let not = nth(false, -sign, needed(1.0 - probability));
    if rising { (not, held) } else { (held, not) }
}

fn maximum_likelihood(cases: &[(f64, bool)]) -> Option<Curve> {
    let n = cases.len() as f64;
    let center = cases.iter().map(|(x, _)| x).sum::<f64>() / n;
    let scale = (cases.iter().map(|(x, _)| (x - center).powi(2)).sum::<f64>() / n).sqrt();
    // At one x nothing tells a slope; a + 0·x has all there is to know.
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let standard = Normal::standard();
    let at = |x: f64| (x - center) / scale;
    // Of the smaller of the two probabilities the logarithm, which does not round to 0.
    let log_likelihood = |(a, b): (f64, f64)| -> f64 {
        let of = |&(x, holds): &(f64, bool)| {
            let eta = a + b * at(x);
            standard.cdf(if holds { eta } else { -eta }).max(f64::MIN_POSITIVE).ln()
        };
        cases.iter().map(of).sum()
    };
    let (mut a, mut b) = (0.0, 0.0);
    let mut covariance = (0.0, 0.0, 0.0);
    for _ in 0..MOST_ITERATIONS {
        let (mut score, mut information) = ((0.0, 0.0), (0.0, 0.0, 0.0));
        for &(x, holds) in cases {
            let z = at(x);
            let eta = a + b * z;
            let (density, p, q) = (standard.pdf(eta), standard.cdf(eta), standard.cdf(-eta));
            let denominator = (p * q).max(f64::MIN_POSITIVE);
            let weight = density * density / denominator;
            let residual =
                if holds { density / p.max(f64::MIN_POSITIVE) } else { -density / q.max(f64::MIN_POSITIVE) };
            score = (score.0 + residual, score.1 + residual * z);
            information =
                (information.0 + weight, information.1 + weight * z * z, information.2 + weight * z);
        }
        let determinant = information.0 * information.1 - information.2 * information.2;
        covariance = if determinant > 1e-12 * information.0 * information.0 {
            (information.1 / determinant, information.0 / determinant, -information.2 / determinant)
        } else {
            (1.0 / information.0, 0.0, 0.0)
        };
        let step = (
            covariance.0 * score.0 + covariance.2 * score.1,
            covariance.2 * score.0 + covariance.1 * score.1,
        );
        let (before, mut share) = (log_likelihood((a, b)), 1.0);
        while share > 1e-6 && log_likelihood((a + share * step.0, b + share * step.1)) < before {
            share *= 0.5;
        }
        (a, b) = (a + share * step.0, b + share * step.1);
        if step.0.abs() <= CONVERGED * covariance.0.sqrt() && step.1.abs() <= CONVERGED * covariance.1.sqrt()
        {
            break;
        }
    }
    let covariance = (covariance.0, covariance.1 / (scale * scale), covariance.2 / scale);
    let found = Curve { center, a, b: b / scale, covariance };
    [found.a, found.b, covariance.0, covariance.1, covariance.2]
        .iter()
        .all(|x| x.is_finite())
        .then_some(found)
}

impl Curve {
    /// Probability P(x).
    pub fn probability(&self, x: f64) -> f64 {
        Normal::standard().cdf(self.a + self.b * (x - self.center))
    }

    /// Whether the probability grows with x.
    pub fn is_rising(&self) -> bool {
        self.b > 0.0
    }

    /// Mean and standard deviation of the thresholds.
    pub fn thresholds(&self) -> (f64, f64) {
        (self.center - self.a / self.b, 1.0 / self.b.abs())
    }

    /// Point at which P is `probability`, with an interval of confidence `confidence`; both within (0, 1).
    ///
    /// The interval holds every x at which the cases leave open whether P(x) is more or less than `probability`: |Φ⁻¹(p) − a − bx| is no
    /// more than z of its standard errors (Fieller, 1954); all x where that is no interval.
    pub fn crossing(&self, probability: f64, confidence: f64) -> Crossing {
        let standard = Normal::standard();
        let wanted = standard.inverse_cdf(probability) - self.a;
        let z = standard.inverse_cdf(0.5 + 0.5 * confidence);
        let (var_a, var_b, cov) = self.covariance;
        // (wanted − b·x)² = z²(var_a + 2 cov·x + var_b·x²), a quadratic in x about the centre.
        let q = self.b * self.b - z * z * var_b;
        let h = self.b * wanted + z * z * cov;
        let c = wanted * wanted - z * z * var_a;
        let root = (h * h - q * c).max(0.0).sqrt();
        let interval = if q > 0.0 {
            (self.center + (h - root) / q, self.center + (h + root) / q)
        } else {
            (f64::NEG_INFINITY, f64::INFINITY)
        };
        Crossing { x: self.center + wanted / self.b, interval }
    }
}

#[cfg(test)]
mod tests {
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::sampling::quantile;

    fn cases(n: usize, seed: u64, mean: f64, deviation: f64, sign: f64) -> Vec<(f64, bool)> {
        let mut generator = SplitMix64::seed_from_u64(seed);
        let mut unit = || ((generator.next_u64() >> 12) as f64 + 0.5) / (1u64 << 52) as f64;
        let case = |_| {
            let (x, threshold) = (unit(), mean + deviation * quantile::standard_normal(unit()));
            (x, sign * (x - threshold) > 0.0)
        };
        (0..n).map(case).collect()
    }

    fn curve(cases: &[(f64, bool)]) -> Curve {
        let Some(Fragility::Curve(curve)) = fit(cases) else { panic!("{:?}", fit(cases)) };
        curve
    }

    #[test]
    fn thresholds_are_found_and_intervals_are_honest() {
        let (mean, deviation) = (0.4, 0.1);
        for (sign, n) in [(1.0, 150), (-1.0, 120)] {
            for p in [0.5, 0.9] {
                let exact = mean + sign * deviation * quantile::standard_normal(p);
                let trials = 300;
                let (mut within, mut width) = (0, 0.0);
                for seed in 0..trials {
                    let found = curve(&cases(n, seed, mean, deviation, sign));
                    assert_eq!(found.is_rising(), sign > 0.0);
                    let Crossing { x, interval } = found.crossing(p, 0.95);
                    assert!(interval.0 <= x && x <= interval.1, "{x} {interval:?}");
                    assert!((found.probability(x) - p).abs() < 1e-9);
                    within += u32::from(interval.0 <= exact && exact <= interval.1);
                    width += (interval.1 - interval.0) / trials as f64;
                }
                // 95 % of 300, ± four deviations of 3.8, and what an approximation for large numbers of cases may lack.
                assert!(within >= 265, "{within} of {trials}, p = {p}");
                assert!(width < 0.25, "{width}");
            }
        }
        let many = curve(&cases(20_000, 1, mean, deviation, 1.0)).thresholds();
        assert!((many.0 - mean).abs() < 0.01 && (many.1 - deviation).abs() < 0.01, "{many:?}");
    }

    /// Groups with three of four at x = 0 and one of four at 1: two parameters meet two shares exactly.
    #[test]
    fn two_groups_are_met_exactly() {
        let group = |x: f64, held: usize| (0..4).map(move |case| (x, case < held));
        let found = curve(&group(0.0, 3).chain(group(1.0, 1)).collect::<Vec<_>>());
        assert!((found.probability(0.0) - 0.75).abs() < 1e-9 && (found.probability(1.0) - 0.25).abs() < 1e-9);
        assert!((found.crossing(0.5, 0.95).x - 0.5).abs() < 1e-9);
        // At one place there is no slope: the probability is known, and no place where it is another.
        let found = curve(&group(2.0, 3).collect::<Vec<_>>());
        assert!((found.probability(2.0) - 0.75).abs() < 1e-9);
        assert_eq!(found.crossing(0.5, 0.95).interval, (f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn cases_apart_say_between_which() {
        let fit = |cases: &[(f64, bool)]| fit(cases).unwrap();
        assert_eq!(fit(&[(1.0, true), (3.0, true)]), Fragility::Always);
        assert_eq!(fit(&[(1.0, false)]), Fragility::Never);
        let apart = Fragility::Apart { below: 1.0, above: 2.0, rising: true };
        assert_eq!(fit(&[(2.0, true), (1.0, false), (0.5, false)]), apart);
        let apart = Fragility::Apart { below: 1.0, above: 1.0, rising: false };
        assert_eq!(fit(&[(1.0, true), (1.0, false), (0.5, true)]), apart);
        assert_eq!(super::fit(&[]), None);
    }

    /// Cases needed to say 90 % with a confidence of 95 %: 36 that held (0.9³⁶ < 0.025 < 0.9³⁵) and two that did not (0.1² < 0.025 < 0.1).
    #[test]
    fn cases_apart_say_as_much_as_they_are() {
        let case = |x: i32| (f64::from(x), x > 0);
        let cases: Vec<_> = (-10..=40).map(case).collect();
        assert_eq!(open_of_apart(&cases, true, 0.9, 0.95), (-1.0, 36.0));
        assert_eq!(open_of_apart(&cases[..45], true, 0.9, 0.95), (-1.0, f64::INFINITY));
        assert_eq!(open_of_apart(&cases[10..], true, 0.9, 0.95), (f64::NEG_INFINITY, 36.0));
        let mirrored: Vec<_> = cases.iter().map(|&(x, holds)| (-x, holds)).collect();
        assert_eq!(open_of_apart(&mirrored, false, 0.9, 0.95), (-36.0, 1.0));
    }
}
