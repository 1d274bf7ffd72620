//! `SQLite` file of a data folder: found or made, brought up to date, and opened.

use std::io::{self, ErrorKind};
use std::path::Path;
use std::time::Duration;

use sqlx::any::{AnyConnectOptions, AnyPoolOptions, install_default_drivers};
use sqlx::migrate::MigrateError;
use sqlx::sqlite::{
    SqliteAutoVacuum, SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous,
};
use sqlx::{AnyConnection, AnyPool, AssertSqlSafe, ConnectOptions, Connection, Executor};

use super::error::StoreError;
use super::migrations::{Joining, SQLITE};
use super::packages::count_packages;
use super::reserve::free_bytes;

/// Name of the database in its folder.
pub(super) const DATABASE: &str = "rubmap.sqlite";

/// Number of connections for readers; more than the requests a database on one disk serves well at once.
const READERS: u32 = 8;

/// Time that a statement waits for a lock that another program holds (a backup, `vacuum`), and a request for a connection. For locks it is
/// also the default of sqlx, which applies to connections opened by their address.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);

/// Opens the database in `folder` for readers and for the one that writes, and brings its tables up to date.
///
/// A 202 is a promise and a speed may have cost minutes: both survive a power cut, at one flush each. The file itself records that it has a
/// write-ahead log; connections begin with a flush at every commit and with checks of references. Setting these in `after_connect` would
/// read the file, and on a failure the pool tries again for seconds instead of reporting the reason.
pub(super) async fn open(folder: &Path) -> Result<(AnyPool, AnyPool), StoreError> {
    expect_database(folder).await?;
    bring_up_to_date(folder).await?;
    let address = address(folder, "rwc")?;
    // A connection to a file does not break while idle: no need to test it each time.
    let pool = || AnyPoolOptions::new().acquire_timeout(2 * PATIENCE).test_before_acquire(false);
    let writer = pool().max_connections(1).connect_with(address.clone()).await?;
    let readers = pool().max_connections(READERS).connect_with(address).await?;
    Ok((readers, writer))
}

/// Address of the database in `folder`, in a mode of `SQLite`: `ro`, `rw` or `rwc`.
pub(super) fn address(folder: &Path, mode: &str) -> Result<AnyConnectOptions, StoreError> {
    install_default_drivers();
    // In an address a relative path would begin with the name of a machine, and `..` would not follow links.
    let folder = folder.canonicalize()?;
    let Some(path) = folder.to_str() else {
        return Err(io::Error::new(ErrorKind::InvalidInput, "its path is no UTF-8 text").into());
    };
    let mut options: AnyConnectOptions = format!("sqlite:///?mode={mode}").parse()?;
    if let Ok(mut segments) = options.database_url.path_segments_mut() {
        segments.clear().extend(path.split('/').filter(|name| !name.is_empty())).push(DATABASE);
    }
    Ok(options)
}

/// Refuses a folder whose packages have lost their database: the database is missing, or knows no models, as after its write-ahead log was
/// lost or only the file copied. A single package may be of the very first upload, interrupted.
async fn expect_database(folder: &Path) -> Result<(), StoreError> {
    let database = folder.join(DATABASE);
    if database.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, format!("{DATABASE} is a folder")).into());
    }
    let packages = count_packages(folder)?;
    if packages == 0 {
        return Ok(());
    }
    let length = match std::fs::metadata(&database) {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error.into()),
        found => found.map_or(0, |file| file.len()),
    };
    if length > 0 {
        let options = SqliteConnectOptions::new().filename(&database).busy_timeout(PATIENCE);
        let mut connection = options.connect().await?;
        let known = knows_models(&mut connection, packages > 1).await?;
        connection.close().await?;
        if known {
            return Ok(());
        }
    }
    Err(StoreError::LostDatabase { database, packages })
}

/// Whether a database has the table of models, and, with `any`, at least one model in it.
async fn knows_models(database: &mut SqliteConnection, any: bool) -> Result<bool, StoreError> {
    let table = "select exists (select 1 from sqlite_master where type = 'table' and name = 'models')";
    let is_there: bool = sqlx::query_scalar(table).fetch_one(&mut *database).await?;
    if !is_there || !any {
        return Ok(is_there);
    }
    Ok(sqlx::query_scalar("select exists (select 1 from models)").fetch_one(database).await?)
}

/// Makes missing tables, on a connection of its own: a connection that sets how space is released writes that into the database whenever it
/// is opened, and no reader could be opened on a full disk.
async fn bring_up_to_date(folder: &Path) -> Result<(), StoreError> {
    let mut connection = SqliteConnectOptions::new()
        .filename(folder.join(DATABASE))
        .create_if_missing(true)
        .journal_mode(SqliteJournalMode::Wal)
        .synchronous(SqliteSynchronous::Full)
        .auto_vacuum(SqliteAutoVacuum::Incremental)
        .busy_timeout(PATIENCE)
        .connect()
        .await?;
    join(&mut connection, folder).await?;
    SQLITE.migrator.run(&mut connection).await.map_err(|error| match error {
        MigrateError::VersionMissing(found) => {
            StoreError::NewerTables { part: "the data folder", found, known: known_version() }
        }
        error => error.into(),
    })?;
    make_shrinkable(&mut connection).await?;
    connection.close().await?;
    Ok(())
}

/// Brings tables that earlier programs made in many steps to those that are now made as a whole. Harmless to repeat.
async fn join(connection: &mut SqliteConnection, folder: &Path) -> Result<(), StoreError> {
    let Joining { from, sql, to, checksum } = &SQLITE.joining;
    match latest_step(connection).await? {
        Some(found) if found == *from => {}
        Some(found) if found < *from => return Err(StoreError::OlderTables { found, least: *from }),
        _ => return Ok(()),
    }
    expect_room(connection, folder).await?;
    tracing::info!("bringing the tables up to date, once");
    // References lead to tables that are made anew; the setting cannot be changed within a transaction.
    connection.execute("pragma foreign_keys = off").await?;
    let mut transaction = connection.begin_with("begin immediate").await?;
    // Another process may have made the step meanwhile.
    if latest_step(&mut transaction).await? == Some(*from) {
        transaction.execute(AssertSqlSafe(sql.as_str())).await?;
        transaction.execute("delete from _sqlx_migrations").await?;
        sqlx::query(
            "insert into _sqlx_migrations (version, description, success, checksum, execution_time)
             values ($1, 'tables', true, $2, 0)",
        )
        .bind(to)
        .bind(checksum)
        .execute(&mut *transaction)
        .await?;
    }
    transaction.commit().await?;
    connection.execute("pragma foreign_keys = on").await?;
    Ok(())
}

/// Version of the last step that made the tables; `None` for a new file.
async fn latest_step(connection: &mut SqliteConnection) -> Result<Option<i64>, StoreError> {
    let history =
        "select exists (select 1 from sqlite_master where type = 'table' and name = '_sqlx_migrations')";
    if !sqlx::query_scalar::<_, bool>(history).fetch_one(&mut *connection).await? {
        return Ok(None);
    }
    Ok(sqlx::query_scalar("select max(version) from _sqlx_migrations").fetch_one(connection).await?)
}

/// Requires room for the documents and requests once more in the file, and once in its log while they are copied.
async fn expect_room(connection: &mut SqliteConnection, folder: &Path) -> Result<(), StoreError> {
    let copied = "select coalesce((select sum(octet_length(body)) from documents), 0)
             + coalesce((select sum(octet_length(request) + coalesce(octet_length(facts), 0)) from jobs), 0)";
    let copied: i64 = sqlx::query_scalar(copied).fetch_one(connection).await?;
    let (needed, free) = (2 * copied.unsigned_abs(), free_bytes(folder)?);
    if needed > free { Err(StoreError::NoRoomForTables { needed, free }) } else { Ok(()) }
}

/// Version to which this program brings tables.
pub(super) fn known_version() -> i64 {
    SQLITE.migrator.iter().map(|migration| migration.version).max().unwrap_or_default()
}

/// Version of the tables of `database`, which has some.
pub(super) async fn version(database: &mut AnyConnection) -> Result<i64, StoreError> {
    let version: Option<i64> =
        sqlx::query_scalar("select max(version) from _sqlx_migrations").fetch_one(database).await?;
    Ok(version.unwrap_or_default())
}

/// Rebuilds, once, a database that an earlier version made unable to release space.
async fn make_shrinkable(connection: &mut SqliteConnection) -> Result<(), StoreError> {
    const INCREMENTAL: i64 = 2;
    let mode: i64 = sqlx::query_scalar("pragma auto_vacuum").fetch_one(&mut *connection).await?;
    if mode == INCREMENTAL {
        return Ok(());
    }
    tracing::info!("making the database anew, once, so that it can give room back");
    if let Err(error) = sqlx::query("vacuum").execute(connection).await {
        tracing::warn!(%error, "could not; deleted jobs leave their room to later ones");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::store::Store;
    use crate::store::jobs::JobFilter;
    use crate::store::packages::{package_path, packages_folder};

    /// Data folder of an earlier program, whose tables have version 26.
    async fn older_folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let options = SqliteConnectOptions::new()
            .filename(folder.path().join(DATABASE))
            .create_if_missing(true)
            .foreign_keys(false);
        let mut connection = options.connect().await.unwrap();
        connection.execute(include_str!("testing/tables_0026.sql")).await.unwrap();
        connection.close().await.unwrap();
        folder
    }

    /// Databases that were moved away, emptied or copied without their log made all packages leftovers, as nothing knew them any more.
    #[tokio::test]
    async fn packages_without_a_database_are_not_leftovers() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(packages_folder(folder.path())).unwrap();
        let package = package_path(folder.path(), &"0a".repeat(32));
        std::fs::write(&package, "package").unwrap();
        let database = folder.path().join(DATABASE);
        let of_another = folder.path().join("another");
        let options = SqliteConnectOptions::new().filename(&of_another).create_if_missing(true);
        let mut another = options.connect().await.unwrap();
        sqlx::query("create table theirs (a)").execute(&mut another).await.unwrap();
        another.close().await.unwrap();
        let contents = [None, Some(Vec::new()), Some(vec![b'x']), Some(std::fs::read(of_another).unwrap())];
        for content in contents {
            if let Some(content) = &content {
                std::fs::write(&database, content).unwrap();
            }
            let refused = Store::open(folder.path()).await.unwrap_err();
            assert!(matches!(refused, StoreError::LostDatabase { packages: 1, .. }), "{refused}");
            assert!(!refused.may_pass());
            assert_eq!(database.exists(), content.is_some());
            assert!(package.exists());
        }
        std::fs::remove_file(&database).unwrap();
        std::fs::create_dir(&database).unwrap();
        assert!(!Store::open(folder.path()).await.unwrap_err().may_pass(), "a folder is nothing to wait for");
        std::fs::remove_dir(&database).unwrap();
        // The packages are in nobody's way elsewhere.
        let kept = folder.path().join("kept.zip");
        std::fs::rename(&package, &kept).unwrap();
        Store::open(folder.path()).await.unwrap().close().await;
        // One package may be of an interrupted upload; several are not.
        std::fs::copy(&kept, &package).unwrap();
        Store::open(folder.path()).await.unwrap().close().await;
        std::fs::copy(&kept, package_path(folder.path(), &"0b".repeat(32))).unwrap();
        let refused = Store::open(folder.path()).await.unwrap_err();
        assert!(matches!(refused, StoreError::LostDatabase { packages: 2, .. }), "{refused}");
    }

    /// Connections wait, flush and check references although no setting is made when a pool opens them.
    #[tokio::test]
    async fn every_connection_waits_flushes_and_checks_references() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        for pool in [&store.writer, &store.readers] {
            let mut found = Vec::new();
            for setting in ["synchronous", "foreign_keys", "busy_timeout"] {
                let pragma = sqlx::AssertSqlSafe(format!("pragma {setting}"));
                found.push(sqlx::query_scalar::<_, i64>(pragma).fetch_one(pool).await.unwrap());
            }
            assert_eq!(found, [2, 1, PATIENCE.as_millis() as i64]);
            let mode: String = sqlx::query_scalar("pragma journal_mode").fetch_one(pool).await.unwrap();
            assert_eq!(mode, "wal");
        }
    }

    #[tokio::test]
    async fn a_data_folder_may_be_called_anything() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a b", "50%25", "?mode=ro", "#1", "größe", "a\\b:c@d", "..."] {
            let data = folder.path().join(name);
            std::fs::create_dir(&data).unwrap();
            let store = Store::open(&data.join("../").join(name)).await.unwrap();
            store.probe().await.unwrap();
            store.close().await;
            assert!(data.join(DATABASE).exists(), "{name}");
        }
    }

    /// Readers can be opened even while the database cannot be written, on a full disk for example.
    #[tokio::test]
    async fn a_reader_is_opened_while_another_writes() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let write = store.write().await.unwrap();
        let mut opened = Vec::new();
        for _ in 0..READERS {
            let mut reader = store.readers.acquire().await.unwrap();
            let jobs: i64 =
                sqlx::query_scalar("select count(*) from jobs").fetch_one(&mut *reader).await.unwrap();
            assert_eq!(jobs, 0);
            opened.push(reader);
        }
        write.rollback().await.unwrap();
    }

    #[tokio::test]
    async fn a_full_disk_is_told_from_other_failures() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        // SQLite refuses to grow beyond this number of pages as it does on a full disk.
        sqlx::query("pragma max_page_count = 1").execute(&store.writer).await.unwrap();
        let large = "insert into idempotency_keys values ('', 'k', 'f', 200, 'l', json_quote(hex(zeroblob(100000))), 'a')";
        let full = StoreError::from(sqlx::query(large).execute(&store.writer).await.unwrap_err());
        assert!(full.is_disk_full(), "{full}");
        let wrong = StoreError::from(
            sqlx::query("insert into jobs (id) values (1)").execute(&store.writer).await.unwrap_err(),
        );
        assert!(!wrong.is_disk_full(), "{wrong}");
    }

    /// Jobs of every kind are read after the one step from the tables of an earlier program, and the unfinished one goes on.
    #[tokio::test]
    async fn jobs_of_an_earlier_program_stay() {
        let folder = older_folder().await;
        let store = Store::open(folder.path()).await.unwrap();
        let heads = store.jobs(JobFilter::default(), 100).await.unwrap();
        let mut kinds: Vec<&str> = heads.iter().map(|job| job.kind.name).collect();
        kinds.sort_unstable();
        let all = [
            "branches",
            "campaign",
            "case_study",
            "modal_analysis",
            "model_generation",
            "run_up",
            "sweep",
            "sweep",
        ];
        assert_eq!(kinds, all);
        for head in &heads {
            let job = store.job(head.id).await.unwrap().unwrap();
            assert_eq!(job.request.speeds(), head.speeds.total, "{}", head.kind.name);
            assert_eq!(Arc::clone(&job.request).work().units(), head.kind.units, "{}", head.kind.name);
            // The form in which these were stored is not the one that is posted.
            let resolved_otherwise =
                ["branches", "campaign", "case_study", "run_up"].contains(&head.kind.name);
            assert_eq!(job.posted.is_none(), resolved_otherwise, "{}", head.kind.name);
            if let Some(posted) = &job.posted {
                (head.kind.read)(&posted.body).unwrap();
            }
            let documents = store.documents(head.id).await.unwrap();
            assert_eq!(
                documents.is_empty(),
                ["campaign", "model_generation"].contains(&head.kind.name) || !head.status.is_final()
            );
        }
        let unfinished = heads.iter().find(|job| job.status.wants_work()).unwrap();
        assert_eq!((unfinished.labels.name.as_deref(), unfinished.speeds.finished), (Some("unfinished"), 0));
        let finished = heads.iter().find(|job| job.labels.name.as_deref() == Some("first")).unwrap();
        assert_eq!(store.finished_speeds(finished.id).await.unwrap().len(), 2);

        // References are checked as before, now to the new table.
        let lost =
            "insert into documents (job, name, part, body, created_at) values ('x', 'campbell', 0, '1', 'a')";
        assert!(sqlx::query(lost).execute(&store.writer).await.is_err());
        sqlx::query("delete from jobs").execute(&store.writer).await.unwrap();
        assert!(store.finished_speeds(finished.id).await.unwrap().is_empty());
        store.close().await;
        // The step is not made twice.
        Store::open(folder.path()).await.unwrap().close().await;
    }

    /// Tables that came from an earlier program are those of a new folder.
    #[tokio::test]
    async fn older_tables_become_what_new_ones_are() {
        let (older, new) = (older_folder().await, tempfile::tempdir().unwrap());
        let mut found = Vec::new();
        for folder in [older.path(), new.path()] {
            let store = Store::open(folder).await.unwrap();
            let indices =
                "select name, sql from sqlite_master where type = 'index' and sql is not null order by name";
            let indices: Vec<(String, String)> =
                sqlx::query_as(indices).fetch_all(&store.readers).await.unwrap();
            let columns = "select tables.name || '.' || columns.name,
                    columns.type || columns.\"notnull\" || columns.pk || coalesce(columns.dflt_value, '')
                from sqlite_master as tables, pragma_table_info(tables.name) as columns
                where tables.type = 'table' and tables.name not like 'sqlite%' order by 1";
            let columns: Vec<(String, String)> =
                sqlx::query_as(columns).fetch_all(&store.readers).await.unwrap();
            let plain = |sql: &str| {
                sql.to_lowercase().split_whitespace().collect::<Vec<_>>().join(" ").replace('"', "")
            };
            found.push((indices.iter().map(|(_, sql)| plain(sql)).collect::<Vec<_>>(), columns));
            store.close().await;
        }
        assert_eq!(found[0], found[1]);
    }

    #[tokio::test]
    async fn tables_that_are_too_old_are_left_alone() {
        let folder = older_folder().await;
        let options = SqliteConnectOptions::new().filename(folder.path().join(DATABASE));
        let mut connection = options.connect().await.unwrap();
        connection.execute("delete from _sqlx_migrations where version = 26").await.unwrap();
        connection.close().await.unwrap();
        let refused = Store::open(folder.path()).await.unwrap_err();
        assert!(matches!(refused, StoreError::OlderTables { found: 25, least: 26 }), "{refused}");
        assert!(!refused.may_pass());
    }
}
