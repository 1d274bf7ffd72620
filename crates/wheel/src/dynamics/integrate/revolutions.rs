//! How many revolutions a run takes, and which of them are recorded.

/// When a run may end before all its revolutions are taken: where its motion repeats, one period of it being the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repeats {
    /// Share of the motion by which it may still change (docs/method.md, Steady states).
    pub share: f64,
    /// Revolutions that are taken in any case.
    pub least: usize,
    /// How often the scene repeats itself around the wheel: nodal diameters that are no multiples of it have to die out. They must move at
    /// the start to show whether they do.
    pub symmetry: usize,
}

/// Some revolutions of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Revolutions {
    /// From the end of this one to the end of that one.
    Between(usize, usize),
    /// So many at the end; a period at most, where the run ends because its motion repeats.
    Last(usize),
}

impl Revolutions {
    /// Whole revolutions after which they begin and end in a run of `all`, of which there may be fewer than are wanted, or in one that ended
    /// because it repeats.
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

/// A motion that repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repeated {
    /// Revolutions after which it does.
    pub after: usize,
    /// Revolutions after which it is the same again.
    pub period: usize,
    /// Share of the motion by which it may still change, were it to go on.
    pub remaining: f64,
}
