//! Contract of copying a data folder into a database and an object store.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::{Path, PathBuf};

use sqlx::{AnyConnection, AssertSqlSafe, ConnectOptions, Connection, Row};
use tempfile::TempDir;

use crate::analysis::kinds::modal_analysis::CAMPBELL;
use crate::dynamics::reduction::Checkpoints;
use crate::store::cluster::address::Address;
use crate::store::cluster::copy::{Copied, CopyError, copy};
use crate::store::contract::alone::{answer, calibration, reduced};
use crate::store::contract::{begin, keep, labels, model_id, queue, result, upload};
use crate::store::error::StoreError;
use crate::store::handle::LOCK;
use crate::store::jobs::{Failure, FailureCause, JobId};
use crate::store::labels::Labels;
use crate::store::models::ModelFilter;
use crate::store::status::JobStatus;
use crate::store::testing::{TestStore, stores};
use crate::store::{Store, sqlite};

/// Tables that are not copied: the migrations run so far, and the probe of readiness.
const NOT_COPIED: [&str; 2] = ["_sqlx_migrations", "readiness"];

/// Source and targets of a copy.
struct Move {
    data: TempDir,
    objects: TempDir,
    target: TestStore,
}

impl Move {
    /// Prepares a copy; none without PostgreSQL.
    async fn new() -> Option<Self> {
        let target = stores().await.pop()?;
        target.url.as_ref()?;
        let (data, objects) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        Some(Self { data, objects, target })
    }

    fn address(&self) -> Address {
        Address::Folder(self.objects.path().to_owned())
    }

    async fn copy(&self) -> Result<Copied, CopyError> {
        copy(self.data.path(), self.target.url.as_deref().unwrap(), &self.address(), |_| {}).await
    }

    async fn source(&self) -> AnyConnection {
        sqlite::address(self.data.path(), "rw").unwrap().connect().await.unwrap()
    }
}

/// Fills the data folder `data` with a row in every table, and returns a successful, a failed and an unfinished job.
async fn fill(data: &Path) -> [JobId; 3] {
    let store = Store::open(data).await.unwrap();
    store.probe().await.unwrap();
    upload(&store, "eve", 'b', &labels("Größe \u{1F600}", &["rare"])).await;
    upload(&store, "adam", 'b', &Labels::default()).await;
    upload(&store, "adam", 'a', &Labels::default()).await;
    store.insert_answer(&answer("eve", "k")).await.unwrap();
    store.insert_calibration("eight", &calibration(1.0)).await.unwrap();
    let successful = queue(&store, "eve", 'b', 250, &labels("done", &["x"])).await;
    begin(&store, successful).await;
    for index in 0..250 {
        keep(&store, successful, &result(index)).await.unwrap();
    }
    let document = (CAMPBELL, "[1]".to_owned());
    assert!(store.complete_job(successful, &[document], None).await.unwrap());
    let failed = queue(&store, "adam", 'a', 1, &Labels::default()).await;
    let failure =
        Failure { cause: FailureCause::Model, message: "\"'\\ \u{1}".to_owned(), violations: Vec::new() };
    store.advance_job(failed, JobStatus::Failed, Some(&failure)).await.unwrap();
    let unfinished = queue(&store, "adam", 'a', 3, &Labels::default()).await;
    begin(&store, unfinished).await;
    keep(&store, unfinished, &result(1)).await.unwrap();
    store.insert_reduction(unfinished, &model_id('a'), 20, &reduced(20)).await.unwrap();
    store.checkpoints(&model_id('a'), 30).save("harmonic-0", vec![1, 2, 3]);
    let basis = store.basis(&model_id('a'), 20).named("harmonic-0");
    std::fs::create_dir_all(basis.parent().unwrap()).unwrap();
    std::fs::write(&basis, "basis").unwrap();
    std::fs::write(basis.with_file_name("unfinished-x"), "").unwrap();
    sqlx::query("insert into trials (key, model, version, body, created_at) values ($1, $2, '0', '{}', 'a')")
        .bind("0".repeat(64))
        .bind(model_id('a'))
        .execute(&store.writer)
        .await
        .unwrap();
    store.close().await;
    [successful, failed, unfinished]
}

async fn tables(source: &mut AnyConnection) -> Vec<String> {
    let tables = "select name from sqlite_master where type = 'table' and name not like 'sqlite%'";
    sqlx::query_scalar(tables).fetch_all(source).await.unwrap()
}

async fn count(connection: &mut AnyConnection, table: &str) -> i64 {
    let count = AssertSqlSafe(format!("select count(*) from {table}"));
    sqlx::query_scalar(count).fetch_one(connection).await.unwrap()
}

/// Contents of the files in a folder, except those that a reader of the database leaves.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut waiting = vec![folder.to_owned()];
    let mut found = Vec::new();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if !path.to_str().unwrap().ends_with("-shm") && !path.to_str().unwrap().ends_with("-wal") {
            let content = std::fs::read(&path).unwrap();
            found.push((path, content));
        }
    }
    found.sort();
    found
}

#[tokio::test]
async fn everything_arrives_and_a_second_copy_changes_nothing() {
    let Some(to) = Move::new().await else { return };
    let jobs = fill(to.data.path()).await;
    let before = contents(to.data.path());
    let copied = to.copy().await.unwrap();
    assert_eq!((copied.models, copied.jobs), (2, 3));
    assert_eq!((copied.files, copied.new_files), (4, 4), "two packages, a basis, a checkpoint");
    assert_eq!(copied.rows, copied.new_rows);
    assert!(contents(to.data.path()) == before, "the data folder is only read");

    let mut source = to.source().await;
    let mut rows = 0;
    for table in tables(&mut source).await.iter().filter(|table| !NOT_COPIED.contains(&table.as_str())) {
        let expected = count(&mut source, table).await;
        assert!(expected > 0, "nothing in {table} shows that it is copied: add a row above");
        let mut target = to.target.readers.acquire().await.unwrap();
        assert_eq!(count(&mut target, table).await, expected, "{table}");
        rows += expected;
    }
    assert_eq!(rows.unsigned_abs(), copied.rows);
    source.close().await.unwrap();

    // A process of the cluster, whose data folder is empty, reads the copy.
    let alone = Store::open(to.data.path()).await.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let there = Store::connect(folder.path(), to.target.url.as_deref().unwrap()).await.unwrap();
    let there = there.sharing(&to.address()).await.unwrap();
    let names = async |store: &Store| -> Vec<(String, Labels)> {
        let models = store.models(ModelFilter::default(), 9).await.unwrap();
        models.into_iter().map(|model| (model.id, model.labels)).collect()
    };
    assert_eq!(names(&there).await, names(&alone).await);
    for letter in ['a', 'b'] {
        let package = to.objects.path().join(format!("models/{}.zip", model_id(letter)));
        assert_eq!(std::fs::read(package).unwrap(), b"package");
    }
    for job in jobs {
        let [here, there] = [alone.job(job).await.unwrap(), there.job(job).await.unwrap()]
            .map(|job| format!("{:?}", job.unwrap()));
        assert_eq!(there, here.replace("status: Running", "status: Accepted"));
    }
    assert_eq!(there.job(jobs[2]).await.unwrap().unwrap().status, JobStatus::Accepted);
    assert_eq!(there.finished_speeds(jobs[2]).await.unwrap().into_iter().collect::<Vec<_>>(), [1]);
    assert_eq!(there.document(jobs[0], CAMPBELL).await.unwrap().as_deref(), Some("[1]"));
    assert!(there.reduction(&model_id('a'), 20).await.unwrap().is_some());
    let parts = there.checkpoints(&model_id('a'), 30);
    let part = tokio::task::spawn_blocking(move || parts.load("harmonic-0")).await.unwrap();
    assert_eq!(part, Some(vec![1, 2, 3]));
    alone.close().await;

    // Another process measured the costs there.
    there.insert_calibration("eight", &calibration(2.0)).await.unwrap();
    let again = to.copy().await.unwrap();
    assert_eq!(again, Copied { new_rows: 0, new_files: 0, ..copied });
    assert_eq!(there.calibration("eight").await.unwrap(), Some(calibration(2.0)));
}

#[tokio::test]
async fn what_differs_is_told_and_left() {
    let Some(to) = Move::new().await else { return };
    let [successful, failed, _] = fill(to.data.path()).await;
    to.copy().await.unwrap();
    let mut target = to.target.readers.acquire().await.unwrap();
    for change in [
        format!("update jobs set name = 'another' where id = '{successful}'"),
        format!("update speed_results set wear = null where job = '{successful}' and speed = 7"),
        format!("delete from jobs where id = '{failed}'"),
    ] {
        sqlx::query(AssertSqlSafe(change)).execute(&mut *target).await.unwrap();
    }
    let package = to.objects.path().join(format!("models/{}.zip", model_id('a')));
    std::fs::write(&package, "PACKAGE").unwrap();
    let refused = to.copy().await.unwrap_err();
    let told = refused.to_string();
    for name in [
        format!("object models/{}.zip", model_id('a')),
        format!("jobs id {successful}"),
        format!("speed_results job {successful}, speed 7"),
    ] {
        assert!(told.contains(&name), "{told}");
    }
    assert_eq!(told.matches("; ").count(), 3, "{told}");
    assert_eq!(count(&mut target, "jobs").await, 2, "no row is copied beside one that differs");
    assert_eq!(std::fs::read(&package).unwrap(), b"PACKAGE");
}

#[tokio::test]
async fn a_folder_in_use_of_another_version_or_without_a_package_is_refused() {
    let Some(to) = Move::new().await else { return };
    assert!(matches!(to.copy().await, Err(CopyError::Store(StoreError::File(_)))), "no data folder");
    fill(to.data.path()).await;
    let service = File::create(to.data.path().join(LOCK)).unwrap();
    service.lock().unwrap();
    assert!(matches!(to.copy().await, Err(CopyError::InUse(_))));
    drop(service);
    let package = to.data.path().join(format!("models/{}.zip", model_id('a')));
    std::fs::rename(&package, package.with_extension("lost")).unwrap();
    let refused = to.copy().await.unwrap_err();
    assert!(refused.to_string().contains(&model_id('a')), "{refused}");
    std::fs::rename(package.with_extension("lost"), package).unwrap();
    let mut source = to.source().await;
    let earlier = "delete from _sqlx_migrations where version = (select max(version) from _sqlx_migrations)";
    sqlx::query(earlier).execute(&mut source).await.unwrap();
    source.close().await.unwrap();
    assert!(matches!(to.copy().await, Err(CopyError::Version { .. })));
    let mut target = to.target.readers.acquire().await.unwrap();
    assert_eq!(count(&mut target, "models").await, 0);
}

/// Columns of both databases are equal, as copies read them from the data folder alone.
#[tokio::test]
async fn both_databases_have_the_same_columns() {
    let Some(to) = Move::new().await else { return };
    Store::open(to.data.path()).await.unwrap().close().await;
    let mut source = to.source().await;
    let mut target = to.target.readers.acquire().await.unwrap();
    for table in tables(&mut source).await.iter().filter(|table| !NOT_COPIED.contains(&table.as_str())) {
        let names = |rows: Vec<sqlx::any::AnyRow>| -> BTreeSet<String> {
            rows.iter().map(|row| row.try_get(0).unwrap()).collect()
        };
        let here = sqlx::query("select name from pragma_table_info($1)").bind(table);
        let here = names(here.fetch_all(&mut source).await.unwrap());
        // The server numbers its rows in a column of its own.
        let there = "select column_name::text from information_schema.columns
             where table_schema = current_schema() and table_name = $1 and is_identity = 'NO'";
        let there = names(sqlx::query(there).bind(table).fetch_all(&mut *target).await.unwrap());
        assert_eq!(here, there, "{table}");
    }
}
