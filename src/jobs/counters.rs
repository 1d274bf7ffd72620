//! Counters of the work of this process.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Counters of the work of this process.
#[derive(Debug, Default)]
pub(super) struct Counters {
    /// Queues that are being worked on.
    pub(super) workers: AtomicU32,
    /// Queues that shall be worked on.
    pub(super) queues: AtomicU32,
    pub(super) speeds_running: AtomicU64,
    pub(super) speeds_finished: AtomicU64,
    pub(super) steps: AtomicU64,
}

/// Guard that counts a speed as being computed for as long as it is held.
#[derive(Debug)]
pub(super) struct RunningSpeed<'a>(&'a Counters);

impl Counters {
    pub(super) fn speed_begins(&self) -> RunningSpeed<'_> {
        self.speeds_running.fetch_add(1, Ordering::Relaxed);
        RunningSpeed(self)
    }

    pub(super) fn speed_finished(&self, steps: u64) {
        self.speeds_finished.fetch_add(1, Ordering::Relaxed);
        self.steps.fetch_add(steps, Ordering::Relaxed);
    }
}

impl Drop for RunningSpeed<'_> {
    fn drop(&mut self) {
        self.0.speeds_running.fetch_sub(1, Ordering::Relaxed);
    }
}
