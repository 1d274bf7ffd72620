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
