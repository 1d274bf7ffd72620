//! Steps that follow each other, and what is made of them.

use super::instant::Instant;
use super::trace::Trace;

/// Steps that follow each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepRange {
    /// Revolution that they are counted from.
    pub(super) revolution: usize,
    /// Steps between its beginning and the first of them, fewer than a revolution has.
    pub(super) before: usize,
    /// Number of steps; of several revolutions, perhaps.
    pub(super) steps: usize,
    pub(super) per_revolution: usize,
}

impl StepRange {
    /// The end of the last step.
    pub(super) fn end(self) -> Instant {
        Instant::of_any(self.revolution, self.before + self.steps, self.per_revolution)
    }
}

/// Observer of steps as they are taken.
pub(super) enum Observer<'a> {
    /// Counts them, and reads the sensors after each where that is wanted, in the window of the run or before it.
    Recorder { windowed: bool },
    /// Tells what touches, and counts nothing.
    Trace(&'a mut Trace),
}
