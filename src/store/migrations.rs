//! Steps that make the tables, as files that the program carries: `migrations`, a folder for each database.
//!
//! A folder has the tables as a whole, under the number of their version, further steps from there, and one step from the tables of the
//! version before, which had come about in many steps: `from_0026.sql`.

use std::sync::LazyLock;

use rust_embed::RustEmbed;
use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::{AssertSqlSafe, SqlSafeStr};

#[derive(RustEmbed)]
#[folder = "migrations/sqlite"]
struct Sqlite;

#[derive(RustEmbed)]
#[folder = "migrations/postgres"]
struct Postgres;

/// Steps of a file of `SQLite`.
pub(super) static SQLITE: LazyLock<Steps> = LazyLock::new(steps::<Sqlite>);

/// Steps of a PostgreSQL server.
pub(super) static POSTGRES: LazyLock<Steps> = LazyLock::new(steps::<Postgres>);

/// Steps of one database.
#[derive(Debug)]
pub(super) struct Steps {
    /// Step from the tables that earlier programs made.
    pub(super) joining: Joining,
    /// Tables as a whole, and further steps.
    pub(super) migrator: Migrator,
}

/// Step from the tables that earlier programs made in many steps, to those that are now made as a whole.
#[derive(Debug)]
pub(super) struct Joining {
    /// Version of the tables that it starts from, the only one that it can.
    pub(super) from: i64,
    pub(super) sql: String,
    /// Version of the whole tables, and the checksum by which their making is recorded.
    pub(super) to: i64,
    pub(super) checksum: Vec<u8>,
}

fn steps<Files: RustEmbed>() -> Steps {
    let migrator =
        Migrator::with_migrations(Files::iter().filter_map(|name| migration::<Files>(&name)).collect());
    let joining = Files::iter().find_map(|name| {
        let from = name.strip_prefix("from_")?.strip_suffix(".sql")?.parse().ok()?;
        let whole = migrator.iter().min_by_key(|step| step.version)?;
        Some(Joining {
            from,
            sql: text::<Files>(&name)?,
            to: whole.version,
            checksum: whole.checksum.to_vec(),
        })
    });
    let none = Joining { from: 0, sql: String::new(), to: 0, checksum: Vec::new() };
    Steps { joining: joining.unwrap_or(none), migrator }
}

fn text<Files: RustEmbed>(name: &str) -> Option<String> {
    String::from_utf8(Files::get(name)?.data.into_owned()).ok()
}

/// Migration of a file with a name like `0027_tables.sql`.
fn migration<Files: RustEmbed>(name: &str) -> Option<Migration> {
    let (version, description) = name.strip_suffix(".sql")?.split_once('_')?;
    let sql = AssertSqlSafe(text::<Files>(name)?).into_sql_str();
    let description = description.replace('_', " ").into();
    Some(Migration::new(version.parse().ok()?, description, MigrationType::Simple, sql, false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_a_step_and_none_is_missing() {
        for (steps, files) in [(&SQLITE, Sqlite::iter().count()), (&POSTGRES, Postgres::iter().count())] {
            let versions: Vec<i64> = steps.migrator.iter().map(|step| step.version).collect();
            let first = steps.joining.from + 1;
            assert_eq!(versions, (first..first + files as i64 - 1).collect::<Vec<_>>());
            assert_eq!(steps.joining.to, first);
            assert!(!steps.joining.sql.is_empty() && !steps.joining.checksum.is_empty());
        }
    }
}
