//! Differences between `SQLite` and PostgreSQL. All other statements are the same for both.

use sqlx::AnyConnection;

use super::error::StoreError;
use super::jobs::job::JobId;

/// Kind of database that holds the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// File of the data folder, which one connection of one process writes.
    Sqlite,
    /// PostgreSQL server, which many processes write at once.
    Postgres,
}

/// Subject that a transaction guards: it reads the subject and then writes according to what it read. A transaction that guards several
/// subjects does so in this order, before all else.
#[derive(Debug, Clone, Copy)]
pub(super) enum Guarded<'a> {
    /// Total that an owner has stored, to be compared with limits.
    Owner(&'a str),
    /// Model with everything that belongs to it.
    Model(&'a str),
    /// Job with this id.
    Job(JobId),
}

impl Dialect {
    /// Statement that begins a writing transaction. On a server it sets the isolation level, whatever the default: [`Self::guard`] relies
    /// on statements that see what was committed before them.
    pub(super) fn begin(self) -> &'static str {
        match self {
            Self::Sqlite => "begin immediate",
            Self::Postgres => "begin isolation level read committed",
        }
    }

    /// Makes transactions that guard the same subject wait until this one has ended. In `SQLite` all writing transactions wait anyway.
    pub(super) async fn guard(
        self,
        connection: &mut AnyConnection,
        what: Guarded<'_>,
    ) -> Result<(), StoreError> {
        if self == Self::Postgres {
            let name = match what {
                Guarded::Owner(owner) => format!("owner {owner}"),
                Guarded::Model(model) => format!("model {model}"),
                Guarded::Job(job) => format!("job {job}"),
            };
            // Subjects with the same hash only wait for each other.
            sqlx::query("select pg_advisory_xact_lock(hashtextextended($1, 0))")
                .bind(name)
                .execute(connection)
                .await?;
        }
        Ok(())
    }

    /// Clause after the table of jobs that makes a listing use the index made for it.
    pub(super) fn by_job_list(self) -> &'static str {
        match self {
            Self::Sqlite => "indexed by job_list",
            // PostgreSQL stores large values elsewhere, so that rows are small, and takes no hints.
            Self::Postgres => "",
        }
    }
}
