//! Maxima of amplitudes, as the points of a branch pass them.

use serde::{Deserialize, Serialize};

use super::kept::KeptMotion;
use super::told::{Amplitudes, Told};
use crate::result::{BranchPoint, Stability};
use rubmap_wheel::dynamics::steady::branch::Motion;

/// Least rise of a maximum above what lies before and behind it, relative: contact that begins and ends at steps of time makes amplitudes
/// uneven by less.
const RISES: f64 = 1e-3;

/// Most points that are kept: what has not fallen by [`RISES`] within so many is flat.
const MOST: usize = 32;

/// What a stretch has risen to since it was last down, sensor by sensor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Crests {
    /// The latest points, from the one before the earliest that may be a maximum on.
    points: Vec<Passed>,
    climbs: Vec<Climb>,
}

/// A point that was passed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Passed {
    motion: KeptMotion,
    pub(super) amplitudes: Amplitudes,
    pub(super) stability: Stability,
}

impl Passed {
    fn new(motion: &Motion, told: &Told) -> Self {
        Self { motion: motion.into(), amplitudes: told.amplitudes.clone(), stability: told.stability }
    }

    pub(super) fn motion(&self) -> Motion {
        (&self.motion).into()
    }
}

/// A sensor's amplitudes since its last maximum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Climb {
    /// Least before the largest.
    low: f64,
    /// The largest.
    high: f64,
    /// Points since then.
    since: usize,
}

/// A maximum that was passed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Crest {
    pub(super) sensor: usize,
    /// Points since the highest.
    pub(super) since: usize,
    /// The highest, and those beside it.
    pub(super) points: [Passed; 3],
}

impl Crests {
    /// Of a stretch that continues another one to the other side of where it begins. `beside`: the first point there; `start` and `other`:
    /// where it begins, and the points from `beside` on.
    pub(super) fn behind(beside: (&Motion, &Told), start: &BranchPoint, other: &[BranchPoint]) -> Self {
        let climb = |(sensor, &high): (usize, &f64)| {
            let most = start.half_peak_to_peak[sensor];
            let lower = other.iter().map(|point| point.half_peak_to_peak[sensor]).take_while(|&x| x <= most);
            Climb { low: lower.fold(high, f64::min), high, since: 0 }
        };
        let climbs = beside.1.amplitudes.smooth.iter().enumerate().map(climb).collect();
        Self { points: vec![Passed::new(beside.0, beside.1)], climbs }
    }

    /// Passes another point; the maxima that are behind it for certain.
    pub(super) fn pass(&mut self, motion: &Motion, told: &Told) -> Vec<Crest> {
        self.points.push(Passed::new(motion, told));
        let fresh = |&amplitude: &f64| Climb { low: amplitude, high: amplitude, since: 0 };
        if self.climbs.is_empty() {
            self.climbs = told.amplitudes.smooth.iter().map(fresh).collect();
            return Vec::new();
        }
        let mut found = Vec::new();
        for (sensor, (climb, amplitude)) in self.climbs.iter_mut().zip(&told.amplitudes.smooth).enumerate() {
            climb.since += 1;
            let rose = climb.high > (1.0 + RISES) * climb.low;
            if *amplitude > climb.high {
                (climb.high, climb.since) = (*amplitude, 0);
            } else if !rose && *amplitude < climb.low {
                *climb = fresh(amplitude);
            } else if rose && climb.high > (1.0 + RISES) * amplitude {
                let highest = self.points.len() - 1 - climb.since;
                if let [before, at, after] = &self.points[highest.saturating_sub(1)..=highest + 1] {
                    let points = [before.clone(), at.clone(), after.clone()];
                    found.push(Crest { sensor, since: climb.since, points });
                }
                *climb = fresh(amplitude);
            }
        }
        let needed = self.climbs.iter().map(|climb| climb.since + 2).max().unwrap_or(2).min(MOST);
        self.points.drain(..self.points.len().saturating_sub(needed));
        for (climb, amplitude) in self.climbs.iter_mut().zip(&told.amplitudes.smooth) {
            if climb.since + 2 > MOST {
                *climb = fresh(amplitude);
            }
        }
        found
    }
}
