//! Growth rates by least squares.

/// Fewest values that a rate is fitted to.
const LEAST: usize = 5;

/// The slope of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rate {
    pub(super) value: f64,
    /// Standard error.
    pub(super) error: f64,
}

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
