//! Meaning of the error codes of a database.

use sqlx::sqlite::SqliteError;

/// Refusal that says nothing about the statement or the database itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// Full disk.
    DiskFull,
    /// Another reason that may pass.
    Passing,
}

/// Reason why the database refused, if the same may succeed later.
pub(super) fn refusal(error: &sqlx::Error) -> Option<Refusal> {
    let error = error.as_database_error()?;
    let code = error.code()?;
    match error.try_downcast_ref::<SqliteError>() {
        Some(_) => of_result_code(code.parse().ok()?),
        None => of_sqlstate(&code),
    }
}

/// Whether the account lacks the right to the operation (`insufficient_privilege`).
pub(super) fn is_forbidden(error: &sqlx::Error) -> bool {
    error.as_database_error().and_then(|error| error.code()).is_some_and(|code| code == "42501")
}

/// Whether a text contains a character that PostgreSQL cannot store: U+0000 (`character_not_in_repertoire`).
pub(super) fn is_no_text(error: &sqlx::Error) -> bool {
    error.as_database_error().and_then(|error| error.code()).is_some_and(|code| code == "22021")
}

/// Refusal of a result code of `SQLite`: `BUSY`, `LOCKED`, `NOMEM`, `READONLY`, `IOERR`, `CANTOPEN` and `PROTOCOL` may pass, as does
/// `FULL`. The result code is the low byte of the extended one, which sqlx reports.
fn of_result_code(extended: u32) -> Option<Refusal> {
    match extended & 0xff {
        13 => Some(Refusal::DiskFull),
        5 | 6 | 7 | 8 | 10 | 14 | 15 => Some(Refusal::Passing),
        _ => None,
    }
}

/// Refusal of a SQLSTATE of PostgreSQL: lost connections, lack of resources, a server that stops, starts or is read-only, and transactions
/// that met others or waited for too long.
fn of_sqlstate(code: &str) -> Option<Refusal> {
    /// Codes that may pass: `lock_not_available`, `admin_shutdown`, `crash_shutdown`, `cannot_connect_now`, `idle_session_timeout`,
    /// `idle_in_transaction_session_timeout`, `read_only_sql_transaction`, `io_error`.
    const PASSING: [&str; 8] = ["55P03", "57P01", "57P02", "57P03", "57P05", "25P03", "25006", "58030"];
    match code {
        "53100" => Some(Refusal::DiskFull),
        _ if PASSING.contains(&code) => Some(Refusal::Passing),
        // Classes of lost connections, rolled-back transactions and lacking resources.
        _ if ["08", "40", "53"].iter().any(|class| code.starts_with(class)) => Some(Refusal::Passing),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_pass_is_told_from_verdicts() {
        // SQLITE_FULL; SQLITE_BUSY_SNAPSHOT, SQLITE_IOERR_WRITE; SQLITE_CONSTRAINT_UNIQUE, SQLITE_CORRUPT.
        let [full, passing, verdict] = [Some(Refusal::DiskFull), Some(Refusal::Passing), None];
        for (code, expected) in [(13, full), (517, passing), (778, passing), (2067, verdict), (11, verdict)] {
            assert_eq!(of_result_code(code), expected, "{code}");
        }
        // Full disk; too many connections, a deadlock, a broken connection, a shutdown; unique, syntax, damage.
        for code in ["53300", "40P01", "08006", "57P01"] {
            assert_eq!(of_sqlstate(code), passing, "{code}");
        }
        assert_eq!(of_sqlstate("53100"), full);
        for code in ["23505", "42601", "XX001"] {
            assert_eq!(of_sqlstate(code), verdict, "{code}");
        }
    }
}
