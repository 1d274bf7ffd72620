//! Timestamps in the form of the database.

/// Current time as a timestamp of the database: RFC 3339 in UTC with milliseconds, which sorts as text.
pub(super) fn now() -> String {
    timestamp(chrono::Utc::now())
}

pub(super) fn timestamp(time: chrono::DateTime<chrono::Utc>) -> String {
    time.to_rfc3339_opts(chrono::SecondsFormat::Millis, true)
}
