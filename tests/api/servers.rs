//! Servers for the tests, which then have tables and files there: `RUBMAP_TEST_DATABASE` is the address of PostgreSQL databases with
//! `NAME` for their name, `RUBMAP_TEST_OBJECTS` that of object storage. Every data folder has a database and a prefix of its own there.

use std::path::Path;

use rubmap::config::Config;
use sqlx::{ConnectOptions, Executor};

/// Names and values for the environment of a service with this data folder; `None` unless tests are to be made on servers.
pub(crate) fn of(data: &Path) -> Option<[(&'static str, String); 2]> {
    let address = std::env::var("RUBMAP_TEST_DATABASE").ok()?;
    let objects = std::env::var("RUBMAP_TEST_OBJECTS").unwrap();
    let name: String =
        data.display().to_string().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let name = &name[name.len().saturating_sub(60)..];
    create(&address.replace("NAME", "postgres"), name);
    Some([
        ("RUBMAP_DATABASE", address.replace("NAME", name)),
        ("RUBMAP_OBJECTS", format!("{objects}/{name}")),
    ])
}

/// Sets the database and objects of a service to those of the servers.
pub(crate) fn share(config: &mut Config) {
    if let Some([(_, database), (_, objects)]) = of(&config.data) {
        config.shared.database = Some(database.parse().unwrap());
        config.shared.objects = Some(objects.parse().unwrap());
    }
}

/// Makes a database, if it is not there.
fn create(address: &str, name: &str) {
    let options: sqlx::postgres::PgConnectOptions = address.parse().unwrap();
    let create = format!("create database \"{name}\"");
    let created = async {
        let mut connection = options.connect().await?;
        connection.execute(sqlx::AssertSqlSafe(create)).await
    };
    // Asynchronous tests may not block, so it runs on a thread of its own.
    let created = std::thread::scope(|scope| {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        scope.spawn(move || runtime.block_on(created)).join().unwrap()
    });
    if let Err(error) = created {
        let is_there =
            error.as_database_error().and_then(|error| error.code()).is_some_and(|code| code == "42P04");
        assert!(is_there, "{error}");
    }
}
