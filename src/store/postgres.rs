//! Connections to a PostgreSQL server, and the upgrade of its tables.

use sqlx::any::{AnyConnectOptions, AnyPoolOptions, install_default_drivers};
use sqlx::{AnyConnection, AnyPool, Connection, Executor};

use super::error::StoreError;
use super::migrations::POSTGRES;
use super::session;
#[cfg(feature = "cluster")]
use super::shared_queue;
use super::sqlite::PATIENCE;
use super::upgrade::{Part, Upgrade};

/// Number of connections of one process. A server allows a hundred in all, unless configured otherwise.
const CONNECTIONS: u32 = 8;

/// Opens the database at `url` and brings its tables up to date, while other processes that want the same wait.
pub(super) async fn open(url: &str) -> Result<AnyPool, StoreError> {
    migrate(url).await?;
    let pool = AnyPoolOptions::new()
        .acquire_timeout(2 * PATIENCE)
        .max_connections(CONNECTIONS)
        .after_connect(|connection, _| Box::pin(set_up(connection)))
        .connect_with(options(url)?)
        .await?;
    Ok(pool)
}

/// Brings all tables of the database at `url` up to date. If they are, no right to change them is needed.
///
/// # Errors
/// Also an account that may not change tables that are not up to date.
pub async fn migrate(url: &str) -> Result<Vec<Upgrade>, StoreError> {
    // A connection of its own: its end releases the lock that makes others wait, however it ends.
    let mut connection = connect(url).await?;
    let ours = Part {
        name: "jobs and results",
        history: "_sqlx_migrations",
        joining: Some(&POSTGRES.joining),
        migrations: &POSTGRES.migrator,
    };
    #[cfg_attr(not(feature = "cluster"), expect(unused_mut, reason = "there is no other part"))]
    let mut upgrades = vec![ours.bring_up_to_date(&mut connection).await?];
    #[cfg(feature = "cluster")]
    {
        let migrations = shared_queue::migrations();
        let queue = Part {
            name: "the queue",
            history: "apalis._sqlx_migrations",
            joining: None,
            migrations: &migrations,
        };
        upgrades.push(queue.bring_up_to_date(&mut connection).await?);
    }
    connection.close().await?;
    Ok(upgrades)
}

/// Opens one connection to the database at `url`.
pub(super) async fn connect(url: &str) -> Result<AnyConnection, StoreError> {
    let mut connection = AnyConnection::connect_with(&options(url)?).await?;
    set_up(&mut connection).await?;
    Ok(connection)
}

fn options(url: &str) -> Result<AnyConnectOptions, StoreError> {
    install_default_drivers();
    if !["postgres://", "postgresql://"].iter().any(|scheme| url.starts_with(scheme)) {
        return Err(StoreError::NoAddress);
    }
    Ok(url.parse()?)
}

async fn set_up(connection: &mut AnyConnection) -> Result<(), sqlx::Error> {
    connection.execute(sqlx::AssertSqlSafe(session::settings())).await.map(drop)
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

            // A permanent refusal stays one.
            let twice = "insert into readiness (id, mark) values (1, '')";
            let refused = sqlx::query(twice).execute(&store.writer).await.unwrap_err();
            assert!(!StoreError::from(refused).may_pass());
        }
    }
}
