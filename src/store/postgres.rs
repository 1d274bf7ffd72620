//! A PostgreSQL server: opened, and its tables brought up to date.

use std::time::Duration;

use sqlx::any::{AnyConnectOptions, AnyPoolOptions, install_default_drivers};
use sqlx::migrate::Migrator;
use sqlx::{AnyPool, Executor};

use super::error::StoreError;
use super::sqlite::PATIENCE;

/// Connections of one process. A server has a hundred for all, unless told otherwise.
const CONNECTIONS: u32 = 8;

/// How long a transaction may do nothing: a process that hangs within one must not keep others from the same job for ever.
const IDLE: Duration = Duration::from_secs(30);

/// What made the tables, one after the other.
static MIGRATIONS: Migrator = sqlx::migrate!("migrations/postgres");

/// Opens the database at `url` and brings its tables up to date, while other processes that want the same wait.
pub(super) async fn open(url: &str) -> Result<AnyPool, StoreError> {
    install_default_drivers();
    let options: AnyConnectOptions = url.parse()?;
    let pool = AnyPoolOptions::new()
        .acquire_timeout(2 * PATIENCE)
        .max_connections(CONNECTIONS)
        .after_connect(|connection, _| {
            let settings = format!(
                "set lock_timeout = {}; set idle_in_transaction_session_timeout = {}",
                PATIENCE.as_millis(),
                IDLE.as_millis(),
            );
            Box::pin(async move { connection.execute(sqlx::AssertSqlSafe(settings)).await.map(drop) })
        })
        .connect_with(options)
        .await?;
    MIGRATIONS.run(&pool).await?;
    Ok(pool)
}

#[cfg(all(test, feature = "cluster"))]
mod tests {
    use crate::store::StoreError;
    use crate::store::dialect::Dialect;
    use crate::store::testing::stores;

    #[tokio::test]
    async fn connections_that_are_lost_are_replaced_and_what_hangs_is_cut_off() {
        for store in stores().await.iter().filter(|store| store.dialect == Dialect::Postgres) {
            let settings = "select current_setting('lock_timeout'), current_setting('idle_in_transaction_session_timeout')";
            let found: (String, String) = sqlx::query_as(settings).fetch_one(&store.readers).await.unwrap();
            assert_eq!(found, ("5s".to_owned(), "30s".to_owned()));

            let waits = store.readers.acquire().await.unwrap();
            let mut writes = store.write().await.unwrap();
            let others = "select pg_terminate_backend(pid, 1000) from pg_stat_activity
                 where datname = current_database() and pid <> pg_backend_pid()";
            sqlx::query(others).fetch_all(&store.readers).await.unwrap();
            let lost = sqlx::query("select 1").execute(&mut *writes).await.unwrap_err();
            assert!(StoreError::from(lost).may_pass());
            drop((waits, writes));
            store.probe().await.unwrap();

            // A verdict stays one.
            let twice = "insert into readiness (id, mark) values (1, '')";
            let refused = sqlx::query(twice).execute(&store.writer).await.unwrap_err();
            assert!(!StoreError::from(refused).may_pass());
        }
    }
}
