//! Maxima of amplitudes along the points of a branch.

use serde::{Deserialize, Serialize};

use super::kept::KeptMotion;
use super::told::{Amplitudes, Told};
use crate::result::Stability;
use rubmap_wheel::dynamics::steady::branch::Motion;

/// Least relative rise of a maximum above its two sides: contact that begins and ends at time steps makes amplitudes uneven by less.
const RISES: f64 = 1e-3;

/// Rise of the amplitudes since their last maxima, sensor by sensor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Crests {
    /// Points in the order of the branch: the highest of every sensor with its neighbours, and the last.
    points: Vec<Passed>,
    climbs: Vec<Climb>,
}

/// Point that was passed, with its amplitudes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Passed {
    pub(super) motion: KeptMotion,
    pub(super) amplitudes: Amplitudes,
    pub(super) stability: Stability,
}

impl Passed {
    pub(super) fn new(motion: &Motion, told: &Told) -> Self {
        Self { motion: motion.into(), amplitudes: told.amplitudes.clone(), stability: told.stability }
    }

    pub(super) fn motion(&self) -> Motion {
        (&self.motion).into()
    }
}

/// Amplitudes of a sensor since its last maximum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Climb {
    /// Least amplitude before the largest.
    low: f64,
    /// Largest amplitude.
    high: f64,
    /// Index of the point with the largest amplitude.
    at: usize,
}

/// Maximum of a sensor's amplitude that was passed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Crest {
    pub(super) sensor: usize,
    /// Point of the largest amplitude, between its two neighbours.
    pub(super) points: [Passed; 3],
}

impl Crests {
    /// Adds a point; returns the maxima that are now certain.
    pub(super) fn pass(&mut self, passed: Passed) -> Vec<Crest> {
        let last = self.points.len();
        let fresh = |amplitude: f64| Climb { low: amplitude, high: amplitude, at: last };
        if self.climbs.is_empty() {
            self.climbs = passed.amplitudes.smooth.iter().copied().map(fresh).collect();
        }
        self.points.push(passed);
        let mut found = Vec::new();
        for (sensor, climb) in self.climbs.iter_mut().enumerate() {
            let amplitude = self.points[last].amplitudes.smooth[sensor];
            let rose = climb.high > (1.0 + RISES) * climb.low;
            if amplitude > climb.high {
                (climb.high, climb.at) = (amplitude, last);
            } else if !rose && amplitude < climb.low {
                *climb = fresh(amplitude);
            } else if rose && climb.high > (1.0 + RISES) * amplitude {
                // The amplitude rose from a point before the maximum, and has fallen to one behind it.
                let points = [climb.at - 1, climb.at, climb.at + 1].map(|at| self.points[at].clone());
                found.push(Crest { sensor, points });
                *climb = fresh(amplitude);
            }
        }
        self.forget();
        found
    }

    /// Drops the points that are no longer needed.
    fn forget(&mut self) {
        let last = self.points.len() - 1;
        let climbs = &self.climbs;
        let needed = |at: usize| at == last || climbs.iter().any(|climb| climb.at.abs_diff(at) <= 1);
        let kept: Vec<usize> = (0..=last).filter(|&at| needed(at)).collect();
        let mut place = 0..;
        self.points.retain(|_| place.next().is_some_and(|at| kept.contains(&at)));
        for climb in &mut self.climbs {
            climb.at = kept.partition_point(|&at| at < climb.at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::branches::told::Amplitudes;
    use rubmap_wheel::dynamics::initial::Stepped;

    fn passed(value: f64, heights: &[f64]) -> Passed {
        let motion = Motion { value, state: Stepped::default() };
        let amplitudes = Amplitudes { sampled: heights.to_vec(), smooth: heights.to_vec() };
        Passed { motion: (&motion).into(), amplitudes, stability: Stability::Stable }
    }

    /// Sensor and values of the maxima of lines.
    fn maxima(crests: &mut Crests, lines: &[&[f64]]) -> Vec<(usize, [f64; 3])> {
        let passed = |(at, heights): (usize, &&[f64])| crests.pass(passed(at as f64, heights));
        let found: Vec<Crest> = lines.iter().enumerate().flat_map(passed).collect();
        found.iter().map(|crest| (crest.sensor, crest.points.each_ref().map(|p| p.motion().value))).collect()
    }

    #[test]
    fn a_maximum_rises_by_a_thousandth_on_both_sides_however_many_points_are_on_it() {
        let flat: Vec<f64> = (0..60).map(|at| 1.0 - 1e-6 * f64::from(at - 25_i32).powi(2)).collect();
        let line: Vec<[f64; 1]> = [0.9].into_iter().chain(flat).chain([0.9]).map(|x| [x]).collect();
        let line: Vec<&[f64]> = line.iter().map(|x| &x[..]).collect();
        assert_eq!(maxima(&mut Crests::default(), &line), [(0, [25.0, 26.0, 27.0])]);

        let uneven: [&[f64]; 6] = [&[1.0], &[1.1], &[1.0995], &[1.2], &[1.1995], &[1.3]];
        assert_eq!(maxima(&mut Crests::default(), &uneven), []);
        let twins: [&[f64]; 4] = [&[1.0], &[2.0], &[2.0], &[1.0]];
        assert_eq!(maxima(&mut Crests::default(), &twins), [(0, [0.0, 1.0, 2.0])]);
        let falls: [&[f64]; 3] = [&[3.0], &[2.0], &[1.0]];
        assert_eq!(maxima(&mut Crests::default(), &falls), []);
    }

    #[test]
    fn sensors_have_maxima_of_their_own() {
        let lines: [&[f64]; 7] =
            [&[1.0, 5.0], &[2.0, 6.0], &[3.0, 5.0], &[2.999, 4.0], &[2.0, 5.0], &[1.0, 3.0], &[0.5, 1.0]];
        let found = maxima(&mut Crests::default(), &lines);
        assert_eq!(found, [(1, [0.0, 1.0, 2.0]), (0, [1.0, 2.0, 3.0]), (1, [3.0, 4.0, 5.0])]);
    }
}
