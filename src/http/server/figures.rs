//! Counters of connections.

use std::sync::atomic::{AtomicU64, AtomicUsize};

/// Counters of connections, with the number of open ones.
#[derive(Debug, Default)]
pub struct Figures {
    /// Number of connections that are open now.
    pub open: AtomicUsize,
    /// Number of connections accepted since the start.
    pub accepted: AtomicU64,
    /// Number of connections closed because the head of a request took too long.
    pub overdue_heads: AtomicU64,
    /// Number of connections closed because nothing came for too long.
    pub overdue_rests: AtomicU64,
    /// Number of connections closed because the client did not take its answer.
    pub overdue_answers: AtomicU64,
    /// Number of connections closed to make room for others.
    pub given_up: AtomicU64,
}
