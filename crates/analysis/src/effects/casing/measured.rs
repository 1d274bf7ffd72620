//! Measured heights: curves through them, and tables of them put together.

use std::f64::consts::{FRAC_PI_2, TAU};

use num_integer::gcd;

use super::curves::Curves;
use super::request::Measured;
use super::result::{FilledHeight, MeasuredCasing, MeasuredSurvey};
use rubmap_wheel::dynamics::casing::{
    self, ALIKE, PeriodicSpline, arc_lengths, narrowest_rad, points_repeat,
};

/// Largest number of filled heights that are listed.
const MOST_LISTED: usize = 100;
/// Largest number of heights that a table may have once the angles of its lines are put together.
const MOST_HEIGHTS: usize = 200_000;

impl Measured {
    /// Smallest number of angles of a line.
    pub(crate) const LEAST_ANGLES: usize = 8;
    /// Largest distance from one angle to the next, rad: a quarter of a turn.
    pub(crate) const WIDEST_GAP_RAD: f64 = 1.000_001 * FRAC_PI_2;

    /// Number of times that all lines repeat around the circumference; 0 for lines that are the same all around.
    pub(super) fn repeats(&self) -> u32 {
        let repeats = |heights: &Vec<f64>| points_repeat(&self.angles_rad, heights) as u32;
        *self.curves.repeats.get_or_init(|| self.heights.iter().map(repeats).fold(0, gcd))
    }

    /// Curves of all lines.
    pub(super) fn curves(&self) -> &[PeriodicSpline] {
        let line = |heights: &Vec<f64>| PeriodicSpline::new(&self.angles_rad, heights);
        self.curves.lines.get_or_init(|| self.heights.iter().map(line).collect())
    }

    /// Width that steps have to resolve, rad.
    pub(super) fn narrowest_rad(&self) -> f64 {
        *self.curves.narrowest_rad.get_or_init(|| narrowest_rad(self.curves()))
    }

    /// Angle and height of the largest and of the smallest height of every line.
    pub(super) fn extremes(&self) -> &[[(f64, f64); 2]] {
        let extremes = |curve: &PeriodicSpline| [curve.highest(), curve.lowest()];
        self.curves.extremes.get_or_init(|| self.curves().iter().map(extremes).collect())
    }

    /// Places contact nodes at positions `[r, θ, z]`: each on its own line, or between the two beside it.
    pub(super) fn at(&self, positions: &[[f64; 3]]) -> casing::Measured {
        let Some(chord) = &self.chord else { return casing::Measured::at_each(self.curves().to_vec()) };
        let arc = arc_lengths(positions);
        let whole = arc.last().copied().filter(|whole| *whole > 0.0).unwrap_or(1.0);
        let between = |length: &f64| {
            let place = length / whole;
            let next = chord.partition_point(|&line| line <= place);
            let (before, after) = (next.saturating_sub(1), next.min(chord.len() - 1));
            let width = chord[after] - chord[before];
            // Before the first line and behind the last there is only one line.
            let share = if width > 0.0 && next > 0 { (place - chord[before]) / width } else { 0.0 };
            (before, after, share)
        };
        casing::Measured { curves: self.curves().to_vec(), nodes: arc.iter().map(between).collect() }
    }
}

/// Heights along one line around the circumference, at angles of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredLine {
    /// Place of the line: share of the chord, or contact node.
    pub place: f64,
    /// Points of the line, `(angle in rad, height)`, in any order and any turn.
    pub points: Vec<(f64, f64)>,
}

/// Reason for which lines make no shape.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LineError {
    /// Lines whose angles are too many together.
    #[error(
        "with the angles of all {lines} lines together there are {heights} heights, more than {MOST_HEIGHTS}: measure all lines at the \
         same angles, or at fewer"
    )]
    Many {
        /// Number of lines.
        lines: usize,
        /// Number of heights: the angles of all lines, times the lines.
        heights: usize,
    },
    /// Too few points on a line.
    #[error("has {points} heights; a curve needs {} at least", Measured::LEAST_ANGLES)]
    Few {
        /// Number of points.
        points: usize,
    },
    /// A gap that no curve can be laid across.
    #[error(
        "has no height from {:.3} to {:.3} degrees; no curve can be laid across more than a quarter of a turn",
        from_rad.to_degrees(),
        to_rad.to_degrees()
    )]
    Gap {
        /// Last angle before the gap, rad.
        from_rad: f64,
        /// First angle behind the gap, rad.
        to_rad: f64,
    },
    /// Two heights at one angle.
    #[error("has two heights at {:.6} degrees, {first} and {second}; leave one out", angle_rad.to_degrees())]
    Twice {
        /// Angle of both heights, rad.
        angle_rad: f64,
        /// First of the two heights.
        first: f64,
        /// Second of the two heights.
        second: f64,
    },
}

/// Puts lines together into a table over the angles of all lines: heights that a line does not have are taken from its own curve. `each_node`: places
/// are contact nodes, 0, 1, …, otherwise shares of the chord, ascending. Errors that are about a line come with its index.
pub fn measured_casing(
    lines: &[MeasuredLine],
    each_node: bool,
) -> Result<MeasuredCasing, (Option<usize>, LineError)> {
    let sorted =
        lines.iter().enumerate().map(|(index, line)| sorted(line).map_err(|error| (Some(index), error)));
    let sorted: Vec<Vec<(f64, f64)>> = sorted.collect::<Result<_, _>>()?;
    let mut angles_rad: Vec<f64> = sorted.iter().flatten().map(|(angle, _)| *angle).collect();
    angles_rad.sort_by(f64::total_cmp);
    angles_rad.dedup_by(|next, one| *next - *one <= ALIKE);
    let together = angles_rad.len().saturating_mul(lines.len());
    if together > MOST_HEIGHTS {
        return Err((None, LineError::Many { lines: lines.len(), heights: together }));
    }
    let (mut filled, mut filled_count) = (Vec::new(), 0);
    let mut heights = Vec::new();
    for (line, points) in sorted.iter().enumerate() {
        let (angles, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let curve = PeriodicSpline::new(&angles, &values);
        let height = |&angle: &f64| {
            let next = angles.partition_point(|own| *own < angle - ALIKE);
            if angles.get(next).is_some_and(|own| *own <= angle + ALIKE) {
                return values[next];
            }
            let height = curve.at(angle);
            filled_count += 1;
            if filled.len() < MOST_LISTED {
                filled.push(FilledHeight { line: line as u32, angle_rad: angle, height });
            }
            height
        };
        heights.push(angles_rad.iter().map(height).collect());
    }
    let chord = (!each_node).then(|| lines.iter().map(|line| line.place).collect());
    let measured = Measured { angles_rad, chord, heights, curves: Curves::default() };
    Ok(MeasuredCasing { survey: MeasuredSurvey::of(&measured), measured, filled, filled_count })
}

/// Sorts the points of a line within one turn, ascending, every angle once.
fn sorted(line: &MeasuredLine) -> Result<Vec<(f64, f64)>, LineError> {
    let mut points: Vec<(f64, f64)> = line
        .points
        .iter()
        .map(|&(angle, height)| {
            let within = angle.rem_euclid(TAU);
            (if TAU - within <= ALIKE { 0.0 } else { within + 0.0 }, height)
        })
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let scale = points.iter().fold(0.0f64, |most, point| most.max(point.1.abs()));
    let differ = |pair: &&[(f64, f64)]| {
        pair[1].0 - pair[0].0 <= ALIKE && (pair[1].1 - pair[0].1).abs() > ALIKE * scale
    };
    if let Some(pair) = points.windows(2).find(differ) {
        return Err(LineError::Twice { angle_rad: pair[0].0, first: pair[0].1, second: pair[1].1 });
    }
    points.dedup_by(|next, one| next.0 - one.0 <= ALIKE);
    if points.len() < Measured::LEAST_ANGLES {
        return Err(LineError::Few { points: points.len() });
    }
    let ends = points.iter().map(|point| point.0).skip(1).chain([points[0].0 + TAU]);
    let mut gaps = points.iter().map(|point| point.0).zip(ends);
    match gaps.find(|(from, to)| to - from > Measured::WIDEST_GAP_RAD) {
        Some((from_rad, to_rad)) => Err(LineError::Gap { from_rad, to_rad }),
        None => Ok(points),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lobe(angle: f64) -> f64 {
        0.3 + 0.1 * (2.0 * angle + 0.4).cos()
    }

    fn line(place: f64, degrees: impl Iterator<Item = f64>) -> MeasuredLine {
        let point = |degrees: f64| (degrees.to_radians(), (1.0 - 0.2 * place) * lobe(degrees.to_radians()));
        MeasuredLine { place, points: degrees.map(point).collect() }
    }

    /// Lines of two grids, in other turns and orders, the end of the turn said twice.
    #[test]
    fn lines_come_together_on_the_angles_of_all() {
        let every = |step: u32| (0..=360).rev().step_by(step as usize).map(f64::from);
        let lines = [line(0.0, every(5)), line(1.0, every(3).map(|degrees| degrees - 720.0))];
        let MeasuredCasing { measured, filled, filled_count, survey } =
            measured_casing(&lines, false).unwrap();
        // Every fifth, every third, and every fifteenth of both.
        assert_eq!(measured.angles_rad.len(), 72 + 120 - 24);
        assert_eq!((filled_count, filled.len()), (120 - 24 + 72 - 24, MOST_LISTED));
        assert_eq!(measured.chord, Some(vec![0.0, 1.0]));
        for (line, heights) in measured.heights.iter().enumerate() {
            for (angle, height) in measured.angles_rad.iter().zip(heights) {
                let expected = (1.0 - 0.2 * line as f64) * lobe(*angle);
                assert!((height - expected).abs() < 1e-6, "{line} {angle}: {height} {expected}");
            }
        }
        assert_eq!((survey.outlier_count, survey.gap_count), (0, 0));
        assert_eq!(measured.repeats(), 2, "what is filled in repeats, too");
    }

    #[test]
    fn what_makes_no_curve_is_refused() {
        let even = |count: u32| (0..count).map(move |i| 360.0 * f64::from(i) / f64::from(count));
        let refused = |line: MeasuredLine| measured_casing(&[line], true).unwrap_err();
        assert_eq!(refused(line(0.0, even(7))), (Some(0), LineError::Few { points: 7 }));
        let gap = refused(line(0.0, (0..200).map(f64::from)));
        assert!(matches!(gap, (Some(0), LineError::Gap { .. })), "{gap:?}");
        assert!(gap.1.to_string().contains("from 199.000 to 360.000 degrees"), "{}", gap.1);
        // A thousand lines, each at angles of its own.
        let aside = |k: u32| even(360).map(move |degrees| degrees + 1e-3 * f64::from(k));
        let many: Vec<MeasuredLine> = (0..1000).map(|k| line(0.0, aside(k))).collect();
        let many = measured_casing(&many, true).unwrap_err();
        assert_eq!(many, (None, LineError::Many { lines: 1000, heights: 360_000_000 }));
        let mut twice = line(0.0, even(36));
        twice.points.push((4.0 * TAU + twice.points[3].0, 0.7));
        assert!(matches!(refused(twice).1, LineError::Twice { .. }));
    }
}
