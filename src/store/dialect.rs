//! Where `SQLite` and PostgreSQL differ. All else is said to both in the same words.

use sqlx::AnyConnection;

use super::error::StoreError;
use super::jobs::job::JobId;

/// What holds the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// A file of the data folder, which one connection of one process writes.
    Sqlite,
    /// A server, which many processes write at once.
    Postgres,
}

/// What a transaction reads and then writes by what it found. Who guards several does so in this order, before all else.
#[derive(Debug, Clone, Copy)]
pub(super) enum Guarded<'a> {
    /// What an owner has, against limits.
    Owner(&'a str),
    /// A model, with all that goes with it.
    Model(&'a str),
    /// A job.
    Job(JobId),
}

impl Dialect {
    /// Begins to write. On a server whatever it is set to: [`Self::guard`] rests on it that a statement sees what was committed
    /// before it.
    pub(super) fn begin(self) -> &'static str {
        match self {
            Self::Sqlite => "begin immediate",
            Self::Postgres => "begin isolation level read committed",
        }
    }

    /// Lets transactions that guard the same wait until this one has ended. In `SQLite` all do anyway.
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
            // Two names of the same number only wait for each other.
            sqlx::query("select pg_advisory_xact_lock(hashtextextended($1, 0))")
                .bind(name)
                .execute(connection)
                .await?;
        }
        Ok(())
    }

    /// What follows the table of jobs where a listing is read from the index made for it.
    pub(super) fn by_job_list(self) -> &'static str {
        match self {
            Self::Sqlite => "indexed by job_list",
            // It keeps large values elsewhere, so that rows are small, and takes no advice.
            Self::Postgres => "",
        }
    }
}
