//! Recovery of unfinished jobs when a service starts, and counts of the crashes they may have caused.

use sqlx::AssertSqlSafe;

use super::job::JobId;
use super::row::read_id;
use crate::analysis::run::{REVISION, vectors};
use crate::store::dialect::{Dialect, Guarded};
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::sql::of;

/// Unfinished job that still wants work.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unfinished {
    /// Id of the job.
    pub id: JobId,
    /// Owner of the job.
    pub owner: String,
    /// Number of times the service died while the job was being computed, since any part of it was last finished.
    pub crashes: u32,
}

impl Store {
    /// Counts one more crash of the service for the jobs that were being computed when it last died, not for those that only waited beside
    /// them. For a job of which a part of its reduction was finished before, the count begins anew. For a service that starts.
    pub async fn count_crashes(&self) -> Result<(), StoreError> {
        let marked = self.marked()?;
        if marked.is_empty() {
            return Ok(());
        }
        let mut transaction = self.write().await?;
        for id in marked {
            transaction.guard(Guarded::Job(id)).await?;
            let found: Option<(Option<String>, Option<i64>)> = sqlx::query_as(
                "select model, modes_per_speed from jobs where id = $1 and status in ('accepted', 'running')",
            )
            .bind(id.to_string())
            .fetch_optional(&mut *transaction)
            .await?;
            let Some((model, modes_per_speed)) = found else { continue };
            let parts = match (model, modes_per_speed) {
                (Some(model), Some(modes)) => {
                    self.checkpoints(&model, of("jobs.modes_per_speed", modes)?).parts().await?
                }
                // The job has many reductions, or one not chosen yet.
                (Some(model), None) => self.parts_of_model(&model).await?,
                (None, _) => 0,
            };
            sqlx::query(
                "update jobs set crashes = case when $1 > parts then 0 else crashes + 1 end, parts = $1 where id = $2",
            )
            .bind(i64::from(parts))
            .bind(id.to_string())
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit().await?;
        self.forget_marked()
    }

    /// Restarts unfinished jobs that another revision of the numerics began: all speeds of a sweep belong to one revision. Restarts as well
    /// jobs bound to one kind of vectors that another kind began, except on a server: it may have machines of that kind, and later
    /// programs, to which their jobs are left. Chosen settings and added speeds stay, as if they had been requested. For a service that
    /// starts.
    pub async fn restart_outdated(&self) -> Result<(), StoreError> {
        const OUTDATED: &str = "status in ('accepted', 'running', 'paused') and (revision < $1 or $2 is not null and (revision > $1 or one_kind = 1 and vectors <> $2))";
        let own = (self.dialect == Dialect::Sqlite).then(vectors);
        let any = format!("select id from jobs where {OUTDATED} limit 1");
        let any = sqlx::query(AssertSqlSafe(any)).bind(i64::from(REVISION)).bind(&own);
        if any.fetch_optional(&self.readers).await?.is_none() {
            return Ok(());
        }
        let mut transaction = self.write().await?;
        let all = format!("select id from jobs where {OUTDATED} order by id");
        let all: Vec<String> = sqlx::query_scalar(AssertSqlSafe(all))
            .bind(i64::from(REVISION))
            .bind(&own)
            .fetch_all(&mut *transaction)
            .await?;
        for id in all {
            transaction.guard(Guarded::Job(read_id(&id)?)).await?;
        }
        for table in ["speed_results", "end_states", "documents"] {
            let begun = format!("delete from {table} where job in (select id from jobs where {OUTDATED})");
            sqlx::query(AssertSqlSafe(begun))
                .bind(i64::from(REVISION))
                .bind(&own)
                .execute(&mut *transaction)
                .await?;
        }
        let restart = format!(
            "update jobs set finished = 0, diverged = 0, failed = 0, stored_bytes = 0, progress = 0, phase = '', plan = null,
                 revision = $1, vectors = null
             where {OUTDATED}"
        );
        let restarted = sqlx::query(AssertSqlSafe(restart))
            .bind(i64::from(REVISION))
            .bind(&own)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        tracing::info!(
            jobs = restarted.rows_affected(),
            "begin anew: their numbers were of another version or kind of processor"
        );
        Ok(())
    }

    /// Lists all jobs that still want work, oldest first.
    pub async fn unfinished_jobs(&self) -> Result<Vec<Unfinished>, StoreError> {
        let jobs: Vec<(String, String, i64)> = sqlx::query_as(
            "select id, owner, crashes from jobs where status in ('accepted', 'running') order by id",
        )
        .fetch_all(&self.readers)
        .await?;
        jobs.into_iter()
            .map(|(id, owner, crashes)| {
                Ok(Unfinished { id: read_id(&id)?, owner, crashes: of("jobs.crashes", crashes)? })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::reduction::Checkpoints;
    use crate::store::testing::stores;

    #[tokio::test]
    async fn a_crash_after_a_part_of_the_reduction_was_kept_is_the_first_again() {
        for store in stores().await {
            let job = JobId::new();
            sqlx::query(
                "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at, updated_at)
                 values ($1, 'sweep', 'running', 'm', 20, '{}', '{}', 1, 'a', 'a')",
            )
            .bind(job.to_string())
            .execute(&store.writer)
            .await
            .unwrap();
            let crash = async || {
                // State that a service leaves which dies while it computes.
                std::fs::write(store.folder.path().join("computing").join(job.to_string()), "").unwrap();
                store.count_crashes().await.unwrap();
                let jobs = store.unfinished_jobs().await.unwrap();
                assert_eq!(jobs[0].id, job);
                jobs[0].crashes
            };
            assert_eq!(crash().await, 1);
            assert_eq!(crash().await, 2);
            store.checkpoints("m", 20).save("harmonic-0", vec![1]);
            store.checkpoints("another", 20).save("harmonic-1", vec![1]);
            assert_eq!(crash().await, 0);
            assert_eq!(crash().await, 1, "nothing new was kept");
            store.checkpoints("m", 20).save("harmonic-1", vec![1]);
            assert_eq!(crash().await, 0);
            // The reduction is finished: its parts are gone.
            store.remove_checkpoints("m", Some(20)).await;
            assert_eq!(crash().await, 1);
        }
    }

    #[tokio::test]
    async fn unfinished_work_of_other_numbers_begins_anew() {
        for store in stores().await {
            let insert = async |status: &str, revision: u32| {
                let job = JobId::new();
                sqlx::query(
                    "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at, updated_at,
                         finished, stored_bytes, revision, finished_at)
                     values ($1, 'sweep', $2, 'm', 20, '{}', '{}', 2, 'a', 'a', 1, 2, $3, $4)",
                )
                .bind(job.to_string())
                .bind(status)
                .bind(i64::from(revision))
                .bind((status == "successful").then_some("a"))
                .execute(&store.writer)
                .await
                .unwrap();
                sqlx::query(
                    "insert into speed_results (job, speed, status, point, created_at) values ($1, 1, 'completed', '{}', 'a')",
                )
                .bind(job.to_string())
                .execute(&store.writer)
                .await
                .unwrap();
                job
            };
            let outdated = insert("running", REVISION - 1).await;
            let others = [insert("running", REVISION).await, insert("successful", REVISION - 1).await];
            store.restart_outdated().await.unwrap();
            assert!(store.finished_speeds(outdated).await.unwrap().is_empty());
            let counted: (i64, i64, i64) =
                sqlx::query_as("select finished, stored_bytes, revision from jobs where id = $1")
                    .bind(outdated.to_string())
                    .fetch_one(&store.readers)
                    .await
                    .unwrap();
            assert_eq!(counted, (0, 0, i64::from(REVISION)));
            for job in others {
                assert_eq!(store.finished_speeds(job).await.unwrap().len(), 1);
            }
        }
    }
}
