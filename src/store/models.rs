//! Uploaded models: a row of facts each, and the package as a file.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};

use super::cluster::claims::Claim;
use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::labels::{self, LabelChanges, Labels, quoted};
use super::limits::{LimitReached, Limits};
use super::packages::{self, packages_folder};
use super::time::now;
use super::unfinished::{UNFINISHED, unfinished_file};
use crate::analysis::run::ModelFacts;
use crate::package::{self as packaging, Limits as PackageLimits, PackageError};

/// Prefix of the names of packages during their upload.
const UPLOAD_PREFIX: &str = "upload-";

/// Time between two attempts to become the only process that stores or removes a package.
const BETWEEN_CLAIMS: Duration = Duration::from_millis(100);

/// Exclusive right to store or remove a package, until it is dropped.
struct PackageWriter<'a> {
    _here: tokio::sync::MutexGuard<'a, ()>,
    _everywhere: Option<Claim>,
}

/// Stored model.
#[derive(Debug, Clone)]
pub struct StoredModel {
    /// Number of the model, growing in the order of upload.
    pub number: i64,
    /// Id of the model: digest of the content of its package.
    pub id: String,
    /// Facts of the model that requests are checked against.
    pub facts: ModelFacts,
    /// Name, tags and notes that its owner gave it; of several owners, the first.
    pub labels: Labels,
    /// Size of the zip as uploaded, bytes.
    pub size_bytes: u64,
    /// Time of the upload, RFC 3339.
    pub created_at: String,
}

/// Filter of a listing of models.
#[derive(Debug, Clone, Default)]
pub struct ModelFilter {
    /// Owner whose models are listed; all owners if none.
    pub owner: Option<String>,
    /// Text that the names of the models contain, or those of their packages where their owner gave none; case is ignored for the letters a
    /// to z.
    pub name: Option<String>,
    /// Tag of the models listed.
    pub tag: Option<String>,
    /// Number that all listed models are older than: the last of the previous page.
    pub before: Option<i64>,
}

/// Query of all models of the owner $1, or of all; a condition may follow.
pub(super) const OWNED: &str = "select models.rowid as number, models.id, facts, size_bytes,
        case when $1 is null then models.created_at else owned.created_at end as since,
        owned.name, coalesce(owned.tags, '[]') as tags, owned.notes
    from models left join model_owners as owned on owned.rowid =
        (select rowid from model_owners where model = models.id and ($1 is null or owner = $1)
         order by created_at, rowid limit 1)
    where ($1 is null or owned.rowid is not null)";

/// Outcome of deleting a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deletion {
    /// Deleted model, with its reductions.
    Deleted,
    /// Unknown model.
    Unknown,
    /// Model that this number of unfinished jobs still need.
    InUse(u64),
}

impl Store {
    /// Creates an empty file for the upload of a package, on the same file system as the models. Removed when dropped, or by the next
    /// start.
    pub async fn new_upload(&self) -> std::io::Result<tempfile::NamedTempFile> {
        self.reserve.expect_room().await?;
        unfinished_file(&packages_folder(&self.folder), UPLOAD_PREFIX)
    }

    /// Path of the package of `model` in the data folder.
    pub(super) fn package_path(&self, model: &str) -> PathBuf {
        packages::package_path(&self.folder, model)
    }

    /// Path of the package of `model` in the data folder, fetched if another process has put it into the object store. Where it is nowhere,
    /// reading it fails.
    pub async fn package(&self, model: &str) -> Result<PathBuf, StoreError> {
        let path = self.package_path(model);
        if self.objects.are_shared() && !tokio::fs::try_exists(&path).await? {
            let model = model.to_owned();
            let accept = move |came: &Path| expect_digest(came, &model);
            self.objects.fetch(&path, accept).await.map_err(StoreError::Objects)?;
        }
        Ok(path)
    }

    /// Whether the package at `path` is at its final place.
    async fn has_package(&self, path: &Path) -> Result<bool, StoreError> {
        if self.objects.are_shared() {
            return self.objects.have(path).await.map_err(StoreError::Objects);
        }
        Ok(tokio::fs::try_exists(path).await?)
    }

    /// Stores the package at `upload`, a file from [`Self::new_upload`], as model `id` of `owner`, within `limits`. Returns the model and
    /// whether it is new to the owner; `labels` apply only if it is new.
    ///
    /// The file comes first: a row promises that its package is there and complete. If the disk is full for the row, the same call may be
    /// made again.
    pub async fn insert_model(
        &self,
        (owner, limits): (&str, Limits),
        id: &str,
        facts: &ModelFacts,
        labels: &Labels,
        upload: &Path,
    ) -> Result<Result<(StoredModel, bool), LimitReached>, StoreError> {
        let _mine = self.only_package_writer(id).await?;
        let target = self.package_path(id);
        if let Some(known) = self.model(id, Some(owner)).await? {
            // The next upload restores a lost package.
            if self.has_package(&target).await? {
                return Ok(Ok((known, false)));
            }
        } else {
            // An earlier attempt may have moved the upload to its place.
            let package = if tokio::fs::try_exists(upload).await? { upload } else { &target };
            let bytes = tokio::fs::metadata(package).await?.len();
            let mut reader = self.readers.acquire().await?;
            if let Err(reached) = limits.allow_model(&mut reader, owner, bytes).await? {
                return Ok(Err(reached));
            }
        }
        // A number that is not finite is written as null, and would not be read again.
        let text = serde_json::to_string(facts)?;
        serde_json::from_str::<ModelFacts>(&text)?;
        self.reserve.expect_room().await?;
        let (upload, kept) = (upload.to_owned(), target.clone());
        let size_bytes = tokio::task::spawn_blocking(move || keep_file(&upload, &kept))
            .await
            .map_err(std::io::Error::other)??;
        self.objects.publish(&target).await.map_err(StoreError::Objects)?;
        let mut write = self.write().await?;
        write.guard(Guarded::Owner(owner)).await?;
        write.guard(Guarded::Model(id)).await?;
        // Limits are checked again: other uploads may have used them up meanwhile. A package without an owner is a leftover.
        let owns = "select 1 from model_owners where model = $1 and owner = $2";
        let owns = sqlx::query(owns).bind(id).bind(owner).fetch_optional(&mut *write).await?;
        if owns.is_none()
            && let Err(reached) = limits.allow_model(&mut write, owner, size_bytes).await?
        {
            write.rollback().await?;
            return Ok(Err(reached));
        }
        sqlx::query(
            "insert into models (id, name, facts, size_bytes, created_at) values ($1, $2, $3, $4, $5)
             on conflict (id) do nothing",
        )
        .bind(id)
        .bind(&facts.name)
        .bind(text)
        .bind(i64::try_from(size_bytes).unwrap_or(i64::MAX))
        .bind(now())
        .execute(&mut *write)
        .await?;
        let owned = sqlx::query(
            "insert into model_owners (model, owner, created_at, name, tags, notes) values ($1, $2, $3, $4, $5, $6)
             on conflict do nothing",
        )
        .bind(id)
        .bind(owner)
        .bind(now())
        .bind(&labels.name)
        .bind(serde_json::to_string(&labels.tags)?)
        .bind(&labels.notes)
        .execute(&mut *write)
        .await?;
        write.commit().await?;
        let model = self.model(id, Some(owner)).await?.ok_or(StoreError::Unseen)?;
        Ok(Ok((model, owned.rows_affected() == 1)))
    }

    /// Finds the model `id`, if `owner` has it; `None` asks for anybody's.
    pub async fn model(&self, id: &str, owner: Option<&str>) -> Result<Option<StoredModel>, StoreError> {
        sqlx::query(AssertSqlSafe(format!("{OWNED} and models.id = $2")))
            .bind(owner)
            .bind(id)
            .fetch_optional(&self.readers)
            .await?
            .map(|row| read(&row))
            .transpose()
    }

    /// Finds up to `limit` models that pass `filter`, newest first.
    pub async fn models(&self, filter: ModelFilter, limit: u32) -> Result<Vec<StoredModel>, StoreError> {
        sqlx::query(AssertSqlSafe(format!(
            "{OWNED} and ($2 is null or models.rowid < $2)
                 and ($3 is null or instr(lower(coalesce(owned.name, models.name)), $3) > 0)
                 and ($4 is null or instr(owned.tags, $4) > 0)
             order by models.rowid desc limit $5"
        )))
        .bind(filter.owner)
        .bind(filter.before)
        .bind(filter.name.as_deref().map(str::to_ascii_lowercase))
        .bind(filter.tag.as_deref().map(quoted).transpose()?)
        .bind(i64::from(limit))
        .fetch_all(&self.readers)
        .await?
        .iter()
        .map(read)
        .collect()
    }

    /// Changes the labels that `owner` (`None`: every owner) gives a model. False if there is no such model.
    pub async fn label_model(
        &self,
        id: &str,
        owner: Option<&str>,
        changes: LabelChanges,
    ) -> Result<bool, StoreError> {
        let update = changes.update("model_owners", "model = $6 and ($7 is null or owner = $7)")?;
        let mut write = self.write().await?;
        let changed =
            update.bind(id.to_owned()).bind(owner.map(ToOwned::to_owned)).execute(&mut *write).await?;
        write.commit().await?;
        Ok(changed.rows_affected() > 0)
    }

    /// Removes package files without a row: of interrupted uploads and deletions.
    pub(super) async fn remove_stale_packages(&self) -> Result<(), StoreError> {
        let mut files = tokio::fs::read_dir(packages_folder(&self.folder)).await?;
        while let Some(file) = files.next_entry().await? {
            let Ok(name) = file.file_name().into_string() else { continue };
            let stale = match packages::model_of(&name) {
                Some(id) => self.model(id, None).await?.is_none(),
                None => name.starts_with(UPLOAD_PREFIX) || name.starts_with(UNFINISHED),
            };
            if stale {
                tracing::warn!(
                    file = name,
                    "removing a package that no model has: an upload or a deletion broke off"
                );
                tokio::fs::remove_file(file.path()).await?;
            }
        }
        Ok(())
    }

    /// Takes model `id` from `owner` (`None`: from all), unless an unfinished job of theirs needs it, or anybody's job when there is no
    /// other owner. With its last owner it is deleted, and its reductions with it.
    pub async fn delete_model(&self, id: &str, owner: Option<&str>) -> Result<Deletion, StoreError> {
        let _mine = self.only_package_writer(id).await?;
        let (deletion, was_last) = self.with_reserve(|| self.remove_model(id, owner)).await?;
        if was_last {
            self.remove_checkpoints(id, None).await;
            self.remove_bases(id).await;
            let package = self.package_path(id);
            self.objects.remove(&package).await.map_err(StoreError::Objects)?;
            match tokio::fs::remove_file(package).await {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error.into()),
                _ => {}
            }
        }
        Ok(deletion)
    }

    /// Takes the exclusive right to store or remove the package of `model`, among all processes that share it.
    async fn only_package_writer(&self, model: &str) -> Result<PackageWriter<'_>, StoreError> {
        let here = self.packages.lock().await;
        let everywhere = match self.shared_queue() {
            Some(queue) => loop {
                if let Some(claim) = queue.claim(&format!("package {model}")).await? {
                    break Some(claim);
                }
                tokio::time::sleep(BETWEEN_CLAIMS).await;
            },
            None => None,
        };
        Ok(PackageWriter { _here: here, _everywhere: everywhere })
    }

    /// Removes a model from an owner in the database. Returns also whether nobody has it any more.
    async fn remove_model(&self, id: &str, owner: Option<&str>) -> Result<(Deletion, bool), StoreError> {
        if self.model(id, owner).await?.is_none() {
            return Ok((Deletion::Unknown, false));
        }
        let mut transaction = self.write_removal().await?;
        transaction.guard(Guarded::Model(id)).await?;
        let users: i64 = sqlx::query_scalar(
            "select count(*) from (
                 select owner from jobs where model = $1 and status in ('accepted', 'running', 'paused')
                 union all
                 select owner from jobs where compared_model = $1 and status in ('accepted', 'running', 'paused')) users
             where $2 is null or owner = $2
                 or not exists (select 1 from model_owners where model = $1 and owner <> $2)",
        )
        .bind(id)
        .bind(owner)
        .fetch_one(&mut *transaction)
        .await?;
        if users > 0 {
            transaction.rollback().await?;
            return Ok((Deletion::InUse(users.unsigned_abs()), false));
        }
        sqlx::query("delete from model_owners where model = $1 and ($2 is null or owner = $2)")
            .bind(id)
            .bind(owner)
            .execute(&mut *transaction)
            .await?;
        // A repeated request must not get the old answer that the model exists.
        sqlx::query("delete from idempotency_keys where location = '/v1/models/' || $1 and ($2 is null or owner = $2)")
            .bind(id)
            .bind(owner)
            .execute(&mut *transaction)
            .await?;
        let deleted = sqlx::query(
            "delete from models where id = $1 and not exists (select 1 from model_owners where model = $1)",
        )
        .bind(id)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok((Deletion::Deleted, deleted.rows_affected() == 1))
    }
}

pub(super) fn read(row: &AnyRow) -> Result<StoredModel, StoreError> {
    Ok(StoredModel {
        number: row.try_get("number")?,
        id: row.try_get("id")?,
        facts: serde_json::from_str(row.try_get("facts")?)?,
        labels: labels::read(row)?,
        size_bytes: row.try_get::<i64, _>("size_bytes")?.unsigned_abs(),
        created_at: row.try_get("since")?,
    })
}

/// Flushes the upload to the disk and gives it its final name, in this order, unless an earlier attempt did. Returns its size.
fn keep_file(upload: &Path, target: &Path) -> Result<u64, std::io::Error> {
    if upload.exists() {
        std::fs::File::open(upload)?.sync_all()?;
        std::fs::rename(upload, target)?;
        if let Some(folder) = target.parent() {
            std::fs::File::open(folder)?.sync_all()?;
        }
    }
    Ok(target.metadata()?.len())
}

/// Refuses a package from the object store whose content does not have the digest of its name.
fn expect_digest(came: &Path, model: &str) -> std::io::Result<()> {
    let found = packaging::read_digest(came, &PackageLimits::default());
    let wrong = match found {
        Ok(digest) if digest == model => return Ok(()),
        Ok(digest) => format!("its content is that of {digest}"),
        Err(PackageError::Io { source }) => return Err(source),
        Err(error) => error.to_string(),
    };
    let refusal = format!(
        "the object store has another package under the name of model {model}: {wrong}; upload that model again"
    );
    Err(std::io::Error::new(ErrorKind::InvalidData, refusal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::sector::Units;

    #[tokio::test]
    async fn a_model_whose_row_found_no_room_is_kept_later() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let unit = String::new;
        let facts = ModelFacts {
            name: "long ".repeat(100_000),
            sectors: 10,
            contact_nodes: 3,
            own_dofs: 100,
            speeds_rad_s: vec![0.0],
            units: Units { length: unit(), force: unit(), time: unit(), mass: unit() },
            gyroscopic: false,
            contact_radius: None,
            stiffening: None,
            contact_spacing: None,
            mesh: None,
            in_si: None,
            digits: None,
            warnings: Vec::new(),
            found: Vec::new(),
        };
        let upload = store.new_upload().await.unwrap().into_temp_path();
        std::fs::write(&upload, "package").unwrap();
        let id = "m".repeat(64);
        // SQLite refuses to grow beyond this number of pages as it does on a full disk.
        sqlx::query("pragma max_page_count = 1").execute(&store.writer).await.unwrap();
        let whose = ("", Limits::default());
        assert!(
            store
                .insert_model(whose, &id, &facts, &Labels::default(), &upload)
                .await
                .unwrap_err()
                .is_disk_full()
        );
        assert!(store.model(&id, None).await.unwrap().is_none());
        sqlx::query("pragma max_page_count = 100000").execute(&store.writer).await.unwrap();
        let (model, new) =
            store.insert_model(whose, &id, &facts, &Labels::default(), &upload).await.unwrap().unwrap();
        drop(upload);
        assert_eq!((model.size_bytes, new), (7, true));
        assert_eq!(std::fs::read_to_string(store.package_path(&id)).unwrap(), "package");
    }
}
