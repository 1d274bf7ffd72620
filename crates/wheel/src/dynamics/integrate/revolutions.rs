//! Revolutions of a run: their number, and those that are recorded.

/// Condition on which a run may end before all its revolutions are taken: its motion repeats, one period of it being the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repeats {
    /// Share of the motion by which it may still change (docs/method.md, Steady states).
    pub share: f64,
    /// Revolutions that are taken in any case.
    pub least: usize,
    /// Number of times the scene repeats itself around the wheel: nodal diameters that are no multiples of it have to die out. They must
    /// move at the start to show whether they do.
    pub symmetry: usize,
}

/// Choice of revolutions of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Revolutions {
    /// Revolutions from the end of the first number to the end of the second.
    Between(usize, usize),
    /// Number of revolutions at the end; a period at most, where the run ends because its motion repeats.
    Last(usize),
}

impl Revolutions {
    /// Whole revolutions after which these begin and end in a run of `all`, of which there may be fewer than are asked for, or in one that
    /// ended because it repeats.
    pub fn of(self, all: usize, repeated: Option<Repeated>) -> (usize, usize) {
        match (self, repeated) {
            (Self::Between(from, to), _) => (from, to),
            (Self::Last(count), None) => (all.saturating_sub(count), all),
            (Self::Last(count), Some(Repeated { after, period, .. })) => {
                (after + period - count.min(period), after + period)
            }
        }
    }
}

/// Motion that repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repeated {
    /// Revolutions after which the motion was found to repeat.
    pub after: usize,
    /// Period of the motion, in revolutions.
    pub period: usize,
    /// Share of the motion by which it may still change, were it to go on.
    pub remaining: f64,
}
