//! Ranges of speed with their separation.

use crate::request::OperatingRange;
use crate::resolved::ResolvedSweep;
use crate::result::Position;

/// Relative difference up to which a speed counts as that of an end: units are converted.
const SAME: f64 = 1e-9;

/// Range of speed and the asked separation around it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Span {
    /// Name of the range; none for the whole sweep.
    pub(crate) name: Option<String>,
    /// Lowest speed, rad/s.
    pub(crate) from: f64,
    /// Highest speed, rad/s.
    pub(crate) to: f64,
    /// Asked distance of critical speeds from the ends, in per cent of the end's speed.
    pub(crate) separation_percent: f64,
}

impl Span {
    /// Span of a range of the request.
    fn of(range: &OperatingRange) -> Self {
        let rad_s = range.unit.rad_s();
        Self {
            name: Some(range.name.clone()),
            from: range.from * rad_s,
            to: range.to * rad_s,
            separation_percent: range.separation_percent.unwrap_or(0.0),
        }
    }

    /// Spans of the ranges of a request.
    pub(crate) fn of_ranges(request: &ResolvedSweep) -> Vec<Self> {
        request.operation.iter().flat_map(|operation| &operation.ranges).map(Self::of).collect()
    }

    /// Whether the request gives ranges, and the spans to judge: its ranges, otherwise the whole sweep.
    pub(crate) fn all(request: &ResolvedSweep) -> (bool, Vec<Self>) {
        let ranges = Self::of_ranges(request);
        match ranges.is_empty() {
            true => (false, vec![Self::whole(request.speeds.rad_s())]),
            false => (true, ranges),
        }
    }

    /// Span of the whole sweep over these speeds.
    pub(crate) fn whole(speeds_rad_s: &[f64]) -> Self {
        let from = speeds_rad_s.iter().copied().fold(f64::INFINITY, f64::min);
        let to = speeds_rad_s.iter().copied().fold(0.0, f64::max);
        Self { name: None, from: from.min(to), to, separation_percent: 0.0 }
    }

    /// Lowest speed that the separation reaches, rad/s.
    pub(crate) fn lowest(&self) -> f64 {
        self.from * (1.0 - self.separation_percent / 100.0) * (1.0 - SAME)
    }

    /// Highest speed that the separation reaches, rad/s.
    pub(crate) fn highest(&self) -> f64 {
        self.to * (1.0 + self.separation_percent / 100.0) * (1.0 + SAME)
    }

    /// Whether a speed lies inside the range.
    pub(crate) fn contains(&self, speed: f64) -> bool {
        (self.from * (1.0 - SAME)..=self.to * (1.0 + SAME)).contains(&speed)
    }

    /// Whether a speed lies inside the range or within its separation.
    pub(crate) fn reaches(&self, speed: f64) -> bool {
        (self.lowest()..=self.highest()).contains(&speed)
    }

    /// Position of a speed.
    pub(crate) fn position(&self, speed: f64) -> Position {
        if self.contains(speed) {
            Position::Inside
        } else if self.reaches(speed) {
            Position::WithinSeparation
        } else {
            Position::Outside
        }
    }

    /// Distance of a speed from the nearer end, in per cent of the end's speed; negative inside.
    pub(crate) fn distance_percent(&self, speed: f64) -> f64 {
        let above = 100.0 * (speed - self.to) / self.to;
        // Nothing lies below a range that begins at rest, and nothing leaves it there.
        if self.from > 0.0 { above.max(100.0 * (self.from - speed) / self.from) } else { above }
    }
}
