//! Force laws of compressible obstacles.

/// Force λ of an obstacle over the penetration x into it: none, then two straight slopes, then a stop.
///
/// ```text
/// x ≤ start             λ = 0
/// start < x ≤ knee      λ = slopes[0] (x − start)
/// knee < x < stop       λ = λ(knee) + slopes[1] (x − knee)
/// x = stop              λ ≥ λ(stop)
/// ```
///
/// with 0 ≤ `start` ≤ `knee` ≤ `stop` and positive slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BilinearLaw {
    /// Penetration up to which there is no force.
    pub start: f64,
    /// Penetration at which the second slope begins.
    pub knee: f64,
    /// Largest penetration.
    pub stop: f64,
    /// Force per length before and after the knee.
    pub slopes: [f64; 2],
}

/// Straight pieces of the law, from no force upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Branch {
    Open,
    First,
    Second,
    Stopped,
}

/// Position of a point on the extended line of a branch, relative to the branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Within,
    Above,
}

impl BilinearLaw {
    /// Force λ(x) for x ≤ `stop`, the smallest one at the stop itself.
    pub fn force(&self, x: f64) -> f64 {
        if x <= self.start {
            0.0
        } else if x <= self.knee {
            self.slopes[0] * (x - self.start)
        } else {
            self.slopes[0] * (self.knee - self.start) + self.slopes[1] * (x - self.knee)
        }
    }

    /// Line of a branch with a force: (x at λ = 0, dx/dλ).
    pub(super) fn line(&self, branch: Branch) -> (f64, f64) {
        match branch {
            Branch::Open | Branch::First => (self.start, 1.0 / self.slopes[0]),
            Branch::Second => (self.knee - self.force(self.knee) / self.slopes[1], 1.0 / self.slopes[1]),
            Branch::Stopped => (self.stop, 0.0),
        }
    }

    /// Position of the point (x, λ) on the line of `branch`, relative to the branch, whose ends reach `tolerance` further; a force is never
    /// negative.
    pub(super) fn side(&self, branch: Branch, x: f64, lambda: f64, tolerance: f64) -> Side {
        let (below, above) = match branch {
            Branch::Open => (false, x > self.start + tolerance),
            Branch::First => (lambda < 0.0, x > self.knee + tolerance),
            Branch::Second => (lambda < 0.0 || x < self.knee - tolerance, x > self.stop + tolerance),
            Branch::Stopped => {
                (lambda < (self.force(self.stop) - self.slopes[1] * tolerance).max(0.0), false)
            }
        };
        match (below, above) {
            (true, _) => Side::Below,
            (_, true) => Side::Above,
            _ => Side::Within,
        }
    }

    /// Branch to try after `branch`, whose point (x, λ) lies outside: the one at the same x, or from the stop the one at the same λ.
    pub(super) fn jump(&self, branch: Branch, x: f64, lambda: f64) -> Branch {
        let reached = |start: bool, knee: bool| match (start, knee) {
            (_, true) => Branch::Second,
            (true, _) => Branch::First,
            _ => Branch::Open,
        };
        match branch {
            Branch::Stopped => reached(lambda > 0.0, lambda > self.force(self.knee)),
            _ if x > self.stop => Branch::Stopped,
            _ => reached(x > self.start, x > self.knee),
        }
    }
}

impl Branch {
    /// Neighbouring branch on `side`.
    pub(super) fn neighbour(self, side: Side) -> Self {
        match (side, self) {
            (Side::Below, Self::Open | Self::First) => Self::Open,
            (Side::Below, Self::Second) | (Side::Above, Self::Open) => Self::First,
            (Side::Below, Self::Stopped) | (Side::Above, Self::First) => Self::Second,
            (Side::Above, Self::Second | Self::Stopped) => Self::Stopped,
            (Side::Within, same) => same,
        }
    }
}
