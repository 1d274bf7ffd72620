//! Ranges of speed with their separation.

use crate::request::OperatingRange;
use crate::result::Position;

/// Relative difference up to which a speed counts as that of an end: units are converted.
const SAME: f64 = 1e-9;

/// Range of speed and the asked separation around it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Span {
    /// Name of the range; none for the whole sweep.
    pub(super) name: Option<String>,
    /// Lowest speed, rad/s.
    pub(super) from: f64,
    /// Highest speed, rad/s.
    pub(super) to: f64,
    /// Asked distance of critical speeds from the ends, in per cent of the end's speed.
    pub(super) separation_percent: f64,
}

impl Span {
    /// Span of a range of the request.
    pub(crate) fn of(range: &OperatingRange) -> Self {
        let rad_s = range.unit.rad_s();
        Self {
            name: Some(range.name.clone()),
            from: range.from * rad_s,
            to: range.to * rad_s,
            separation_percent: range.separation_percent.unwrap_or(0.0),
        }
    }

    /// Span of the whole sweep over these speeds.
    pub(super) fn whole(speeds_rad_s: &[f64]) -> Self {
        let from = speeds_rad_s.iter().copied().fold(f64::INFINITY, f64::min);
        let to = speeds_rad_s.iter().copied().fold(0.0, f64::max);
        Self { name: None, from: from.min(to), to, separation_percent: 0.0 }
    }

    /// Lowest speed that the separation reaches, rad/s.
    pub(super) fn lowest(&self) -> f64 {
        self.from * (1.0 - self.separation_percent / 100.0) * (1.0 - SAME)
    }

    /// Highest speed that the separation reaches, rad/s.
    pub(super) fn highest(&self) -> f64 {
        self.to * (1.0 + self.separation_percent / 100.0) * (1.0 + SAME)
    }

    /// Whether a speed lies inside the range.
    pub(super) fn contains(&self, speed: f64) -> bool {
        (self.from * (1.0 - SAME)..=self.to * (1.0 + SAME)).contains(&speed)
    }

    /// Whether a speed lies inside the range or within its separation.
    pub(crate) fn reaches(&self, speed: f64) -> bool {
        (self.lowest()..=self.highest()).contains(&speed)
    }

    /// Position of a speed.
    pub(super) fn position(&self, speed: f64) -> Position {
        if self.contains(speed) {
            Position::Inside
        } else if self.reaches(speed) {
            Position::WithinSeparation
        } else {
            Position::Outside
        }
    }

    /// Distance of a speed from the nearer end, in per cent of the end's speed; negative inside.
    pub(super) fn distance_percent(&self, speed: f64) -> f64 {
        let above = 100.0 * (speed - self.to) / self.to;
        // Nothing lies below a range that begins at rest, and nothing leaves it there.
        if self.from > 0.0 { above.max(100.0 * (self.from - speed) / self.from) } else { above }
    }
}
