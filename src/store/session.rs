//! What every connection to a server begins with, whoever makes it.

use std::time::Duration;

use super::sqlite::PATIENCE;

/// How long a transaction may do nothing: a process that hangs within one must not keep others from the same job for ever.
const IDLE: Duration = Duration::from_secs(30);

/// The statements.
pub(super) fn settings() -> String {
    format!(
        "set lock_timeout = {}; set idle_in_transaction_session_timeout = {}",
        PATIENCE.as_millis(),
        IDLE.as_millis(),
    )
}
