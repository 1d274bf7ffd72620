//! Connections to a PostgreSQL server, and the upgrade of its tables.

use sqlx::any::{AnyConnectOptions, AnyPoolOptions, install_default_drivers};
use sqlx::{AnyConnection, AnyPool, Connection, Executor};

use super::cluster::queue;
use super::error::StoreError;
use super::migrations::POSTGRES;
use super::session;
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
    let mut upgrades = vec![ours.bring_up_to_date(&mut connection).await?];
    if let Some(migrations) = queue::migrations() {
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
