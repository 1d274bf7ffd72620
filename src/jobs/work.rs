//! Work of this process in numbers.

use std::sync::atomic::Ordering;

use super::handle::Jobs;

/// Work of this process in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Work {
    /// Queues that are being worked on.
    pub workers: u32,
    /// Queues that are worked on while the process is well; none where others compute.
    pub queues: u32,
    /// Threads that compute; none where other processes do.
    pub threads: usize,
    /// Speeds being computed.
    pub speeds_running: u64,
    /// Speeds finished since the start.
    pub speeds_finished: u64,
    /// Time steps of the finished speeds.
    pub steps: u64,
    /// Memory claimed by computations, in bytes; 0 without a budget.
    pub memory_claimed_bytes: u64,
}

impl Jobs {
    /// Work of this process in numbers.
    pub fn work(&self) -> Work {
        let counters = &self.engine.counters;
        let queues = counters.queues.load(Ordering::Relaxed);
        Work {
            workers: counters.workers.load(Ordering::Relaxed),
            queues,
            threads: if queues > 0 { self.engine.computing.threads() } else { 0 },
            speeds_running: counters.speeds_running.load(Ordering::Relaxed),
            speeds_finished: counters.speeds_finished.load(Ordering::Relaxed),
            steps: counters.steps.load(Ordering::Relaxed),
            memory_claimed_bytes: self.engine.memory.claimed_bytes(),
        }
    }
}
