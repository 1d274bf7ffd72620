//! Database with a million stored speeds: its size, and how long a map and a listing take beside them.

use std::time::Instant;

use sqlx::PgPool;
use sqlx::postgres::PgPoolOptions;

use super::app::Api;
use super::postgres::Postgres;
use super::{Cluster, TIMES, model, sweep};

/// Speeds of each job.
const SPEEDS: u32 = 500;

/// Number of copies of the job that is computed.
const JOBS: i32 = 2_000;

/// Number of requests whose median is reported.
const REQUESTS: usize = 21;

pub(crate) async fn measure(database: &Postgres) {
    let cluster = Cluster::start(database, 2);
    let api = &cluster.service.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&sweep(&model, SPEEDS, 12)).await;
    api.finish(&id).await;
    let pool = PgPoolOptions::new().connect(&database.url()).await.unwrap();
    told(api, &pool, &id).await;
    multiply(&pool, &id).await;
    told(api, &pool, &id).await;
}

/// Copies a job with all its speeds.
async fn multiply(pool: &PgPool, id: &str) {
    let begin = Instant::now();
    let named = "jsonb_build_object($2::text, left($1, 24) || lpad(to_hex(n), 12, '0'))";
    for (table, column) in [("jobs", "id"), ("speed_results", "job"), ("documents", "job")] {
        let copy = format!(
            "insert into {table} select (jsonb_populate_record(one, {named})).*
             from {table} as one, generate_series(1, $3) as n where one.{column} = $1"
        );
        sqlx::query(sqlx::AssertSqlSafe(copy))
            .bind(id)
            .bind(column)
            .bind(JOBS - 1)
            .execute(pool)
            .await
            .unwrap();
    }
    println!("stored: copied in {:.0} s", begin.elapsed().as_secs_f64());
}

async fn told(api: &Api, pool: &PgPool, id: &str) {
    let count: i64 = sqlx::query_scalar("select count(*) from speed_results").fetch_one(pool).await.unwrap();
    let size: i64 =
        sqlx::query_scalar("select pg_database_size(current_database())").fetch_one(pool).await.unwrap();
    println!("stored: {count} speeds, {:.1} MB", size as f64 / 1e6);
    for (what, path) in [
        ("map", format!("/v1/jobs/{id}/interaction-map")),
        ("one speed", format!("/v1/jobs/{id}/spectra/7")),
        ("100 jobs", "/v1/jobs?limit=100".to_owned()),
        ("jobs of a name that none has", "/v1/jobs?limit=100&name=nothing".to_owned()),
    ] {
        let mut seconds = Vec::new();
        for _ in 0..REQUESTS.max(TIMES) {
            let begin = Instant::now();
            let answer = api.get(&path).await;
            assert_eq!(answer.status, 200, "{path}: {}", answer.body);
            seconds.push(begin.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        println!("stored:   {what}: {:.1} ms", 1e3 * seconds[seconds.len() / 2]);
    }
}
