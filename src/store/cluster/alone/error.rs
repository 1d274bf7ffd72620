//! Errors of the shared queue, of which there are none.

use std::convert::Infallible;

/// Error of the shared queue, which cannot exist in this build.
pub(in crate::store) type QueueError = Infallible;
