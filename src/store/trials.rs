//! Trial runs that are compared with others: of studies, of pilots, of controls.

use sha2::{Digest, Sha256};

use super::dialect::Dialect;
use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::time::now;
use crate::analysis::run::{Trial, TrialRequest, VERSION};

/// Key of a trial: digest of its request and of the version of the program.
pub fn key(request: &TrialRequest) -> Result<String, StoreError> {
    let mut digest = Sha256::new();
    digest.update(VERSION);
    digest.update([0]);
    digest.update(serde_json::to_vec(request)?);
    Ok(format!("{:x}", digest.finalize()))
}

impl Store {
    /// Finds the trial of this key, if it was run before.
    pub async fn trial(&self, key: &str) -> Result<Option<Trial>, StoreError> {
        let body: Option<String> = sqlx::query_scalar("select body from trials where key = $1")
            .bind(key)
            .fetch_optional(&self.readers)
            .await?;
        // An unreadable trial is run again.
        Ok(body.and_then(|body| serde_json::from_str(&body).ok()))
    }

    /// Stores a trial that `job` needed. Nothing is stored for a model deleted meanwhile.
    pub async fn insert_trial(
        &self,
        job: JobId,
        key: &str,
        model: &str,
        trial: &Trial,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Model(model)).await?;
        sqlx::query(
            "insert into trials (key, model, version, body, created_at)
             select $1, $2, $3, $4, $5 where exists (select 1 from models where id = $2)
             on conflict (key) do update set body = excluded.body, created_at = excluded.created_at",
        )
        .bind(key)
        .bind(model)
        .bind(VERSION)
        .bind(serde_json::to_string(trial)?)
        .bind(now())
        .execute(&mut *transaction)
        .await?;
        sqlx::query("update jobs set crashes = 0 where id = $1 and crashes > 0")
            .bind(job.to_string())
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await
    }

    /// Drops the trials of other versions of the program, except on a server, where those may run beside this one: there trials are dropped
    /// with their jobs.
    pub(super) async fn remove_stale_trials(&self) -> Result<(), StoreError> {
        if self.dialect == Dialect::Postgres {
            return Ok(());
        }
        let mut write = self.write().await?;
        sqlx::query("delete from trials where version <> $1").bind(VERSION).execute(&mut *write).await?;
        write.commit().await
    }
}
