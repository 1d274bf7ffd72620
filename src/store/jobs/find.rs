//! Queries of one job or of a page of jobs.

use sqlx::AssertSqlSafe;

use super::job::{Job, JobHead, JobId};
use super::row::{HEAD, read, read_head};
use crate::kinds::JobKind;
use crate::store::dialect::Dialect;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::labels::quoted;
use crate::store::status::JobStatus;

/// Filter of a listing of jobs.
#[derive(Debug, Clone, Default)]
pub struct JobFilter {
    /// Owner whose jobs are listed; all owners if none.
    pub owner: Option<String>,
    /// Status of the jobs listed.
    pub status: Option<JobStatus>,
    /// Kind of the jobs listed.
    pub kind: Option<JobKind>,
    /// Model of the jobs listed.
    pub model: Option<String>,
    /// Text that the names of the jobs contain; case is ignored for the letters a to z.
    pub name: Option<String>,
    /// Tag of the jobs listed.
    pub tag: Option<String>,
    /// Job that all listed ones are older than: the last of the previous page.
    pub before: Option<JobId>,
}

/// Query of the ids of the jobs of a page, answered by one index.
fn page(dialect: Dialect) -> String {
    format!(
        "select id from jobs {}
         where deleted = 0 and ($1 is null or status = $1) and ($2 is null or kind = $2) and id < coalesce($3, '~')
             and ($5 is null or owner = $5) and ($6 is null or model = $6)
             and ($7 is null or instr(lower(name), $7) > 0) and ($8 is null or instr(tags, $8) > 0)
         order by id desc limit $4",
        dialect.by_job_list()
    )
}

impl Store {
    /// Finds the job `id`.
    pub async fn job(&self, id: JobId) -> Result<Option<Job>, StoreError> {
        sqlx::query("select * from jobs where id = $1 and deleted = 0")
            .bind(id.to_string())
            .fetch_optional(&self.readers)
            .await?
            .map(|row| read(&row))
            .transpose()
    }

    /// Finds the job `id` as lists show it: cheap, however large its request is.
    pub async fn job_head(&self, id: JobId) -> Result<Option<JobHead>, StoreError> {
        sqlx::query(AssertSqlSafe(format!("select {HEAD} from jobs where id = $1 and deleted = 0")))
            .bind(id.to_string())
            .fetch_optional(&self.readers)
            .await?
            .map(|row| read_head(&row))
            .transpose()
    }

    /// Finds up to `limit` jobs that pass `filter`, newest first.
    pub async fn jobs(&self, filter: JobFilter, limit: u32) -> Result<Vec<JobHead>, StoreError> {
        let page = page(self.dialect);
        sqlx::query(AssertSqlSafe(format!("select {HEAD} from jobs where id in ({page}) order by id desc")))
            .bind(filter.status.map(JobStatus::as_str))
            .bind(filter.kind.map(|kind| kind.name))
            .bind(filter.before.map(|id| id.to_string()))
            .bind(i64::from(limit))
            .bind(filter.owner)
            .bind(filter.model)
            .bind(filter.name.as_deref().map(str::to_ascii_lowercase))
            .bind(filter.tag.as_deref().map(quoted).transpose()?)
            .fetch_all(&self.readers)
            .await?
            .iter()
            .map(read_head)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use sqlx::Row;

    use super::*;

    /// Jobs, ten thousand of them, with requests of several database pages each: a listing must not read the requests.
    #[tokio::test]
    async fn a_page_of_many_jobs_is_found_in_one_index() {
        const JOBS: u32 = 10_000;
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let mut write = store.write().await.unwrap();
        for index in 0..JOBS {
            sqlx::query(
                "insert into jobs (id, kind, model, modes_per_speed, facts, request, speeds, created_at, updated_at, name, tags)
                 values ($1, 'sweep', 'm', 20, '{}', json_object('a', hex(zeroblob(5000))), 4, 'a', 'a', $2, $3)",
            )
            .bind(JobId::new().to_string())
            .bind(format!("Wheel {index}"))
            .bind(if index % 5000 == 0 { r#"["rare","one"]"# } else { r#"["a rare","one","x\"rare\"y"]"# })
            .execute(&mut *write)
            .await
            .unwrap();
        }
        write.commit().await.unwrap();
        let plan = sqlx::query(AssertSqlSafe(format!("explain query plan {}", page(store.dialect))))
            .fetch_all(&store.readers)
            .await
            .unwrap();
        let plan: Vec<String> = plan.iter().map(|row| row.get("detail")).collect();
        assert_eq!(plan.len(), 1, "nothing is sorted: {plan:?}");
        assert!(plan[0].contains("USING COVERING INDEX job_list"), "{plan:?}");

        let begin = Instant::now();
        let find = async |filter| store.jobs(filter, 3).await.unwrap();
        let rare = find(JobFilter { tag: Some("rare".to_owned()), ..JobFilter::default() }).await;
        let names = |found: &[JobHead]| -> Vec<String> {
            found.iter().filter_map(|job| job.labels.name.clone()).collect()
        };
        assert_eq!(names(&rare), ["Wheel 5000", "Wheel 0"]);
        let older =
            JobFilter { before: Some(rare[0].id), tag: Some("rare".to_owned()), ..JobFilter::default() };
        assert_eq!(names(&find(older).await), ["Wheel 0"]);
        let named = JobFilter { name: Some("wHEEL 77".to_owned()), ..JobFilter::default() };
        assert_eq!(names(&find(named).await), ["Wheel 7799", "Wheel 7798", "Wheel 7797"]);
        let nobody = JobFilter { name: Some("%".to_owned()), ..JobFilter::default() };
        assert!(find(nobody).await.is_empty());
        // The query takes some milliseconds; the bound of a minute allows for a loaded machine.
        assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
        eprintln!("four listings of {JOBS} jobs: {:?}", begin.elapsed());
    }
}
