//! Rate of tasks that the queue hands out, to workers that do nothing with them.

use std::time::{Duration, Instant};

use sqlx::postgres::PgPoolOptions;
use sqlx::{Executor, PgPool};

/// Time of each measurement.
const TIME: Duration = Duration::from_secs(5);

/// Statements of the queue's crate for every task: this one takes the next, [`DONE`] says how it went.
const TAKE: &str = "select id from apalis.get_jobs($1, 'bench', 1)";
const DONE: &str = "update apalis.jobs set status = 'Done', done_at = now() where id = $1 and lock_by = $2";

/// Measures the rate for so many connections at once and so many tasks that wait.
pub(crate) async fn measure(url: &str) {
    rubmap::store::migrate(url).await.unwrap();
    let pool = PgPoolOptions::new()
        .max_connections(64)
        .after_connect(|connection, _| {
            Box::pin(
                async move { connection.execute(rubmap::store::cluster::queue::TAKE_ONE).await.map(drop) },
            )
        })
        .connect(url)
        .await
        .unwrap();
    for waiting in [1_000, 100_000] {
        for workers in [1, 8, 64] {
            let claims = claims(&pool, workers, waiting).await;
            println!("claims: {workers} workers, {waiting} tasks waiting: {claims:.0} a second");
        }
    }
}

async fn claims(pool: &PgPool, workers: usize, waiting: i64) -> f64 {
    pool.execute("delete from apalis.jobs where job_type = 'bench'").await.unwrap();
    sqlx::query(
        "insert into apalis.workers (id, worker_type, storage_name, layers, last_seen)
         select 'bench-' || n, 'bench', 'bench', '', now() from generate_series(0, 63) as n
         on conflict (id) do nothing",
    )
    .execute(pool)
    .await
    .unwrap();
    fill(pool, waiting).await;
    pool.execute("vacuum analyze apalis.jobs").await.unwrap();
    let begin = Instant::now();
    let workers = (0..workers).map(|k| {
        let (pool, name) = (pool.clone(), format!("bench-{k}"));
        tokio::spawn(async move {
            let (mut taken, mut connection) = (0u32, pool.acquire().await.unwrap());
            while begin.elapsed() < TIME {
                let task: Option<String> =
                    sqlx::query_scalar(TAKE).bind(&name).fetch_optional(&mut *connection).await.unwrap();
                let Some(task) = task else { break };
                sqlx::query(DONE).bind(&task).bind(&name).execute(&mut *connection).await.unwrap();
                taken += 1;
            }
            taken
        })
    });
    let taken: u32 = futures::future::join_all(workers).await.into_iter().map(Result::unwrap).sum();
    f64::from(taken) / begin.elapsed().as_secs_f64()
}

async fn fill(pool: &PgPool, waiting: i64) {
    sqlx::query(
        "insert into apalis.jobs (id, job, job_type, status, attempts, max_attempts, run_at, priority)
         select 'bench-' || n, '{}', 'bench', 'Pending', 0, 1000, now() - interval '1 day', 1000000 - n
         from generate_series(1, $1) as n",
    )
    .bind(waiting)
    .execute(pool)
    .await
    .unwrap();
}
