//! Smooth curves around the circumference.

use std::f64::consts::TAU;

/// Periodic cubic spline: twice continuously differentiable, through its points, of fourth order in their distance (de Boor, A
/// Practical Guide to Splines, 1978, chapter IV).
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSpline {
    /// Angles of the points, ascending, within one turn.
    angles_rad: Vec<f64>,
    values: Vec<f64>,
    /// Second derivatives at the points, per rad².
    curvatures: Vec<f64>,
}

impl PeriodicSpline {
    /// Spline through `values` at `angles_rad`, which ascend strictly within one turn, three at least.
    ///
    /// # Panics
    /// If the angles do not ascend so, or are fewer.
    pub fn new(angles_rad: &[f64], values: &[f64]) -> Self {
        let n = angles_rad.len();
        assert!(n >= 3 && values.len() == n, "three points at least");
        let ascending = angles_rad.windows(2).all(|pair| pair[0] < pair[1]);
        assert!(ascending && angles_rad[n - 1] - angles_rad[0] < TAU, "angles ascend within one turn");
        let width = |i: usize| {
            if i + 1 < n { angles_rad[i + 1] - angles_rad[i] } else { angles_rad[0] + TAU - angles_rad[i] }
        };
        let slope = |i: usize| (values[(i + 1) % n] - values[i]) / width(i);
        let widths: Vec<f64> = (0..n).map(width).collect();
        let right: Vec<f64> = (0..n).map(|i| 6.0 * (slope(i) - slope((i + n - 1) % n))).collect();
        Self {
            angles_rad: angles_rad.to_vec(),
            values: values.to_vec(),
            curvatures: curvatures(&widths, &right),
        }
    }

    /// Value of the spline at any angle.
    pub fn at(&self, angle_rad: f64) -> f64 {
        let (n, first) = (self.angles_rad.len(), self.angles_rad[0]);
        let within = (angle_rad - first).rem_euclid(TAU) + first;
        let i = self.angles_rad.partition_point(|&angle| angle <= within).max(1) - 1;
        let next = (i + 1) % n;
        let end = if next == 0 { first + TAU } else { self.angles_rad[next] };
        let width = end - self.angles_rad[i];
        let (a, b) = ((end - within) / width, (within - self.angles_rad[i]) / width);
        let bend = |x: f64| (x * x - 1.0) * x * width * width / 6.0;
        a * self.values[i]
            + b * self.values[next]
            + bend(a) * self.curvatures[i]
            + bend(b) * self.curvatures[next]
    }

    /// Number of times that the spline repeats in a turn; 0 if it is the same all around.
    pub(super) fn repeats(&self) -> usize {
        points_repeat(&self.angles_rad, &self.values)
    }

    /// Smallest and largest value between every point and the next, `(angle, value)` each, where the cubic has them.
    fn extremes(&self) -> impl Iterator<Item = (f64, f64)> {
        let n = self.angles_rad.len();
        (0..n).flat_map(move |i| {
            let next = (i + 1) % n;
            let start = self.angles_rad[i];
            let end = if next == 0 { self.angles_rad[0] + TAU } else { self.angles_rad[next] };
            let h = end - start;
            let (m0, m1) = (self.curvatures[i], self.curvatures[next]);
            // The slope at start + t is s + m0 t + (m1 − m0) t²/2h.
            let slope = (self.values[next] - self.values[i]) / h - h * (2.0 * m0 + m1) / 6.0;
            let (a, b) = (0.5 * (m1 - m0) / h, m0);
            let root = (b * b - 4.0 * a * slope).sqrt();
            // Without cancellation; what divides by zero is no place within.
            let q = -0.5 * (b + root.copysign(b));
            let turns = [q / a, slope / q].into_iter().filter(move |t| (0.0..=h).contains(t));
            turns.map(move |t| start + t).chain([start]).map(|angle| (angle, self.at(angle)))
        })
    }

    /// Highest point of the spline, `(angle, value)`.
    pub fn highest(&self) -> (f64, f64) {
        self.extremes().fold((0.0, f64::NEG_INFINITY), |most, one| if one.1 > most.1 { one } else { most })
    }

    /// Lowest point of the spline, `(angle, value)`.
    pub fn lowest(&self) -> (f64, f64) {
        self.extremes().fold((0.0, f64::INFINITY), |least, one| if one.1 < least.1 { one } else { least })
    }
}

/// Half-width w of a Gaussian exp(−(φ/w)²) as high as the whole range of the curves and as sharp as the sharpest of their bends, rad: w² =
/// 2 range/max|p″|. Infinite where nothing bends.
pub fn narrowest_rad(curves: &[PeriodicSpline]) -> f64 {
    let bend = curves.iter().flat_map(|curve| &curve.curvatures).fold(0.0f64, |most, m| most.max(m.abs()));
    let range = |curve: &PeriodicSpline| curve.highest().1 - curve.lowest().1;
    let range = curves.iter().map(range).fold(0.0, f64::max);
    if range > 0.0 { (2.0 * range / bend).sqrt() } else { f64::INFINITY }
}

/// Largest m such that `values` at `angles_rad`, which ascend within one turn, are the same after a turn by 1/m; 0 if they are the same all around.
pub fn points_repeat(angles_rad: &[f64], values: &[f64]) -> usize {
    let n = angles_rad.len().min(values.len());
    let scale = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let same = |by: usize| {
        (0..n).all(|i| {
            let (to, turns) = ((i + by) % n, ((i + by) / n) as f64);
            let turned = angles_rad[to] + TAU * turns - angles_rad[i];
            (turned - TAU * by as f64 / n as f64).abs() <= ALIKE
                && (values[to] - values[i]).abs() <= ALIKE * scale
        })
    };
    if values.iter().all(|value| (value - values[0]).abs() <= ALIKE * scale) {
        return 0;
    }
    let shift = (1..n).find(|&by| n.is_multiple_of(by) && same(by));
    shift.map_or(1, |by| n / by)
}

/// Tolerance of points that come from decimal numbers: angles this near (rad) to each other count as the same, and so do heights that
/// differ by this share of the largest.
pub const ALIKE: f64 = 1e-9;

/// Solves h_{i−1} m_{i−1} + 2(h_{i−1} + h_i) m_i + h_i m_{i+1} = r_i, indices modulo n: a tridiagonal system and a correction of rank one
/// for its corners. The matrix is diagonally dominant, so that no pivots are needed.
fn curvatures(widths: &[f64], right: &[f64]) -> Vec<f64> {
    let n = widths.len();
    let before = |i: usize| widths[(i + n - 1) % n];
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (before(i) + widths[i])).collect();
    // The corners are h_{n−1} both: A = T + u vᵀ with u = (γ, 0 …, h), v = (1, 0 …, h/γ).
    let (corner, gamma) = (widths[n - 1], -diagonal[0]);
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    let solve = |right: &[f64]| {
        let (mut x, mut above) = (right.to_vec(), vec![0.0; n]);
        x[0] /= diagonal[0];
        for i in 1..n {
            let below = widths[i - 1];
            above[i - 1] =
                below / if i == 1 { diagonal[0] } else { diagonal[i - 1] - widths[i - 2] * above[i - 2] };
            x[i] = (x[i] - below * x[i - 1]) / (diagonal[i] - below * above[i - 1]);
        }
        for i in (0..n - 1).rev() {
            x[i] -= above[i] * x[i + 1];
        }
        x
    };
    let mut column = vec![0.0; n];
    (column[0], column[n - 1]) = (gamma, corner);
    let (x, z) = (solve(right), solve(&column));
    let dot = |y: &[f64]| y[0] + corner / gamma * y[n - 1];
    let share = dot(&x) / (1.0 + dot(&z));
    x.iter().zip(&z).map(|(x, z)| x - share * z).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(n: usize, uneven: f64) -> Vec<f64> {
        let step = TAU / n as f64;
        (0..n).map(|i| step * (i as f64 + uneven * (3.7 * i as f64).sin()) - 1.0).collect()
    }

    fn curve(angle: f64) -> f64 {
        (2.0 * angle + 0.3).cos() + 0.4 * (5.0 * angle).sin()
    }

    fn worst(n: usize, uneven: f64) -> f64 {
        let angles = points(n, uneven);
        let values: Vec<f64> = angles.iter().map(|&angle| curve(angle)).collect();
        let spline = PeriodicSpline::new(&angles, &values);
        for (angle, value) in angles.iter().zip(&values) {
            assert!((spline.at(*angle + 3.0 * TAU) - value).abs() < 1e-13);
        }
        let off = |i: u32| (spline.at(0.01 * f64::from(i)) - curve(0.01 * f64::from(i))).abs();
        (0..1000).map(off).fold(0.0, f64::max)
    }

    /// Error of the spline: sixteen times less at half the distance, and so on uneven points, too.
    #[test]
    fn is_of_fourth_order() {
        for uneven in [0.0, 0.3] {
            let [coarse, fine, finest] = [60, 120, 240].map(|n| worst(n, uneven));
            assert!(
                coarse < 1e-2 && (12.0..22.0).contains(&(coarse / fine)),
                "{uneven}: {coarse:e} {fine:e}"
            );
            assert!((12.0..22.0).contains(&(fine / finest)), "{uneven}: {fine:e} {finest:e}");
        }
    }

    /// Second derivatives agree on either side of every point, including the one where the curve closes.
    #[test]
    fn has_no_corner_and_no_step_of_its_curvature() {
        let angles = points(23, 0.3);
        let values: Vec<f64> = angles.iter().map(|&angle| curve(angle)).collect();
        let spline = PeriodicSpline::new(&angles, &values);
        let h = 1e-4;
        for &angle in &angles {
            let second = |at: f64| (spline.at(at + h) - 2.0 * spline.at(at) + spline.at(at - h)) / (h * h);
            let (left, right) = (second(angle - h), second(angle + h));
            assert!((left - right).abs() < 0.05, "{angle}: {left} {right}");
        }
    }

    /// Width of a Gaussian is its own, and its crest is found between the points.
    #[test]
    fn a_lobe_is_as_wide_and_as_high_as_it_is() {
        let width = 0.2;
        let angles = points(180, 0.0);
        let lobe = |angle: f64| 0.3 * (-((angle - 1.01) / width).powi(2)).exp();
        let values: Vec<f64> = angles.iter().map(|&angle| lobe(angle)).collect();
        let spline = PeriodicSpline::new(&angles, &values);
        let (at, height) = spline.highest();
        assert!((at - 1.01).abs() < 1e-4 && (height - 0.3).abs() < 2e-5, "{at} {height}");
        assert!(spline.lowest().1 <= 0.0 && spline.lowest().1 > -1e-5);
        let found = narrowest_rad(&[spline]);
        assert!((found / width - 1.0).abs() < 0.02, "{found}");
        assert_eq!(narrowest_rad(&[PeriodicSpline::new(&angles, &[0.1; 180])]), f64::INFINITY);
    }

    /// Extremes of arbitrary points, against ten thousand angles.
    #[test]
    fn extremes_are_those_of_many_angles() {
        let angles = points(17, 0.3);
        let values: Vec<f64> = (0..17).map(|i| (12.9898 * f64::from(i)).sin() * 0.7).collect();
        let spline = PeriodicSpline::new(&angles, &values);
        let sampled = || (0..10_000).map(|i| spline.at(TAU * f64::from(i) / 1e4));
        let (low, high) =
            (sampled().fold(f64::INFINITY, f64::min), sampled().fold(f64::NEG_INFINITY, f64::max));
        assert!((0.0..1e-6).contains(&(spline.highest().1 - high)), "{} {high}", spline.highest().1);
        assert!((0.0..1e-6).contains(&(low - spline.lowest().1)), "{} {low}", spline.lowest().1);
        assert!(high > values.iter().copied().fold(0.0, f64::max), "the curve overshoots its points");
    }

    #[test]
    fn three_points_and_what_repeats() {
        let spline = PeriodicSpline::new(&[0.0, TAU / 3.0, 2.0 * TAU / 3.0], &[2.0; 3]);
        assert!((spline.at(1.0) - 2.0).abs() < 1e-15);
        assert_eq!(spline.repeats(), 0);
        let angles = points(24, 0.0);
        let values = |m: f64| angles.iter().map(|angle| (m * angle).cos()).collect::<Vec<_>>();
        assert_eq!(PeriodicSpline::new(&angles, &values(4.0)).repeats(), 4);
        assert_eq!(PeriodicSpline::new(&angles, &values(5.0)).repeats(), 1);
        assert_eq!(PeriodicSpline::new(&points(24, 0.1), &values(4.0)).repeats(), 1);
    }
}
