//! How much clients may ask of the service.

use std::time::Duration;

/// How many connections, and how long each may keep the service waiting.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Connections at once.
    pub connections: usize,
    /// For the head of a request, from its first byte or, of the first one, from the connection.
    pub head: Duration,
    /// Between two requests.
    pub idle: Duration,
    /// For the next 64 KiB of a body, or for a client to take more of its answer.
    pub stall: Duration,
}
