//! Settings of every connection to a server.

use std::time::Duration;

use super::sqlite::PATIENCE;

/// Longest time for which a transaction may be idle: a process that hangs within one must not block a job for others for ever.
const IDLE: Duration = Duration::from_secs(30);

/// Statements that every connection begins with.
pub(super) fn settings() -> String {
    format!(
        "set lock_timeout = {}; set idle_in_transaction_session_timeout = {}",
        PATIENCE.as_millis(),
        IDLE.as_millis(),
    )
}
