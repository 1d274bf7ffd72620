//! Progress and cancellation of a computation.

/// Receiver of the progress of one computation, which it may cancel. Implementations must be cheap: both methods are called from inner
/// phases.
pub trait Monitor: Sync {
    /// Reports that `fraction` (0 to 1) of this computation's work is done; `phase` says in words what runs now.
    fn progress(&self, fraction: f64, phase: &str);

    /// Whether the computation should stop at the next opportunity.
    fn is_cancelled(&self) -> bool;
}

/// Monitor that ignores progress and never cancels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Monitor for Unwatched {
    fn progress(&self, _fraction: f64, _phase: &str) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}
