//! Claims: exclusive tasks among all processes that share a database. Others wait until the holder is done, or has been silent for a while.

use std::time::Duration;

use sqlx::PgPool;
use tokio::runtime::Handle;
use tokio::task::JoinHandle;

use crate::store::error::StoreError;

/// Time between two renewals of a claim.
const RENEWAL: Duration = Duration::from_secs(5);

/// Time in seconds without a renewal after which another process may take a claim.
const SILENCE: i32 = 30;

/// Exclusive right of this process to a task, until it is dropped.
#[derive(Debug)]
pub struct Claim {
    pool: PgPool,
    name: String,
    holder: String,
    /// Runtime that renews and releases the claim, which may be dropped on a thread outside the runtime.
    runtime: Handle,
    renewal: JoinHandle<()>,
}

impl Claim {
    /// Takes the claim `name`, unless another process has it.
    pub(super) async fn of(pool: &PgPool, name: &str) -> Result<Option<Self>, StoreError> {
        let holder = uuid::Uuid::now_v7().to_string();
        if !take(pool, name, &holder).await? {
            return Ok(None);
        }
        let runtime = Handle::current();
        let renewal = runtime.spawn({
            let (pool, name, holder) = (pool.clone(), name.to_owned(), holder.clone());
            async move {
                loop {
                    tokio::time::sleep(RENEWAL).await;
                    match take(&pool, &name, &holder).await {
                        Ok(true) => {}
                        Ok(false) => tracing::warn!(
                            name,
                            "another process does the same: this one was silent for too long"
                        ),
                        Err(error) => tracing::debug!(name, %error, "could not renew a claim"),
                    }
                }
            }
        });
        Ok(Some(Self { pool: pool.clone(), name: name.to_owned(), holder, runtime, renewal }))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        self.renewal.abort();
        let (pool, name, holder) =
            (self.pool.clone(), std::mem::take(&mut self.name), std::mem::take(&mut self.holder));
        // If this fails, the claim expires by silence.
        self.runtime.spawn(async move {
            let given =
                sqlx::query("delete from claims where name = $1 and holder = $2").bind(name).bind(holder);
            let _ = given.execute(&pool).await;
        });
    }
}

/// Takes or renews a claim, by the clock of the database; false if another process has it.
async fn take(pool: &PgPool, name: &str, holder: &str) -> Result<bool, StoreError> {
    let taken = sqlx::query(
        "insert into claims (name, holder, until) values ($1, $2, now() + make_interval(secs => $3))
         on conflict (name) do update set holder = excluded.holder, until = excluded.until
         where claims.holder = excluded.holder or claims.until < now()",
    )
    .bind(name)
    .bind(holder)
    .bind(f64::from(SILENCE))
    .execute(pool)
    .await?;
    Ok(taken.rows_affected() == 1)
}
