//! Errors of the shared queue.

/// Error of the shared queue.
pub(in crate::store) type QueueError = apalis_postgres::Error;
