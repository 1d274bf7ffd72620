//! Tables on a server: brought up to date by accounts that may, and found so by all others.
//!
//! sqlx begins by making the table of its history, which an account without the right to create is refused even where it is there.

use std::collections::BTreeMap;

use sqlx::migrate::{MigrateError, Migrator};
use sqlx::{AnyConnection, AssertSqlSafe};

use super::error::StoreError;
use super::refusal::is_forbidden;

/// Tables that are made by the same migrations.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// What is in them, in words.
    pub(super) name: &'static str,
    /// The table that says which migrations were run.
    pub(super) history: &'static str,
    pub(super) migrations: &'a Migrator,
}

/// What became of a part of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Upgrade {
    /// What is in them, in words.
    pub part: &'static str,
    /// Steps that were missing.
    pub steps: usize,
    /// Version that they have now.
    pub version: i64,
}

impl Part<'_> {
    /// Takes the steps that are missing, while others that want the same wait. Where none is, it needs no right to.
    pub(super) async fn bring_up_to_date(
        &self,
        connection: &mut AnyConnection,
    ) -> Result<Upgrade, StoreError> {
        let steps = self.missing(connection).await?;
        if steps > 0 {
            self.migrations.run(connection).await.map_err(|error| match error {
                // Another program was faster.
                MigrateError::VersionMissing(found) => self.newer(found),
                MigrateError::Execute(error) | MigrateError::ExecuteMigration(error, _)
                    if is_forbidden(&error) =>
                {
                    StoreError::NotUpToDate(error)
                }
                error => error.into(),
            })?;
        }
        Ok(Upgrade { part: self.name, steps, version: self.version() })
    }

    /// How many steps are missing.
    async fn missing(&self, connection: &mut AnyConnection) -> Result<usize, StoreError> {
        let mut found = self.found(connection).await.map_err(|error| {
            if is_forbidden(&error) { StoreError::NotUpToDate(error) } else { error.into() }
        })?;
        let mut missing = 0;
        for migration in self.migrations.iter() {
            match found.remove(&migration.version) {
                None => missing += 1,
                Some(checksum) if *checksum == *migration.checksum => {}
                Some(_) => return Err(MigrateError::VersionMismatch(migration.version).into()),
            }
        }
        found.into_keys().next_back().map_or(Ok(missing), |later| Err(self.newer(later)))
    }

    /// Migrations that were run, with their checksums.
    async fn found(&self, connection: &mut AnyConnection) -> Result<BTreeMap<i64, Vec<u8>>, sqlx::Error> {
        let there = sqlx::query_scalar("select to_regclass($1) is not null").bind(self.history);
        if !there.fetch_one(&mut *connection).await? {
            return Ok(BTreeMap::new());
        }
        let found = format!("select version, checksum from {} where success", self.history);
        let found: Vec<(i64, Vec<u8>)> = sqlx::query_as(AssertSqlSafe(found)).fetch_all(connection).await?;
        Ok(found.into_iter().collect())
    }

    fn version(&self) -> i64 {
        self.migrations.iter().map(|migration| migration.version).max().unwrap_or_default()
    }

    fn newer(&self, found: i64) -> StoreError {
        StoreError::NewerTables { part: self.name, found, known: self.version() }
    }
}
