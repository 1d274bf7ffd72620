//! Quantile functions: the number below which a share u of a distribution lies, for u in (0, 1).
//!
//! Parameters are not checked: the caller has made sure that they make sense (`from < to`, deviations above 0, no NaN).

use statrs::distribution::{ContinuousCDF, Normal};

/// Quantile of the standard normal distribution: Φ⁻¹(u).
pub fn standard_normal(u: f64) -> f64 {
    Normal::standard().inverse_cdf(u)
}

/// Quantile of the uniform distribution in `[from, to]`.
pub fn uniform(u: f64, (from, to): (f64, f64)) -> f64 {
    from + u * (to - from)
}

/// Quantile of the distribution in `[from, to]` whose logarithm is uniform; 0 < `from`.
pub fn log_uniform(u: f64, (from, to): (f64, f64)) -> f64 {
    uniform(u, (from.ln(), to.ln())).exp().clamp(from, to)
}

/// Quantile of the triangular distribution in `[from, to]` with its peak at `mode`, which may be an end.
pub fn triangular(u: f64, (from, to): (f64, f64), mode: f64) -> f64 {
    let width = to - from;
    if u * width < mode - from {
        from + (u * width * (mode - from)).sqrt()
    } else {
        to - ((1.0 - u) * width * (to - mode)).sqrt()
    }
}

/// Quantile of the normal distribution, cut off at `from` and `to` (either may be infinite) and scaled to a probability of 1.
pub fn truncated_normal(u: f64, mean: f64, standard_deviation: f64, (from, to): (f64, f64)) -> f64 {
    let standard = Normal::standard();
    let (low, high) = ((from - mean) / standard_deviation, (to - mean) / standard_deviation);
    // In the lower tail, where shares are told apart: what is nearly 1 has no digits left.
    let z = if low > 0.0 {
        -standard.inverse_cdf(uniform(u, (standard.cdf(-low), standard.cdf(-high))))
    } else {
        standard.inverse_cdf(uniform(u, (standard.cdf(low), standard.cdf(high))))
    };
    (mean + standard_deviation * z).clamp(from, to)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance by the midpoint rule over u.
    fn moments(quantile: impl Fn(f64) -> f64) -> (f64, f64) {
        let n = 200_000;
        let all: Vec<f64> = (0..n).map(|i| quantile((f64::from(i) + 0.5) / f64::from(n))).collect();
        let mean = all.iter().sum::<f64>() / f64::from(n);
        (mean, all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n))
    }

    fn assert_moments(quantile: impl Fn(f64) -> f64, mean: f64, variance: f64) {
        let found = moments(quantile);
        // Midpoints miss what lies beyond the outermost of them; of the normal distribution that is the most, 1e-4 of its variance.
        assert!((found.0 - mean).abs() < 1e-6 * mean.abs().max(1.0), "{found:?}, mean {mean}");
        assert!((found.1 / variance - 1.0).abs() < 2e-4, "{found:?}, variance {variance}");
    }

    #[test]
    fn moments_are_those_of_the_closed_forms() {
        assert_moments(|u| uniform(u, (2.0, 5.0)), 3.5, 9.0 / 12.0);
        let (a, b) = (0.1f64, 10.0f64);
        let width = (b / a).ln();
        let mean = (b - a) / width;
        assert_moments(|u| log_uniform(u, (a, b)), mean, (b * b - a * a) / (2.0 * width) - mean * mean);
        for (a, c, b) in [(1.0, 2.0, 4.0), (1.0, 1.0, 4.0), (1.0, 4.0, 4.0)] {
            let variance = (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0;
            assert_moments(|u| triangular(u, (a, b), c), (a + b + c) / 3.0, variance);
        }
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        assert_moments(|u| truncated_normal(u, 3.0, 0.5, everywhere), 3.0, 0.25);
    }

    /// Moments of a normal distribution cut to (α, β) in deviations: mean μ + σ(φ(α) − φ(β))/Z, variance σ²(1 + (αφ(α) − βφ(β))/Z − (…)²).
    #[test]
    fn cut_normals_have_the_moments_of_the_closed_form() {
        use statrs::distribution::Continuous;
        let standard = Normal::standard();
        for (mean, deviation, from, to) in
            [(0.3, 0.02, 0.25, 0.33), (0.0, 1.0, 2.0, 6.0), (5.0, 1.0, 0.0, 3.0)]
        {
            let (alpha, beta) = ((from - mean) / deviation, (to - mean) / deviation);
            let (z, a, b) =
                (standard.cdf(beta) - standard.cdf(alpha), standard.pdf(alpha), standard.pdf(beta));
            let shift = (a - b) / z;
            let variance = deviation * deviation * (1.0 + (alpha * a - beta * b) / z - shift * shift);
            let quantile = |u| truncated_normal(u, mean, deviation, (from, to));
            assert_moments(quantile, mean + deviation * shift, variance);
            assert!([1e-9, 0.5, 1.0 - 1e-9].into_iter().map(quantile).all(|x| (from..=to).contains(&x)));
        }
    }

    #[test]
    fn quantiles_of_the_normal_distribution_are_those_of_tables() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.1.
        for (u, z) in [(0.5, 0.0), (0.975, 1.959_963_985), (0.99, 2.326_347_874), (0.001, -3.090_232_306)] {
            assert!((standard_normal(u) - z).abs() < 1e-8, "{u}");
        }
    }
}
