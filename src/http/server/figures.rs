//! Connections, counted.

use std::sync::atomic::{AtomicU64, AtomicUsize};

/// What became of connections.
#[derive(Debug, Default)]
pub struct Figures {
    /// Open now.
    pub open: AtomicUsize,
    /// Accepted since the start.
    pub accepted: AtomicU64,
    /// Closed because the head of a request took too long.
    pub overdue_heads: AtomicU64,
    /// Closed because nothing came for too long.
    pub overdue_rests: AtomicU64,
    /// Closed because the client did not take its answer.
    pub overdue_answers: AtomicU64,
    /// Closed to make room for others.
    pub given_up: AtomicU64,
}
