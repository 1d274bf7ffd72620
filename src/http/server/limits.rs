//! Limits of what clients may ask of the service.

use std::time::Duration;

/// Limits of connections: how many there may be, and how long each may keep the service waiting.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Largest number of connections at once.
    pub connections: usize,
    /// Longest wait for the head of a request, from its first byte or, for the first one, from the start of the connection.
    pub head: Duration,
    /// Longest rest between two requests.
    pub idle: Duration,
    /// Longest wait for the next 64 KiB of a body, or for a client to take more of its answer.
    pub stall: Duration,
}
