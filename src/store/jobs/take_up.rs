//! Taking up unfinished jobs when a service starts, and counting those it died under.

use super::{JobId, read_id};
use crate::store::{Store, StoreError};

impl Store {
    /// All jobs that still want work, oldest first, as a service that starts finds them: each with the number of times
    /// the service died under it since anything of it was last finished, a speed or a part of its reduction. Counts one
    /// more for those that were being computed.
    pub async fn take_up_jobs(&self) -> Result<Vec<(JobId, u32)>, StoreError> {
        let mut transaction = self.writer.begin().await?;
        let dropped: Vec<(String, Option<String>, Option<u32>)> =
            sqlx::query_as("select id, model, modes_per_speed from jobs where in_hand = 1")
                .fetch_all(&mut *transaction)
                .await?;
        for (id, model, modes_per_speed) in dropped {
            let parts = match (model, modes_per_speed) {
                (Some(model), Some(modes)) => self.checkpoints(&model, modes).parts().await?,
                // Of many reductions, or of one not chosen yet.
                (Some(model), None) => self.parts_of_model(&model).await?,
                (None, _) => 0,
            };
            sqlx::query(
                "update jobs set crashes = case when ?1 > parts then 0 else crashes + 1 end, parts = ?1, in_hand = 0
                 where id = ?2",
            )
            .bind(parts)
            .bind(id)
            .execute(&mut *transaction)
            .await?;
        }
        let jobs: Vec<(String, u32)> = sqlx::query_as(
            "select id, crashes from jobs where status in ('accepted', 'running') order by id",
        )
        .fetch_all(&mut *transaction)
        .await?;
        transaction.commit().await?;
        jobs.iter().map(|(id, crashes)| Ok((read_id(id)?, *crashes))).collect()
    }

    /// Lays down all jobs: the service ends because it was told to.
    pub async fn lay_down_jobs(&self) -> Result<(), StoreError> {
        sqlx::query("update jobs set in_hand = 0 where in_hand = 1").execute(&self.writer).await?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::reduction::Checkpoints;

    #[tokio::test]
    async fn a_crash_after_a_part_of_the_reduction_was_kept_is_the_first_again() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let job = JobId::new();
        sqlx::query(
            "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at, updated_at)
             values (?, 'sweep', 'running', 'm', 20, '{}', '{}', 1, 'a', 'a')",
        )
        .bind(job.to_string())
        .execute(&store.writer)
        .await
        .unwrap();
        let crash = async || {
            sqlx::query("update jobs set in_hand = 1").execute(&store.writer).await.unwrap();
            let jobs = store.take_up_jobs().await.unwrap();
            assert_eq!(jobs[0].0, job);
            jobs[0].1
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
