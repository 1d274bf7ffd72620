//! Reduced sectors, one per model and `modes_per_speed`.

use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::sql::of;
use super::time::now;
use crate::analysis::result::ReductionReport;
use crate::analysis::run::{REVISION, ReducedSector};

/// Layout of a stored reduction and of its checkpoints: raise it when [`ReducedSector`] or the parts of a reduction
/// change, so that old ones are computed again instead of misread.
pub(super) const LAYOUT: i64 = 4;

/// Key of the form of a stored reduction: its layout and the revision of its numbers.
const FORM: i64 = 1_000_000 * LAYOUT + REVISION as i64;

impl Store {
    /// Finds the stored reduction of `model`, if this version of the program can read it.
    pub async fn reduction(
        &self,
        model: &str,
        modes_per_speed: u32,
    ) -> Result<Option<ReducedSector>, StoreError> {
        let blob: Option<Vec<u8>> = sqlx::query_scalar(
            "select reduced from reductions where model = $1 and modes_per_speed = $2 and layout = $3",
        )
        .bind(model)
        .bind(i64::from(modes_per_speed))
        .bind(FORM)
        .fetch_optional(&self.readers)
        .await?;
        Ok(blob.and_then(|blob| match postcard::from_bytes(&blob) {
            Ok(reduced) => Some(reduced),
            Err(error) => {
                tracing::warn!(model.id = model, modes_per_speed, %error, "stored reduction is unreadable");
                None
            }
        }))
    }

    /// Lists the reports of the reductions of `model` that this version of the program can read, by ascending `modes_per_speed`.
    pub async fn reduction_reports(&self, model: &str) -> Result<Vec<ReductionReport>, StoreError> {
        let reports: Vec<String> = sqlx::query_scalar(
            "select report from reductions where model = $1 and layout = $2 order by modes_per_speed",
        )
        .bind(model)
        .bind(FORM)
        .fetch_all(&self.readers)
        .await?;
        Ok(reports.iter().map(|report| serde_json::from_str(report)).collect::<Result<_, _>>()?)
    }

    /// Whether there is a reduction of `model` that this version of the program can read.
    pub async fn has_reduction(&self, model: &str, modes_per_speed: u32) -> Result<bool, StoreError> {
        let stored = "select 1 from reductions where model = $1 and modes_per_speed = $2 and layout = $3";
        let stored = sqlx::query(stored).bind(model).bind(i64::from(modes_per_speed)).bind(FORM);
        Ok(stored.fetch_optional(&self.readers).await?.is_some())
    }

    /// Lists model and `modes_per_speed` of all stored reductions that this version of the program can read.
    pub(super) async fn stored_reductions(&self) -> Result<Vec<(String, u32)>, StoreError> {
        let stored: Vec<(String, i64)> =
            sqlx::query_as("select model, modes_per_speed from reductions where layout = $1")
                .bind(FORM)
                .fetch_all(&self.readers)
                .await?;
        stored
            .into_iter()
            .map(|(model, modes)| Ok((model, of("reductions.modes_per_speed", modes)?)))
            .collect()
    }

    /// Stores the reduction of `model` that `job` made, and drops its checkpoints. Nothing is stored for a model deleted meanwhile.
    pub async fn insert_reduction(
        &self,
        job: JobId,
        model: &str,
        modes_per_speed: u32,
        reduced: &ReducedSector,
    ) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        write.guard(Guarded::Model(model)).await?;
        let kept = sqlx::query(
            "insert into reductions (model, modes_per_speed, layout, reduced, report, created_at)
             select $1, $2, $3, $4, $5, $6 where exists (select 1 from models where id = $1)
             on conflict (model, modes_per_speed) do update
             set layout = excluded.layout, reduced = excluded.reduced, report = excluded.report,
                 created_at = excluded.created_at",
        )
        .bind(model)
        .bind(i64::from(modes_per_speed))
        .bind(FORM)
        .bind(postcard::to_stdvec(reduced)?)
        .bind(serde_json::to_string(&reduced.report)?)
        .bind(now())
        .execute(&mut *write)
        .await?;
        sqlx::query("update jobs set crashes = 0 where id = $1 and crashes > 0")
            .bind(job.to_string())
            .execute(&mut *write)
            .await?;
        write.commit().await?;
        self.remove_checkpoints(model, Some(modes_per_speed)).await;
        if kept.rows_affected() == 0 {
            self.remove_bases(model).await;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::testing::stores;

    #[tokio::test]
    async fn a_reduction_of_other_numbers_is_not_there() {
        for store in stores().await {
            sqlx::query(
                "insert into models (id, name, facts, size_bytes, created_at) values ($1, 'm', '{}', 1, 'a')",
            )
            .bind("m".repeat(64))
            .execute(&store.writer)
            .await
            .unwrap();
            let report = r#"{"modes_per_speed": 20, "unknowns": [7], "wheel_unknowns": 40, "largest_mode_residual": 1e-9,
                "modes": 60, "counted_modes": 60, "full_model": [], "basis_tolerance": 1e-5, "stiffening": {"verdict": "absent",
                "linear_ratio": 0, "quadratic_ratio": 0, "frequency_error": 0, "message": "none"}, "wall_time_s": 1.5, "version": "0.1.0"}"#;
            let rows = [(10, FORM - 1, r#"{"modes_per_speed": 10, "checked_modes": 5}"#), (20, FORM, report)];
            for (modes_per_speed, layout, report) in rows {
                sqlx::query("insert into reductions values ($1, $2, $3, $4, $5, 'a')")
                    .bind("m".repeat(64))
                    .bind(i64::from(modes_per_speed))
                    .bind(layout)
                    .bind([0].as_slice())
                    .bind(report)
                    .execute(&store.writer)
                    .await
                    .unwrap();
            }
            let reports = store.reduction_reports(&"m".repeat(64)).await.unwrap();
            assert_eq!(reports.iter().map(|report| report.modes_per_speed).collect::<Vec<_>>(), [20]);
        }
    }
}
