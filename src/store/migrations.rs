//! Steps that made the tables, as files that the program carries: `migrations`, a folder for each database.

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
pub(super) static SQLITE: LazyLock<Migrator> = LazyLock::new(migrator::<Sqlite>);

/// Steps of a PostgreSQL server.
pub(super) static POSTGRES: LazyLock<Migrator> = LazyLock::new(migrator::<Postgres>);

fn migrator<Files: RustEmbed>() -> Migrator {
    Migrator::with_migrations(Files::iter().filter_map(|name| migration::<Files>(&name)).collect())
}

/// The step of a file that is called as `0001_tables.sql`.
fn migration<Files: RustEmbed>(name: &str) -> Option<Migration> {
    let (version, description) = name.strip_suffix(".sql")?.split_once('_')?;
    let sql = String::from_utf8(Files::get(name)?.data.into_owned()).ok()?;
    let description = description.replace('_', " ").into();
    let alone = sql.starts_with("-- no-transaction");
    let sql = AssertSqlSafe(sql).into_sql_str();
    Some(Migration::new(version.parse().ok()?, description, MigrationType::Simple, sql, alone))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_a_step_and_none_is_missing() {
        for (migrator, files) in [(&SQLITE, Sqlite::iter().count()), (&POSTGRES, Postgres::iter().count())] {
            let versions: Vec<i64> = migrator.iter().map(|step| step.version).collect();
            assert_eq!(versions, (1..=files as i64).collect::<Vec<_>>());
        }
    }
}
