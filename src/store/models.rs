//! Uploaded models: a row of facts each, and the package as a file.

use std::path::{Path, PathBuf};

use sqlx::Row;
use sqlx::sqlite::SqliteRow;

use super::{Store, StoreError, now};
use crate::analysis::run::ModelFacts;

/// What names of packages on their way in begin with.
const UPLOAD_PREFIX: &str = "upload-";

/// A stored model.
#[derive(Debug, Clone)]
pub struct StoredModel {
    /// Models get growing numbers as they come.
    pub number: i64,
    /// Digest of the package's content.
    pub id: String,
    /// What requests are checked against.
    pub facts: ModelFacts,
    /// Size of the zip as uploaded.
    pub size_bytes: u64,
    /// RFC 3339.
    pub created_at: String,
}

/// What became of a model that was to be deleted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deletion {
    /// Gone, with its reductions.
    Deleted,
    /// There is no such model.
    Unknown,
    /// So many unfinished jobs still need it.
    InUse(u64),
}

impl Store {
    /// An empty file on the same file system as the models, for a package on its way in. Removed when dropped, or by the
    /// next start.
    pub fn new_upload(&self) -> std::io::Result<tempfile::NamedTempFile> {
        tempfile::Builder::new().prefix(UPLOAD_PREFIX).tempfile_in(self.folder.join("models"))
    }

    /// Where the package of `model` lies.
    pub fn package_path(&self, model: &str) -> PathBuf {
        self.folder.join("models").join(format!("{model}.zip"))
    }

    /// Keeps the package at `upload` as model `id`. Returns the model and whether it is new.
    ///
    /// The file comes first: a row promises that its package is there and complete.
    pub async fn insert_model(
        &self,
        id: &str,
        facts: &ModelFacts,
        upload: tempfile::TempPath,
    ) -> Result<(StoredModel, bool), StoreError> {
        let _packages = self.packages.lock().await;
        if let Some(known) = self.model(id).await? {
            return Ok((known, false));
        }
        let target = self.package_path(id);
        let size_bytes = tokio::task::spawn_blocking(move || keep_file(upload, &target))
            .await
            .map_err(std::io::Error::other)??;
        let created = sqlx::query(
            "insert into models (id, name, facts, size_bytes, created_at) values (?, ?, ?, ?, ?)
             on conflict (id) do nothing",
        )
        .bind(id)
        .bind(&facts.name)
        .bind(serde_json::to_string(facts)?)
        .bind(i64::try_from(size_bytes).unwrap_or(i64::MAX))
        .bind(now())
        .execute(&self.writer)
        .await?;
        let model = self.model(id).await?.ok_or(sqlx::Error::RowNotFound)?;
        Ok((model, created.rows_affected() == 1))
    }

    /// The model `id`.
    pub async fn model(&self, id: &str) -> Result<Option<StoredModel>, StoreError> {
        sqlx::query("select rowid as number, * from models where id = ?")
            .bind(id)
            .fetch_optional(&self.readers)
            .await?
            .map(|row| read(&row))
            .transpose()
    }

    /// Up to `limit` models, newest first; only older ones than that with number `before`.
    pub async fn models(&self, before: Option<i64>, limit: u32) -> Result<Vec<StoredModel>, StoreError> {
        sqlx::query(
            "select rowid as number, * from models where ?1 is null or rowid < ?1 order by rowid desc limit ?2",
        )
            .bind(before)
            .bind(limit)
            .fetch_all(&self.readers)
            .await?
            .iter()
            .map(read)
            .collect()
    }

    /// Removes package files without a row: of uploads and deletions that broke off.
    pub(super) async fn remove_stale_packages(&self) -> Result<(), StoreError> {
        let mut files = tokio::fs::read_dir(self.folder.join("models")).await?;
        while let Some(file) = files.next_entry().await? {
            let Ok(name) = file.file_name().into_string() else { continue };
            let stale = match name.strip_suffix(".zip") {
                Some(id) => self.model(id).await?.is_none(),
                None => name.starts_with(UPLOAD_PREFIX),
            };
            if stale {
                tokio::fs::remove_file(file.path()).await?;
            }
        }
        Ok(())
    }

    /// Deletes model `id` with its reductions, unless an unfinished job needs it.
    pub async fn delete_model(&self, id: &str) -> Result<Deletion, StoreError> {
        let _packages = self.packages.lock().await;
        let mut transaction = self.writer.begin().await?;
        let users: i64 = sqlx::query_scalar(
            "select count(*) from jobs where model = ? and status in ('accepted', 'running')",
        )
        .bind(id)
        .fetch_one(&mut *transaction)
        .await?;
        if users > 0 {
            return Ok(Deletion::InUse(users.unsigned_abs()));
        }
        let deleted =
            sqlx::query("delete from models where id = ?").bind(id).execute(&mut *transaction).await?;
        transaction.commit().await?;
        if deleted.rows_affected() == 0 {
            return Ok(Deletion::Unknown);
        }
        self.remove_checkpoints(id, None).await;
        match tokio::fs::remove_file(self.package_path(id)).await {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error.into()),
            _ => Ok(Deletion::Deleted),
        }
    }
}

fn read(row: &SqliteRow) -> Result<StoredModel, StoreError> {
    Ok(StoredModel {
        number: row.try_get("number")?,
        id: row.try_get("id")?,
        facts: serde_json::from_str(row.try_get("facts")?)?,
        size_bytes: row.try_get::<i64, _>("size_bytes")?.unsigned_abs(),
        created_at: row.try_get("created_at")?,
    })
}

/// Flushes the upload to the disk and gives it its final name, in this order. Returns its size.
fn keep_file(upload: tempfile::TempPath, target: &Path) -> Result<u64, std::io::Error> {
    let file = std::fs::File::open(&upload)?;
    file.sync_all()?;
    let size = file.metadata()?.len();
    upload.persist(target).map_err(|error| error.error)?;
    if let Some(folder) = target.parent() {
        std::fs::File::open(folder)?.sync_all()?;
    }
    Ok(size)
}
