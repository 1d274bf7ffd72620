//! The work of this process in numbers.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use super::handle::Jobs;

/// Queues that are worked on while the service is well.
pub const QUEUES: u32 = 2;

/// The work of this process in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Work {
    /// Queues that are being worked on, of [`QUEUES`].
    pub workers: u32,
    /// Speeds being computed.
    pub speeds_running: u64,
    /// Speeds finished since the start.
    pub speeds_finished: u64,
    /// Time steps of these.
    pub steps: u64,
    /// Memory claimed by computations, in bytes; 0 without a budget.
    pub memory_claimed_bytes: u64,
}

/// What is counted as it happens.
#[derive(Debug, Default)]
pub(super) struct Counters {
    pub(super) workers: AtomicU32,
    speeds_running: AtomicU64,
    speeds_finished: AtomicU64,
    steps: AtomicU64,
}

/// A speed that is being computed, for as long as this is held.
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

impl Jobs {
    /// The work of this process in numbers.
    pub fn work(&self) -> Work {
        let counters = &self.engine.counters;
        Work {
            workers: counters.workers.load(Ordering::Relaxed),
            speeds_running: counters.speeds_running.load(Ordering::Relaxed),
            speeds_finished: counters.speeds_finished.load(Ordering::Relaxed),
            steps: counters.steps.load(Ordering::Relaxed),
            memory_claimed_bytes: self.engine.memory.claimed_bytes(),
        }
    }
}
