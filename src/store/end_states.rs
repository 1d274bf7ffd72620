//! End states of sweeps up or down: one per job, that of the speed finished last.

use sqlx::AnyConnection;

use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use crate::analysis::end_state::EndState;

impl Store {
    /// State of the wheel at the end of speed `index` of a job, if that speed was finished last and left a state.
    pub async fn end_state(&self, job: JobId, index: u32) -> Result<Option<EndState>, StoreError> {
        let state: Option<Vec<u8>> =
            sqlx::query_scalar("select state from end_states where job = $1 and speed = $2")
                .bind(job.to_string())
                .bind(i64::from(index))
                .fetch_optional(&self.readers)
                .await?;
        state.map(|state| read(&state)).transpose()
    }
}

/// Reads a stored state.
pub(super) fn read(state: &[u8]) -> Result<EndState, StoreError> {
    Ok(postcard::from_bytes(state)?)
}

/// Stores the end state of a speed that has just finished in place of the one before; none if the speed left no state.
pub(super) async fn replace(
    connection: &mut AnyConnection,
    job: JobId,
    speed: u32,
    state: Option<&[u8]>,
) -> Result<(), StoreError> {
    drop_of(connection, job).await?;
    let Some(state) = state else { return Ok(()) };
    sqlx::query(
        "insert into end_states (job, speed, state)
         select $1, $2, $3 where exists (select 1 from jobs where id = $1 and status in ('accepted', 'running', 'paused'))",
    )
    .bind(job.to_string())
    .bind(i64::from(speed))
    .bind(state)
    .execute(connection)
    .await?;
    Ok(())
}

/// Drops the end state of a job.
pub(super) async fn drop_of(connection: &mut AnyConnection, job: JobId) -> Result<(), StoreError> {
    sqlx::query("delete from end_states where job = $1").bind(job.to_string()).execute(connection).await?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::analysis::result::SpeedResult;
    use crate::analysis::run::REVISION;
    use crate::store::results::PackedSpeed;
    use crate::store::status::JobStatus;
    use crate::store::testing::stores;

    /// Result of a finished speed that ended at `state`.
    fn result(index: u32, state: Option<f64>) -> SpeedResult {
        let point = json!({
            "index": index, "speed_rad_s": 1.0, "status": "completed", "steps_per_revolution": 1,
            "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0, "responses": [],
            "wall_time_s": 0.1, "version": "0",
        });
        SpeedResult {
            point: serde_json::from_value(point).unwrap(),
            spectra: None,
            wear: None,
            contact: None,
            end_state: state.map(|x| EndState(vec![x, 0.1 + 0.2])),
        }
    }

    async fn running_job(store: &Store) -> JobId {
        let job = JobId::new();
        sqlx::query(
            "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at, updated_at, revision)
             values ($1, 'sweep', 'running', 'm', 20, '{}', '{}', 5, 'a', 'a', $2)",
        )
        .bind(job.to_string())
        .bind(i64::from(REVISION))
        .execute(&store.writer)
        .await
        .unwrap();
        job
    }

    async fn keep(store: &Store, job: JobId, result: &SpeedResult) {
        store.insert_speed(job, &PackedSpeed::of(result).unwrap()).await.unwrap();
    }

    #[tokio::test]
    async fn the_state_of_the_last_speed_is_kept_until_the_job_is_final() {
        for store in stores().await {
            let (job, other) = (running_job(&store).await, running_job(&store).await);
            let state = async |index| store.end_state(job, index).await.unwrap();
            let first = result(4, Some(1.0));
            keep(&store, job, &first).await;
            keep(&store, other, &result(4, Some(7.0))).await;
            assert_eq!(state(4).await, first.end_state, "to the bit");
            assert_eq!(state(3).await, None);
            // A speed that is there already stays unchanged.
            keep(&store, job, &result(4, Some(2.0))).await;
            assert_eq!(state(4).await, first.end_state);
            let second = result(3, Some(3.0));
            keep(&store, job, &second).await;
            assert_eq!((state(4).await, state(3).await), (None, second.end_state));
            // A diverged speed leaves no state to the next.
            keep(&store, job, &result(2, None)).await;
            assert_eq!((state(3).await, state(2).await), (None, None));

            keep(&store, job, &result(1, Some(4.0))).await;
            store.advance_job(job, JobStatus::Dismissed, None).await.unwrap();
            assert_eq!(state(1).await, None);
            // Speeds still being computed at that time come too late.
            keep(&store, job, &result(0, Some(5.0))).await;
            assert_eq!(state(0).await, None);
            assert!(store.end_state(other, 4).await.unwrap().is_some());
            assert!(store.complete_job(other, &[], None).await.unwrap());
            assert_eq!(store.end_state(other, 4).await.unwrap(), None);
        }
    }
}
