//! Timestamps as the database has them.

/// Now, as every timestamp in the database: RFC 3339 in UTC with milliseconds, which sorts as text.
pub(super) fn now() -> String {
    timestamp(chrono::Utc::now())
}

pub(super) fn timestamp(time: chrono::DateTime<chrono::Utc>) -> String {
    time.to_rfc3339_opts(chrono::SecondsFormat::Millis, true)
}
