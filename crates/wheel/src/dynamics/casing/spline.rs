//! Smooth curves around the circumference.

use std::f64::consts::TAU;

/// Periodic cubic spline: twice continuously differentiable, through its points, of fourth order in their distance (de Boor, A
/// Practical Guide to Splines, 1978, chapter IV).
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSpline {
    /// Ascending, within one turn.
    angles_rad: Vec<f64>,
    values: Vec<f64>,
    /// Second derivatives at the points, per rad².
    curvatures: Vec<f64>,
}

impl PeriodicSpline {
    /// Through `values` at `angles_rad`, which ascend strictly within one turn, three at least.
    ///
    /// # Panics
    /// If they do not.
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

    /// At any angle.
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

    /// How often it repeats in a turn.
    pub(super) fn repeats(&self) -> usize {
        repeats(&self.angles_rad, &self.values)
    }

    /// Mean distance of the points, rad.
    pub(super) fn spacing_rad(&self) -> f64 {
        TAU / self.angles_rad.len() as f64
    }
}

/// Largest m such that `values` at `angles_rad`, which ascend within one turn, are the same after a turn by 1/m.
pub fn repeats(angles_rad: &[f64], values: &[f64]) -> usize {
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
    let shift = (1..n).find(|&by| n.is_multiple_of(by) && same(by));
    shift.map_or(1, |by| n / by)
}

/// Angles and heights as near to each other are the same: they come from decimal numbers.
const ALIKE: f64 = 1e-9;

/// h_{i−1} m_{i−1} + 2(h_{i−1} + h_i) m_i + h_i m_{i+1} = r_i, indices modulo n: a tridiagonal system and a correction of rank one for its
/// corners. Diagonally dominant: no pivots are wanted.
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

    /// Sixteen times less at half the distance, and the same on uneven points.
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

    /// Two derivatives on either side of every point, that where it closes included.
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

    #[test]
    fn three_points_and_what_repeats() {
        let spline = PeriodicSpline::new(&[0.0, TAU / 3.0, 2.0 * TAU / 3.0], &[2.0; 3]);
        assert!((spline.at(1.0) - 2.0).abs() < 1e-15);
        assert_eq!(spline.repeats(), 3);
        let angles = points(24, 0.0);
        let values = |m: f64| angles.iter().map(|angle| (m * angle).cos()).collect::<Vec<_>>();
        assert_eq!(PeriodicSpline::new(&angles, &values(4.0)).repeats(), 4);
        assert_eq!(PeriodicSpline::new(&angles, &values(5.0)).repeats(), 1);
        assert_eq!(PeriodicSpline::new(&points(24, 0.1), &values(4.0)).repeats(), 1);
    }
}
