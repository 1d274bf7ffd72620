//! Upgrade of tables on a server by accounts that may change them; other accounts only check the version.
//!
//! sqlx begins by making the table of its history, which an account without the right to create is refused even where the table exists.

use std::collections::BTreeMap;

use sqlx::migrate::{MigrateError, Migrator};
use sqlx::{AnyConnection, AssertSqlSafe, Connection, Executor};

use super::error::StoreError;
use super::migrations::Joining;
use super::refusal::is_forbidden;

/// Rights of the accounts that bring tables up to date, and of those that use them.
pub const ACCOUNTS: &str = "\
The account that runs this owns the tables. It needs the right to create in the database (a schema, the extension hstore) and in its schema
public; the owner of the database has both. An account SERVICE for `serve` and `worker` needs no more than this, which the owner grants:

  grant usage on schema public, apalis to SERVICE;
  grant select, insert, update, delete on all tables in schema public, apalis to SERVICE;
  revoke insert, update, delete on public._sqlx_migrations, apalis._sqlx_migrations from SERVICE;
  alter default privileges in schema public, apalis grant select, insert, update, delete on tables to SERVICE;

The last line is about tables of later versions.";

/// Tables that the same migrations make.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// Contents of the tables, in words.
    pub(super) name: &'static str,
    /// Name of the table that records which migrations were run.
    pub(super) history: &'static str,
    /// Step from the tables that earlier programs made.
    pub(super) joining: Option<&'a Joining>,
    pub(super) migrations: &'a Migrator,
}

/// Outcome of the upgrade of a part of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Upgrade {
    /// Contents of the tables, in words.
    pub part: &'static str,
    /// Number of migrations that were missing.
    pub steps: usize,
    /// Version of the tables now.
    pub version: i64,
}

impl Part<'_> {
    /// Runs missing migrations, while other processes that want the same wait. If none is missing, no right to change tables is needed.
    pub(super) async fn bring_up_to_date(
        &self,
        connection: &mut AnyConnection,
    ) -> Result<Upgrade, StoreError> {
        let joined = self.join(connection).await?;
        let steps = self.missing(connection).await?;
        if steps > 0 {
            self.migrations.run(connection).await.map_err(|error| match error {
                // A later program upgraded the tables first.
                MigrateError::VersionMissing(found) => self.newer(found),
                MigrateError::Execute(error) | MigrateError::ExecuteMigration(error, _)
                    if is_forbidden(&error) =>
                {
                    StoreError::NotUpToDate(error)
                }
                error => error.into(),
            })?;
        }
        Ok(Upgrade { part: self.name, steps: steps + usize::from(joined), version: self.version() })
    }

    /// Brings tables that earlier programs made in many steps to those that are now made as a whole; returns whether there were such.
    async fn join(&self, connection: &mut AnyConnection) -> Result<bool, StoreError> {
        let Some(Joining { from, sql, to, checksum }) = self.joining else { return Ok(false) };
        let is_from = |found: &BTreeMap<i64, Vec<u8>>| found.keys().next_back() == Some(from);
        let found = self.found(connection).await.map_err(not_up_to_date)?;
        if let Some((found, _)) = found.last_key_value().filter(|(found, _)| *found < from) {
            return Err(StoreError::OlderTables { found: *found, least: *from });
        }
        if !is_from(&found) {
            return Ok(false);
        }
        let mut transaction = connection.begin().await?;
        // Other processes that want the same wait here, and find it done.
        let lock = format!("lock table {} in exclusive mode", self.history);
        transaction.execute(AssertSqlSafe(lock)).await.map_err(not_up_to_date)?;
        if !is_from(&self.found(&mut transaction).await?) {
            return Ok(false);
        }
        transaction.execute(AssertSqlSafe(sql.as_str())).await.map_err(not_up_to_date)?;
        transaction.execute(AssertSqlSafe(format!("delete from {}", self.history))).await?;
        let record = format!(
            "insert into {} (version, description, success, checksum, execution_time) values ($1, 'tables', true, $2, 0)",
            self.history
        );
        sqlx::query(AssertSqlSafe(record)).bind(to).bind(checksum).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Number of missing migrations.
    async fn missing(&self, connection: &mut AnyConnection) -> Result<usize, StoreError> {
        let mut found = self.found(connection).await.map_err(not_up_to_date)?;
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

/// Error of an account that may not bring tables up to date, or another one.
fn not_up_to_date(error: sqlx::Error) -> StoreError {
    if is_forbidden(&error) { StoreError::NotUpToDate(error) } else { error.into() }
}
