//! Survey of measured heights: outliers, gaps and overshoots.

use std::f64::consts::TAU;

use super::request::Measured;
use super::result::{AngularGap, FoundShape, MeasuredSurvey, Outlier, Overshoot};
use super::shape::Shape;
use rubmap_wheel::dynamics::casing::ALIKE;

/// Interpolation of every measured shape, in words.
const INTERPOLATION: &str =
    "around: periodic cubic splines through all points; along the chord: linear from line to line";

/// Least distance of an outlier from the curve of its neighbours, in standard deviations of normal noise, by the median of the line.
const DEVIATIONS: f64 = 8.0;
/// Least distance of an outlier from the curve of its neighbours, as a share of the range of the line.
const SHARE_OF_RANGE: f64 = 1e-3;
/// Largest distance of an outlier's neighbours from their curves once it is left out, as a share of its own distance.
const LEFT_OF_NEIGHBOURS: f64 = 0.3;
/// Standard deviation of normal noise over the median of its absolute values.
const DEVIATION_OVER_MEDIAN: f64 = 1.4826;
/// Least width of a gap, as a multiple of the median distance of angles.
const GAP_OVER_MEDIAN: f64 = 3.0;
/// Share of the range of the line below which an overshoot is that of any crest between two points.
const SEEN_OVERSHOOT: f64 = 0.01;
/// Largest number of outliers, and of gaps, that are listed.
const MOST_LISTED: usize = 100;

impl FoundShape {
    /// Describes the shape of a casing; none for a circular one.
    pub(crate) fn of(shape: &Shape) -> Option<Self> {
        let highest = shape.highest();
        Some(Self {
            repeats: shape.repeats()?,
            narrowest_rad: shape.narrowest_rad(),
            highest: highest.is_finite().then_some(highest),
            measured: shape.measured.as_ref().map(MeasuredSurvey::of),
        })
    }
}

impl MeasuredSurvey {
    /// Surveys heights that were checked.
    pub fn of(measured: &Measured) -> Self {
        let Measured { angles_rad, heights, .. } = measured;
        let mut outliers: Vec<Outlier> = (heights.iter().enumerate())
            .flat_map(|(line, heights)| outliers(line as u32, angles_rad, heights))
            .collect();
        outliers.sort_by(|a, b| {
            let off = |outlier: &Outlier| (outlier.height - outlier.expected).abs();
            off(b).total_cmp(&off(a))
        });
        let mut gaps = gaps(angles_rad);
        let (outlier_count, gap_count) = (outliers.len() as u32, gaps.len() as u32);
        outliers.truncate(MOST_LISTED);
        gaps.truncate(MOST_LISTED);
        let interpolation = INTERPOLATION.to_owned();
        Self { interpolation, outliers, outlier_count, gaps, gap_count, overshoot: overshoot(measured) }
    }
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

/// Outliers of one line, of five heights at least.
fn outliers(line: u32, angles_rad: &[f64], heights: &[f64]) -> Vec<Outlier> {
    let n = heights.len();
    let weights: Vec<[f64; 4]> = (0..n).map(|i| weights(angles_rad, i)).collect();
    let off = |i: usize, heights: &dyn Fn(usize) -> f64| {
        let others =
            NEIGHBOURS.iter().zip(weights[i]).map(|(by, weight)| weight * heights((i + n + by - 2) % n));
        heights(i) - others.sum::<f64>()
    };
    let residuals: Vec<f64> = (0..n).map(|i| off(i, &|j| heights[j])).collect();
    let noise = DEVIATION_OVER_MEDIAN * median(&mut residuals.iter().map(|r| r.abs()).collect::<Vec<_>>());
    let (low, high) = range(heights);
    let far = (DEVIATIONS * noise).max(SHARE_OF_RANGE * (high - low)).max(ALIKE * low.abs().max(high.abs()));
    let stands_alone = |&i: &usize| {
        let without = |j: usize| if j == i { heights[i] - residuals[i] } else { heights[j] };
        let left = NEIGHBOURS.iter().map(|by| off((i + n + by - 2) % n, &without).abs()).fold(0.0, f64::max);
        residuals[i].abs() > far && left <= LEFT_OF_NEIGHBOURS * residuals[i].abs()
    };
    let found = |i: usize| Outlier {
        line,
        angle_rad: angles_rad[i],
        height: heights[i],
        expected: heights[i] - residuals[i],
    };
    (0..n).filter(stands_alone).map(found).collect()
}

/// Places of the neighbours of a point at place 2: two before it, at 0 and 1, and two behind it, at 3 and 4.
const NEIGHBOURS: [usize; 4] = [0, 1, 3, 4];

/// Weights of the neighbours of point `i` in the cubic through them (Lagrange).
fn weights(angles_rad: &[f64], i: usize) -> [f64; 4] {
    let n = angles_rad.len();
    let from_i = |by: usize| {
        let away = angles_rad[(i + n + by - 2) % n] - angles_rad[i];
        if by < 2 { (away - TAU).rem_euclid(TAU) - TAU } else { away.rem_euclid(TAU) }
    };
    let at = NEIGHBOURS.map(from_i);
    std::array::from_fn(|k| {
        let others = (0..4).filter(|&other| other != k);
        others.map(|other| at[other] / (at[other] - at[k])).product()
    })
}

fn gaps(angles_rad: &[f64]) -> Vec<AngularGap> {
    let n = angles_rad.len();
    let to = |i: usize| if i + 1 < n { angles_rad[i + 1] } else { angles_rad[0] + TAU };
    let mut widths: Vec<f64> = (0..n).map(|i| to(i) - angles_rad[i]).collect();
    let wide = GAP_OVER_MEDIAN * median(&mut widths);
    let mut gaps: Vec<AngularGap> = (0..n)
        .map(|i| AngularGap { from_rad: angles_rad[i], to_rad: to(i) })
        .filter(|gap| gap.to_rad - gap.from_rad > wide)
        .collect();
    gaps.sort_by(|a, b| (b.to_rad - b.from_rad).total_cmp(&(a.to_rad - a.from_rad)));
    gaps
}

/// Overshoot of the curve of every line where it goes farthest beyond the heights, 0 if that is round-off, and the range of the heights.
pub(super) fn overshoots(measured: &Measured) -> Vec<(Overshoot, f64)> {
    let of = |(line, heights): (usize, &Vec<f64>)| {
        let ([top, bottom], (low, high)) = (measured.extremes()[line], range(heights));
        let above = (top.0, top.1 - high);
        let below = (bottom.0, low - bottom.1);
        let (angle_rad, by) = if above.1 >= below.1 { above } else { below };
        let by = if by > ALIKE * low.abs().max(high.abs()) { by } else { 0.0 };
        (Overshoot { line: line as u32, angle_rad: angle_rad.rem_euclid(TAU), by }, high - low)
    };
    measured.heights.iter().enumerate().map(of).collect()
}

/// Largest overshoot, if it is more than that of a crest.
fn overshoot(measured: &Measured) -> Option<Overshoot> {
    let seen =
        overshoots(measured).into_iter().filter(|(overshoot, range)| overshoot.by > SEEN_OVERSHOOT * range);
    seen.map(|(overshoot, _)| overshoot).max_by(|a, b| a.by.total_cmp(&b.by))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::casing::curves::Curves;

    fn measured(n: usize, height: impl Fn(f64) -> f64) -> Measured {
        let angles_rad: Vec<f64> = (0..n).map(|i| TAU * i as f64 / n as f64).collect();
        let heights = vec![angles_rad.iter().map(|&angle| height(angle)).collect()];
        Measured { angles_rad, chord: Some(vec![0.0]), heights, curves: Curves::default() }
    }

    fn lobes(angle: f64) -> f64 {
        0.4 * (-((angle - 1.0) / 0.35).powi(2)).exp()
            + 0.4 * (-((angle - 1.0 - TAU / 2.0) / 0.35).powi(2)).exp()
    }

    /// Noise of ± a thousandth that is the same every time.
    fn noise(angle: f64) -> f64 {
        1e-3 * (43758.5453 * (12.9898 * angle).sin()).fract()
    }

    #[test]
    fn smooth_shapes_have_no_outliers_coarse_or_fine() {
        for n in [24, 36, 72, 720] {
            let survey = MeasuredSurvey::of(&measured(n, lobes));
            assert_eq!((survey.outlier_count, survey.gap_count), (0, 0), "{n}: {survey:?}");
            let noisy = MeasuredSurvey::of(&measured(n, |angle| lobes(angle) + noise(angle)));
            assert_eq!(noisy.outlier_count, 0, "{n}: {noisy:?}");
        }
        assert_eq!(MeasuredSurvey::of(&measured(720, lobes)).overshoot, None);
        for (n, height) in [(360, 0.25), (720, 0.7), (36, 0.0)] {
            let constant = MeasuredSurvey::of(&measured(n, |_| height));
            assert_eq!((constant.outlier_count, constant.overshoot), (0, None), "{n} {height}");
        }
    }

    /// Wrong heights are found at their places, with the right ones as expected, on even and uneven angles, the first and the last included.
    #[test]
    fn wrong_heights_are_found() {
        for uneven in [0.0, 0.3] {
            for wrong in [0, 1, 50, 178, 179] {
                let mut table = measured(180, |angle| lobes(angle) + noise(angle));
                for (i, angle) in table.angles_rad.iter_mut().enumerate() {
                    *angle += uneven * TAU / 180.0 * (3.7 * i as f64).sin();
                }
                table.heights[0] = table.angles_rad.iter().map(|&a| lobes(a) + noise(a)).collect();
                table.heights[0][wrong] += 0.1;
                let survey = MeasuredSurvey::of(&table);
                assert_eq!(survey.outlier_count, 1, "{uneven} {wrong}: {survey:?}");
                let outlier = &survey.outliers[0];
                assert_eq!(outlier.angle_rad, table.angles_rad[wrong]);
                assert!((outlier.expected - lobes(outlier.angle_rad)).abs() < 5e-3, "{outlier:?}");
            }
        }
    }

    /// A step is no outlier; that the curve goes beyond it is said.
    #[test]
    fn steps_overshoot() {
        let survey = MeasuredSurvey::of(&measured(360, |angle| if angle < 2.0 { 0.3 } else { 0.1 }));
        assert_eq!(survey.outlier_count, 0, "{survey:?}");
        let overshoot = survey.overshoot.unwrap();
        // A cubic spline overshoots a step by a little more than a tenth of it.
        assert!((0.018..0.03).contains(&overshoot.by), "{overshoot:?}");
    }

    #[test]
    fn gaps_are_found_across_the_end_too() {
        let mut table = measured(360, lobes);
        let keep = |i: usize| !(100..120).contains(&i) && i >= 10;
        table.heights[0] = (0..360).filter(|&i| keep(i)).map(|i| table.heights[0][i]).collect();
        table.angles_rad = (0..360).filter(|&i| keep(i)).map(|i| table.angles_rad[i]).collect();
        let survey = MeasuredSurvey::of(&table);
        let degrees: Vec<[f64; 2]> = (survey.gaps.iter())
            .map(|gap| [gap.from_rad, gap.to_rad].map(|angle| angle.to_degrees().round()))
            .collect();
        assert_eq!(degrees, [[99.0, 120.0], [359.0, 370.0]]);
    }
}
