//! Instants at which steps end.

/// End of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    /// Number of the step in the revolution, 0 being where the revolution began.
    pub(super) step: usize,
    /// Revolutions since the start, at this instant and at that of the step before.
    pub(super) revolutions: f64,
    pub(super) before: f64,
}

impl Instant {
    /// Beginning of a revolution.
    pub(super) fn beginning(revolution: usize) -> Self {
        Self { step: 0, revolutions: revolution as f64, before: revolution as f64 }
    }

    /// End of any step after the beginning of `revolution`, also of one several revolutions later.
    #[inline(always)]
    pub(super) fn of_any(revolution: usize, step: usize, steps: usize) -> Self {
        let before = (step - 1) / steps;
        Self::new(revolution + before, step - before * steps, steps)
    }

    /// End of `step`, counted from 1, of the `steps` of a revolution.
    #[inline(always)]
    pub(super) fn new(revolution: usize, step: usize, steps: usize) -> Self {
        let after = |step: usize| revolution as f64 + step as f64 / steps as f64;
        Self { step: step % steps, revolutions: after(step), before: after(step - 1) }
    }
}
