//! Backup of a data folder, complete although a service works on the folder, and the check of a data folder.

use std::path::{Path, PathBuf};

use futures::TryStreamExt;
use serde::de::IgnoredAny;
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{AnyConnection, ConnectOptions, Connection, Row};

use super::error::StoreError;
use super::packages::{package_path, packages_folder};
use super::sqlite::{self, DATABASE, PATIENCE};
use super::{end_states, jobs, models, results, states};
use crate::package;

/// Contents of a backup.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Backup {
    /// Number of models with their packages.
    pub models: u64,
    /// Number of jobs with their results.
    pub jobs: u64,
    /// Number of models that were deleted while they were being copied; they are not in the backup.
    pub dropped: u64,
}

/// Copies the data folder `data` to `to`, which must not exist and lies elsewhere: the database as it is at one moment, and the packages of
/// its models. A service may run on the folder. Parts of unfinished reductions are left out: they can be computed again.
///
/// # Errors
/// A failed backup leaves nothing at `to`.
pub async fn backup(data: &Path, to: &Path) -> Result<Backup, StoreError> {
    if to.try_exists()? {
        return Err(
            std::io::Error::new(std::io::ErrorKind::AlreadyExists, "the backup would overwrite it").into()
        );
    }
    let around = match to.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    expect_data_folder(data)?;
    if around.canonicalize()?.starts_with(data.canonicalize()?) {
        let inside = "a backup inside the data folder would be lost with it";
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, inside).into());
    }
    // The final name promises a complete backup.
    let unfinished = tempfile::Builder::new().prefix("unfinished-backup-").tempdir_in(around)?;
    std::fs::create_dir(packages_folder(unfinished.path()))?;
    let mut source = connect(data).read_only(true).connect().await?;
    let copy = unfinished.path().join(DATABASE);
    sqlx::query("vacuum into $1").bind(copy.to_string_lossy()).execute(&mut source).await?;

    let mut copied = connect(unfinished.path()).foreign_keys(true).connect().await?;
    let ids: Vec<String> = sqlx::query_scalar("select id from models").fetch_all(&mut copied).await?;
    let (mut models, mut dropped) = (0, 0);
    for id in ids {
        let (from, to) = (package_path(data, &id), package_path(unfinished.path(), &id));
        let file = tokio::task::spawn_blocking(move || copy_file(&from, &to));
        match file.await.map_err(std::io::Error::other)? {
            Ok(()) => models += 1,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                let there: bool = sqlx::query_scalar("select exists (select 1 from models where id = $1)")
                    .bind(&id)
                    .fetch_one(&mut source)
                    .await?;
                if there {
                    let missing = std::io::Error::new(error.kind(), format!("of model {id}: {error}"));
                    return Err(StoreError::Package(missing));
                }
                sqlx::query("delete from models where id = $1").bind(&id).execute(&mut copied).await?;
                dropped += 1;
            }
            Err(error) => return Err(error.into()),
        }
    }
    let jobs: i64 =
        sqlx::query_scalar("select count(*) from jobs where deleted = 0").fetch_one(&mut copied).await?;
    copied.close().await?;
    source.close().await?;
    for written in [copy, packages_folder(unfinished.path()), unfinished.path().to_owned()] {
        std::fs::File::open(written)?.sync_all()?;
    }
    std::fs::rename(unfinished.path(), to)?;
    std::fs::File::open(around)?.sync_all()?;
    // The folder has its final name now.
    let _ = unfinished.keep();
    Ok(Backup { models, jobs: jobs.unsigned_abs(), dropped })
}

/// Refuses a folder without a database.
pub(super) fn expect_data_folder(data: &Path) -> Result<(), StoreError> {
    if data.join(DATABASE).try_exists()? {
        return Ok(());
    }
    let absent = format!("no {DATABASE} in it: this is no data folder");
    Err(std::io::Error::new(std::io::ErrorKind::NotFound, absent).into())
}

fn copy_file(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::copy(from, to)?;
    std::fs::File::open(to)?.sync_all()
}

/// Findings of a check of a data folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Findings {
    /// Defects found, one by one; empty if all is well.
    pub wrong: Vec<String>,
    /// Number of models whose packages are unchanged.
    pub models: u64,
    /// Number of jobs that read back.
    pub jobs: u64,
    /// Number of speeds whose results read back.
    pub speeds: u64,
}

/// Reads everything in the data folder `data` and reports what differs from what was written. Changes nothing; a service may run on the
/// folder.
pub async fn check(data: &Path) -> Result<Findings, StoreError> {
    expect_data_folder(data)?;
    let mut found = Findings::default();
    let mut database = sqlite::address(data, "ro")?.connect().await?;
    let verdicts: Vec<String> = sqlx::query_scalar("pragma integrity_check").fetch_all(&mut database).await?;
    found.wrong.extend(verdicts.into_iter().filter(|verdict| verdict != "ok"));
    for row in sqlx::query("pragma foreign_key_check").fetch_all(&mut database).await? {
        let (table, parent): (String, String) = (row.try_get(0)?, row.try_get(2)?);
        found.wrong.push(format!("a row of {table} belongs to a row of {parent} that is not there"));
    }
    let (version, known) = (sqlite::version(&mut database).await?, sqlite::known_version());
    if version != known {
        found.wrong.push(format!(
            "the database has version {version}, this program knows {known}: start the service once to bring it up to date, or \
             take the program that wrote it"
        ));
        return Ok(found);
    }
    check_models(data, &mut database, &mut found).await?;
    check_jobs(&mut database, &mut found).await?;
    database.close().await?;
    Ok(found)
}

async fn check_models(
    data: &Path,
    database: &mut AnyConnection,
    found: &mut Findings,
) -> Result<(), StoreError> {
    for row in sqlx::query(models::OWNED).bind(None::<&str>).fetch_all(&mut *database).await? {
        let id: String = row.try_get("id")?;
        if let Err(error) = models::read(&row) {
            found.wrong.push(format!("model {id}: {error}"));
        }
        let path = package_path(data, &id);
        let read = move || package::read(&path, &package::Limits::default()).map(|package| package.digest);
        match tokio::task::spawn_blocking(read).await.map_err(std::io::Error::other)? {
            Ok(digest) if digest == id => found.models += 1,
            Ok(_) => found.wrong.push(format!("model {id}: its package has another content")),
            Err(error) => {
                let there = sqlx::query("select id from models where id = $1")
                    .bind(&id)
                    .fetch_optional(&mut *database)
                    .await?;
                // A service may have deleted the model meanwhile.
                if there.is_some() {
                    found.wrong.push(format!("model {id}: {error}"));
                }
            }
        }
    }
    Ok(())
}

async fn check_jobs(database: &mut AnyConnection, found: &mut Findings) -> Result<(), StoreError> {
    let mut rows = sqlx::query("select * from jobs where deleted = 0").fetch(&mut *database);
    while let Some(row) = rows.try_next().await? {
        match jobs::read(&row) {
            Ok(_) => found.jobs += 1,
            Err(error) => found.wrong.push(format!("job {}: {error}", row.try_get::<&str, _>("id")?)),
        }
    }
    drop(rows);
    let mut rows =
        sqlx::query("select job, speed, point, spectra, unpacked_bytes, wear, contact from speed_results")
            .fetch(&mut *database);
    while let Some(row) = rows.try_next().await? {
        match results::read(&row) {
            Ok(_) => found.speeds += 1,
            Err(error) => {
                let (job, speed): (&str, i64) = (row.try_get("job")?, row.try_get("speed")?);
                found.wrong.push(format!("job {job}, speed {speed}: {error}"));
            }
        }
    }
    drop(rows);
    let mut rows = sqlx::query_as::<_, (String, String, i64, String)>(
        "select job, name, part, body from documents where exists (select 1 from jobs where id = job and deleted = 0)",
    )
    .fetch(&mut *database);
    while let Some((job, name, part, body)) = rows.try_next().await? {
        let read = match name.as_str() {
            "states" => states::check(&body).map_err(|error| error.to_string()),
            _ => serde_json::from_str::<IgnoredAny>(&body).map(drop).map_err(|error| error.to_string()),
        };
        if let Err(error) = read {
            found.wrong.push(format!("job {job}, {name} {part}: {error}"));
        }
    }
    drop(rows);
    // Unreadable reductions and trials are computed again; an end state, from which a chain of speeds continues, cannot be.
    let mut rows =
        sqlx::query_as::<_, (String, Vec<u8>)>("select job, state from end_states").fetch(database);
    while let Some((job, state)) = rows.try_next().await? {
        if let Err(error) = end_states::read(&state) {
            found.wrong.push(format!("job {job}, where its chain of speeds goes on: {error}"));
        }
    }
    Ok(())
}

fn connect(folder: &Path) -> SqliteConnectOptions {
    let file: PathBuf = folder.join(DATABASE);
    SqliteConnectOptions::new().filename(file).busy_timeout(PATIENCE)
}
