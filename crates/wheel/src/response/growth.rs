//! Growth rates by least squares.

/// Least number of values that a rate is fitted to.
const LEAST: usize = 5;

/// Slope of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rate {
    pub(super) value: f64,
    /// Standard error of the slope.
    pub(super) error: f64,
}

/// Number of standard errors from which on two rates differ.
pub(super) const CLEARLY: f64 = 3.0;

/// Slope of the least-squares line through `points`; none for fewer than five.
pub(super) fn rate(points: &[(f64, f64)]) -> Option<Rate> {
    if points.len() < LEAST {
        return None;
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let value = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / xx;
    let left: f64 = points.iter().map(|p| (p.1 - y - value * (p.0 - x)).powi(2)).sum();
    Some(Rate { value, error: (left / ((n - 2.0) * xx)).sqrt() })
}

/// Rate after the transient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SettledRate {
    pub(super) rate: Rate,
    /// Number of points of the transient, before those that the rate was fitted to.
    pub(super) transient: usize,
    /// Length of the part that the rate was fitted to.
    pub(super) span: f64,
}

/// Number of blocks that a rate is fitted to, if there are so many points.
const BLOCKS: usize = 8;

/// Change that the difference of two slopes must add to the line over a half for the halves to differ.
const ALIKE: f64 = 0.1;

/// Rate of the longest part at the end of `points` whose two halves grow alike: the rest after giving a quarter at a time to the transient.
/// None if the halves of the last ten still differ.
///
/// Neighbouring points are not independent of each other: a response that beats carries the logarithm of a distance up and down over
/// many of them, and in chaos it wanders. The line therefore goes through the means of eight blocks or more, and its standard error is
/// the larger of that of their residuals (right for what varies about a line) and that of the slopes from block to block (right for a
/// growth that itself varies).
pub(super) fn settled_rate(points: &[(f64, f64)]) -> Option<SettledRate> {
    let mut transient = 0;
    loop {
        let part = &points[transient..];
        let (first, second) = part.split_at(part.len() / 2);
        let means = block_means(part);
        let (line, a, b) = (rate(&means)?, rate(&block_means(first))?, rate(&block_means(second))?);
        let span = part[part.len() - 1].0 - part[0].0;
        if (a.value - b.value).abs() <= CLEARLY * a.error.hypot(b.error) + 2.0 * ALIKE / span {
            let rate = Rate { error: line.error.max(wandering(&means)), ..line };
            return Some(SettledRate { rate, transient, span });
        }
        transient += part.len().div_ceil(4);
    }
}

/// Means of blocks of points, counted from the end.
fn block_means(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let length = (points.len() / BLOCKS).max(1);
    let mean = |block: &[(f64, f64)]| {
        let sum = block.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
        (sum.0 / length as f64, sum.1 / length as f64)
    };
    points.rchunks_exact(length).rev().map(mean).collect()
}

/// Standard error of the mean slope from one point to the next.
fn wandering(points: &[(f64, f64)]) -> f64 {
    let slopes: Vec<f64> = points.windows(2).map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0)).collect();
    let n = slopes.len() as f64;
    let mean = slopes.iter().sum::<f64>() / n;
    (slopes.iter().map(|slope| (slope - mean).powi(2)).sum::<f64>() / ((n - 1.0) * n)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize, of: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..count).map(|r| (r as f64, of(r as f64))).collect()
    }

    #[test]
    fn a_transient_is_left_out() {
        let found = settled_rate(&points(120, |r| 0.3 * r.min(70.0) + 0.05 * r)).unwrap();
        assert!((60..=80).contains(&found.transient), "{found:?}");
        assert!((found.rate.value - 0.05).abs() <= CLEARLY * found.rate.error + 0.01, "{found:?}");
        let steady = settled_rate(&points(120, |r| 0.05 * r)).unwrap();
        assert!(steady.transient == 0 && steady.span == 119.0, "{steady:?}");
        assert!((steady.rate.value - 0.05).abs() < 1e-12 && steady.rate.error < 1e-12, "{steady:?}");
    }

    /// Beats over many points are no growth, though the error of single points, taken as independent, would say so.
    #[test]
    fn beats_are_within_the_error() {
        for phase in 0..20 {
            let line = points(60, |r| (0.35 * r + 0.3 * f64::from(phase)).sin());
            let found = settled_rate(&line).unwrap().rate;
            assert!(found.value.abs() <= CLEARLY * found.error, "{phase} {found:?}");
            assert!(found.error > 2.0 * rate(&line).unwrap().error, "{phase} {found:?}");
        }
    }

    /// Line whose slope changes at random: the error is that of the mean of 100 slopes, 0.03, not that of points about a line.
    #[test]
    fn a_growth_that_varies_is_known_no_better_than_that() {
        let mut seed = 1u64;
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut outside = 0;
        for _ in 0..200 {
            let mut at = 0.0;
            // Slopes between −0.32 and 0.72 have a standard deviation of 0.3.
            let line = points(100, |_| 0.0).into_iter().map(|(x, _)| {
                at += 0.2 + 1.04 * (uniform() - 0.5);
                (x, at)
            });
            let found = settled_rate(&line.collect::<Vec<_>>());
            outside += u32::from(
                found.is_none_or(|found| (found.rate.value - 0.2).abs() > CLEARLY * found.rate.error),
            );
        }
        assert!(outside < 40, "{outside} of 200");
    }

    #[test]
    fn what_never_settles_has_no_rate() {
        assert_eq!(settled_rate(&points(40, |r| (0.2 * r).exp())), None);
        assert_eq!(settled_rate(&points(9, |r| r)), None);
    }
}
