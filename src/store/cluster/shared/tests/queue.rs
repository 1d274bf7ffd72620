//! Contract of the queue that machines share.

use crate::store::contract::{begin, queue, queue_request, sweep_on, upload};
use crate::store::labels::Labels;
use crate::store::testing::stores;

#[tokio::test]
async fn a_task_of_other_numerics_is_no_work_for_a_job() {
    for store in stores().await.iter().filter(|store| store.shared_queue().is_some()) {
        let tasks = store.shared_queue().unwrap();
        upload(store, "", 'a', &Labels::default()).await;
        let job = queue(store, "", 'a', 4, &Labels::default()).await;
        let idle = async || {
            let idle = tasks.jobs_without_tasks().await.unwrap();
            idle.iter().any(|(id, _)| *id == job.to_string())
        };
        tasks.push_speeds(job, None, &[0]).await.unwrap();
        assert!(!idle().await);
        let older = "update apalis.jobs set job_type = 'speeds-0'";
        sqlx::query(older).execute(&store.writer).await.unwrap();
        assert!(idle().await);
        tasks.tidy().await.unwrap();
        let left: i64 =
            sqlx::query_scalar("select count(*) from apalis.jobs").fetch_one(&store.readers).await.unwrap();
        assert_eq!(left, 0);
        tasks.push_speeds(job, None, &[0]).await.unwrap();
        assert!(!idle().await);
    }
}

#[tokio::test]
async fn a_job_of_one_kind_says_that_it_waits_for_it() {
    for store in stores().await.iter().filter(|store| store.shared_queue().is_some()) {
        let queue = store.shared_queue().unwrap();
        upload(store, "", 'a', &Labels::default()).await;
        let [pinned, other, new] = [true, false, true].map(|one_kind| sweep_on('a', 4, one_kind));
        let pinned = queue_request(store, "", &*pinned, &Labels::default()).await;
        let other = queue_request(store, "", &*other, &Labels::default()).await;
        let new = queue_request(store, "", &*new, &Labels::default()).await;
        assert!(begin(store, pinned).await && begin(store, other).await);
        let phases = async || {
            queue.tell_who_waits().await.unwrap();
            let mut phases = Vec::new();
            for job in [pinned, other, new] {
                phases.push(store.job(job).await.unwrap().unwrap().phase.clone());
            }
            phases
        };
        let announce = r#"insert into machines (process, machine, costs, threads, seen)
             values ('one', '{"name": "m", "processor": "p", "processors": 1, "vectors": "V3"}', '{}', 1, now())"#;
        sqlx::query(announce).execute(&store.writer).await.unwrap();
        assert_eq!(phases().await, [""; 3]);
        queue.leave("one").await.unwrap();
        assert_eq!(phases().await, ["waiting for a worker with V3 vectors, on which it was begun", "", ""]);
    }
}
