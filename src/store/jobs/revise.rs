//! Revision of the request of a running job.

use super::job::JobId;
use super::kept;
use crate::analysis::kinds::kind::ResolvedJob;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::time::now;

impl Store {
    /// Replaces the request of a running job by another of the same kind, with this number of `speeds`. Finished speeds stay, so speeds
    /// keep their indices. False if the job is not running any more, or has been given more speeds since: their number never falls.
    pub async fn revise_request(
        &self,
        id: JobId,
        request: &dyn ResolvedJob,
        speeds: u32,
    ) -> Result<bool, StoreError> {
        let mut write = self.write().await?;
        let revised = sqlx::query(
            "update jobs set request = $3, modes_per_speed = $4, speeds = $5, updated_at = $6
             where id = $1 and kind = $2 and status = 'running' and speeds <= $5",
        )
        .bind(id.to_string())
        .bind(request.kind().name)
        .bind(kept::write(request)?)
        .bind(request.modes_per_speed().map(i64::from))
        .bind(i64::from(speeds))
        .bind(now())
        .execute(&mut *write)
        .await?;
        write.commit_job(id).await?;
        Ok(revised.rows_affected() == 1)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use serde_json::json;

    use super::*;
    use crate::analysis::run::REVISION;
    use crate::kinds::JobKind;
    use crate::store::jobs::Begun;
    use crate::store::status::JobStatus;
    use crate::store::testing::stores;

    fn sweep(modes_per_speed: u32, speeds: u32) -> Arc<dyn ResolvedJob> {
        let request = json!({
            "model": "m", "modes_per_speed": modes_per_speed, "scene": {},
            "speeds": {"from": 1.0, "to": 2.0, "count": speeds, "unit": "hz"},
        });
        let text = json!({"schema": 1, "rounds": 0, "request": request});
        kept::read(JobKind::named("sweep").unwrap(), &text.to_string()).unwrap()
    }

    #[tokio::test]
    async fn a_running_job_takes_another_request_and_no_fewer_speeds() {
        for store in stores().await {
            let job = JobId::new();
            let insert = "insert into jobs (id, kind, model, modes_per_speed, facts, request, speeds, created_at, updated_at, revision)
                values ($1, 'sweep', 'm', 20, '{}', $2, 4, 'a', 'a', $3)";
            sqlx::query(insert)
                .bind(job.to_string())
                .bind(kept::write(&*sweep(20, 4)).unwrap())
                .bind(i64::from(REVISION))
                .execute(&store.writer)
                .await
                .unwrap();
            let revise = async |modes, speeds| {
                store.revise_request(job, &*sweep(modes, speeds), speeds).await.unwrap()
            };
            assert!(!revise(20, 6).await, "nobody has it in hand");
            assert_eq!(store.begin_job(job, "V3").await.unwrap(), Begun::Yes);
            // A repetition changes nothing.
            assert!(revise(30, 6).await && revise(30, 6).await);
            assert!(!revise(20, 5).await, "it has six by now");
            let kept: (String, i64, i64) =
                sqlx::query_as("select request, modes_per_speed, speeds from jobs")
                    .fetch_one(&store.readers)
                    .await
                    .unwrap();
            assert_eq!(kept, (kept::write(&*sweep(30, 6)).unwrap(), 30, 6));
            store.advance_job(job, JobStatus::Dismissed, None).await.unwrap();
            assert!(!revise(30, 8).await, "it has ended");
            assert!(!store.revise_request(JobId::new(), &*sweep(30, 8), 8).await.unwrap());
        }
    }
}
