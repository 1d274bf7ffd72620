//! Contract of the store for several processes that write at once. On `SQLite` they are one process, as a data folder allows no more.

use futures::future::join_all;

use super::{begin, keep, labels, model_id, queue, queue_request, result, sweep, sweep_on, upload};
use crate::analysis::kinds::sweep::ERRORS;
use crate::analysis::run::REVISION;
use crate::store::Store;
use crate::store::dialect::Dialect;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Insertion, JobDeletion, JobId, NewJob};
use crate::store::labels::Labels;
use crate::store::limits::{LimitReached, Limits};
use crate::store::models::Deletion;
use crate::store::status::JobStatus;
use crate::store::testing::stores;

/// Number of processes.
const PROCESSES: usize = 4;

#[tokio::test(flavor = "multi_thread")]
async fn every_speed_counts_once() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        upload(&store, "", 'a', &Labels::default()).await;
        let job = queue(&store, "", 'a', 16, &Labels::default()).await;
        assert!(
            join_all(processes.iter().map(|store| begin(store, job))).await.into_iter().all(|begun| begun)
        );
        // Two processes store each speed.
        let speeds = (0..32).map(|i: u32| (&processes[i as usize % PROCESSES], result((i + i / 16) % 16)));
        join_all(speeds.map(async |(store, result)| keep(store, job, &result).await)).await;
        let done = store.job(job).await.unwrap().unwrap();
        assert_eq!((done.speeds.finished, store.finished_speeds(job).await.unwrap().len()), (16, 16));
        let apart = store.processes(1).await;
        let alone = queue(&apart[0], "", 'a', 16, &Labels::default()).await;
        for speed in 0..16 {
            keep(&apart[0], alone, &result(speed)).await;
        }
        let alone = apart[0].job(alone).await.unwrap().unwrap();
        assert_eq!(done.stored_bytes, alone.stored_bytes);
        close(processes.into_iter().chain(apart)).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_ends_once() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        upload(&store, "", 'a', &Labels::default()).await;
        for _ in 0..8 {
            let job = queue(&store, "", 'a', 4, &Labels::default()).await;
            assert!(begin(&store, job).await);
            let document = [(ERRORS, "[1]".to_owned())];
            let last = result(3);
            let (done, also_done, dismissed, last) = tokio::join!(
                processes[0].complete_job(job, &document, None),
                processes[1].complete_job(job, &document, None),
                processes[2].dismiss_job(job),
                keep(&processes[3], job, &last),
            );
            let done = [done.unwrap(), also_done.unwrap()].iter().filter(|&&done| done).count();
            let status = store.job(job).await.unwrap().unwrap().status;
            let expected = if done == 1 { JobStatus::Successful } else { JobStatus::Dismissed };
            assert_eq!((status, dismissed.unwrap(), last), (expected, Some(expected), Some(1)));
            assert!(done < 2);
            assert_eq!(store.end_state(job, 3).await.unwrap(), None, "it has ended");
        }
        close(processes).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn limits_hold_for_all_processes() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        upload(&store, "eve", 'a', &Labels::default()).await;
        let limits = Limits { queued_speeds: Some(5), ..Limits::default() };
        let facts = super::facts("m");
        let request = sweep('a', 2);
        let insert = async |store: &Store| {
            let labels = labels("n", &[]);
            let (id, request, facts) = (JobId::new(), &*request, Some(&facts));
            let new = NewJob { id, owner: "eve", request, posted: None, labels: &labels, facts };
            store.insert_job(new, limits, None).await
        };
        let inserted = join_all((0..12).map(|i| insert(&processes[i % PROCESSES]))).await;
        let accepted = inserted.iter().filter(|one| matches!(one, Ok(Insertion::Accepted))).count();
        let refused = inserted
            .iter()
            .filter(|one| matches!(one, Ok(Insertion::Limit(LimitReached::QueuedSpeeds { queued: 4, .. }))))
            .count();
        assert_eq!((accepted, refused), (2, 10), "{inserted:?}");
        close(processes).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn models_within_a_limit_are_counted_by_all_processes() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        let limits = Limits { models: Some(2), ..Limits::default() };
        let insert = async |store: &Store, letter: char| {
            let upload = store.new_upload().await.unwrap().into_temp_path();
            std::fs::write(&upload, "package").unwrap();
            let (id, facts) = (model_id(letter), super::facts("m"));
            let inserted =
                store.insert_model(("eve", limits), &id, &facts, &Labels::default(), &upload).await;
            match inserted.unwrap() {
                Ok(_) => true,
                Err(LimitReached::Models { models: 2, limit: 2 }) => false,
                Err(other) => panic!("{other:?}"),
            }
        };
        let inserted =
            join_all(processes.iter().zip("abcd".chars()).map(|(store, letter)| insert(store, letter))).await;
        assert_eq!(inserted.iter().filter(|&&accepted| accepted).count(), 2);
        close(processes).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_key_is_taken_once() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        upload(&store, "eve", 'a', &Labels::default()).await;
        let (request, facts) = (sweep('a', 2), super::facts("m"));
        let insert = async |store: &Store| {
            let id = JobId::new();
            let text = |text: &str| text.to_owned();
            let (owner, key, fingerprint, body) = (text("eve"), text("k"), text("f"), text("{}"));
            let answer =
                Answer { owner, key, fingerprint, status: 202, location: format!("/v1/jobs/{id}"), body };
            let (labels, request, facts) = (Labels::default(), &*request, Some(&facts));
            let new = NewJob { id, owner: "eve", request, posted: None, labels: &labels, facts };
            store.insert_job(new, Limits::default(), Some(&answer)).await
        };
        let inserted = join_all((0..8).map(|i| insert(&processes[i % PROCESSES]))).await;
        let count = |what| inserted.iter().filter(|one| one.as_ref().unwrap() == &what).count();
        assert_eq!((count(Insertion::Accepted), count(Insertion::KeyTaken)), (1, 7), "{inserted:?}");
        close(processes).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn no_job_is_left_without_its_model() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        let (facts, request) = (super::facts("m"), sweep('a', 2));
        for _ in 0..8 {
            upload(&store, "", 'a', &Labels::default()).await;
            let id = JobId::new();
            let (labels, model) = (Labels::default(), model_id('a'));
            let (request, facts) = (&*request, Some(&facts));
            let new = NewJob { id, owner: "", request, posted: None, labels: &labels, facts };
            let (inserted, deleted) = tokio::join!(
                processes[0].insert_job(new, Limits::default(), None),
                processes[1].delete_model(&model, None),
            );
            match (inserted.unwrap(), deleted.unwrap()) {
                (Insertion::Accepted, Deletion::InUse(1)) | (Insertion::UnknownModel, Deletion::Deleted) => {}
                both => panic!("{both:?}"),
            }
            store.dismiss_job(id).await.unwrap();
        }
        close(processes).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn deleted_jobs_go_once_and_whole() {
    for store in stores().await {
        let processes = store.processes(PROCESSES).await;
        upload(&store, "", 'a', &Labels::default()).await;
        let job = queue(&store, "", 'a', 200, &Labels::default()).await;
        for speed in 0..200 {
            keep(&store, job, &result(speed)).await;
        }
        store.dismiss_job(job).await.unwrap();
        let deleted = join_all(processes.iter().map(|store| store.delete_job(job))).await;
        let count = |what| deleted.iter().filter(|one| one.as_ref().unwrap() == &what).count();
        assert_eq!((count(JobDeletion::Deleted), count(JobDeletion::Unknown)), (1, PROCESSES - 1));
        for purged in join_all(processes.iter().map(Store::purge)).await {
            purged.unwrap();
        }
        assert!(store.finished_speeds(job).await.unwrap().is_empty());
        close(processes).await;
    }
}

#[tokio::test]
async fn numerics_do_not_mix_within_a_job() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let job = queue(&store, "", 'a', 4, &Labels::default()).await;
        assert!(begin(&store, job).await);
        assert_eq!(keep(&store, job, &result(0)).await, Some(1));
        let is_of = async |revision: u32| {
            let update = "update jobs set revision = $1";
            sqlx::query(update).bind(i64::from(revision)).execute(&store.writer).await.unwrap();
        };
        let kept = async || store.finished_speeds(job).await.unwrap().len();
        for other in [REVISION - 1, REVISION + 1] {
            is_of(other).await;
            assert!(!begin(&store, job).await, "it is not ours");
            assert_eq!(keep(&store, job, &result(1)).await, Some(1), "nor what we computed for it");
            assert_eq!(kept().await, 1);
        }
        // Later programs may run on a server; a data folder belongs to one program, which may also be an older one that came back.
        store.restart_outdated().await.unwrap();
        assert_eq!(kept().await, usize::from(store.dialect == Dialect::Postgres));
        is_of(REVISION - 1).await;
        store.restart_outdated().await.unwrap();
        assert_eq!(kept().await, 0);
        assert!(begin(&store, job).await);
        assert_eq!(keep(&store, job, &result(1)).await, Some(1));
    }
}

#[tokio::test]
async fn kinds_of_processors_do_not_mix_within_a_job_that_asks_for_one() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let computed_on = |vectors: &str, index| {
            let mut result = result(index);
            result.point.vectors = Some(vectors.to_owned());
            result
        };
        for (one_kind, kept) in [(true, 1), (false, 2)] {
            let request = sweep_on('a', 4, one_kind);
            let job = queue_request(&store, "", &*request, &Labels::default()).await;
            assert!(begin(&store, job).await, "on V3");
            assert_eq!(keep(&store, job, &computed_on("V3", 0)).await, Some(1));
            assert_eq!(keep(&store, job, &computed_on("V4", 1)).await, Some(kept));
        }
    }
}

async fn close(stores: impl IntoIterator<Item = Store>) {
    for store in stores {
        store.close().await;
    }
}
