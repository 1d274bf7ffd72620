//! Jobs: listing, cancelling, sharing the workers, surviving a restart.

use rubmap::store::Store;
use rubmap::store::jobs::{JobId, Unfinished};

use super::app::{TestApp, long_sweep_of, modal_analysis_of, sweep_of};
use super::model;

#[tokio::test]
async fn a_cancelled_job_stops_and_keeps_its_finished_speeds() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&long_sweep_of(&model, 200)).await;
    api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(2)).await;

    // Partial results are readable while the job runs …
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert!(map["points"].as_array().unwrap().len() >= 2);
    assert!(map["amplitude"].as_array().unwrap().last().unwrap().is_null());
    api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.problem(409, "result-not-ready");
    api.get(&format!("/v1/jobs/{id}/spectra/199")).await.problem(409, "result-not-ready");

    let cancelled = api.delete(&format!("/v1/jobs/{id}")).await;
    assert_eq!((cancelled.status.as_u16(), cancelled.text("/status")), (200, "dismissed".to_owned()));
    // A client cancels again whenever an answer is lost.
    let cancel = format!("/v1/jobs/{id}?cancel_only=true");
    for _ in 0..2 {
        assert_eq!(api.delete(&cancel).await.text("/status"), "dismissed");
    }

    // … and after it was cancelled, and the workers are free for others.
    let other = api.sweep(&sweep_of(&model)).await;
    assert_eq!(api.finish(&other).await["status"], "successful");
    let job = api.job(&id).await.body;
    assert_eq!(job["status"], "dismissed");
    assert!(job["speeds"]["finished"].as_u64().unwrap() < 200);
    assert_eq!(api.get(&format!("/v1/jobs/{id}/spectra/0")).await.status, 200);
    api.get(&format!("/v1/jobs/{id}/spectra/199")).await.problem(404, "speed-not-found");

    // The cancelled job has ended, and is deleted as other jobs are that have.
    assert!(job["stored_bytes"].as_u64() > Some(0), "{job}");
    for id in [&id, &other] {
        assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.status, 204);
        for path in ["", "/interaction-map", "/spectra/0"] {
            api.get(&format!("/v1/jobs/{id}{path}")).await.problem(404, "job-not-found");
        }
        api.delete(&format!("/v1/jobs/{id}")).await.problem(404, "job-not-found");
    }
    assert_eq!(api.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 0);
    app.stop().await;
}

#[tokio::test]
async fn a_small_job_does_not_wait_for_a_long_one() {
    let app = TestApp::start_with(|config| config.workers = Some(1)).await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let long = api.sweep(&long_sweep_of(&model, 500)).await;
    api.follow(&long, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let small = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(api.finish(&small).await["status"], "successful");
    assert_eq!(api.job(&long).await.text("/status"), "running");
    api.delete(&format!("/v1/jobs/{long}")).await;
    app.stop().await;
}

#[tokio::test]
async fn a_stopped_service_resumes_its_jobs() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    let id = app.api.sweep(&long_sweep_of(&model, 12)).await;
    app.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    app.stop().await;

    let app = TestApp::start_on(data.path()).await;
    let job = app.api.job(&id).await.body;
    assert_ne!(job["status"], "dismissed", "stopping the service cancels no job");
    let job = app.api.finish(&id).await;
    assert_eq!((&job["status"], &job["speeds"]["finished"]), (&"successful".into(), &12.into()), "{job}");
    app.stop().await;
}

#[tokio::test]
async fn the_list_is_filtered_and_comes_in_pages() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut sweeps = Vec::new();
    for _ in 0..5 {
        sweeps.push(api.sweep(&sweep_of(&model)).await);
    }
    let analysis = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    for id in sweeps.iter().chain([&analysis]) {
        api.finish(id).await;
    }

    let mut path = "/v1/jobs?limit=2&kind=sweep&status=successful".to_owned();
    let mut pages = Vec::new();
    loop {
        let page = api.get(&path).await.body;
        let jobs = page["jobs"].as_array().unwrap();
        pages.push(jobs.iter().map(|job| job["id"].as_str().unwrap().to_owned()).collect::<Vec<_>>());
        match page["next"].as_str() {
            Some(next) => path = next.to_owned(),
            None => break,
        }
    }
    assert_eq!(pages.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 1]);
    let newest_first: Vec<_> = sweeps.into_iter().rev().collect();
    assert_eq!(pages.concat(), newest_first);

    let all = api.get("/v1/jobs").await.body;
    assert_eq!(all["jobs"].as_array().unwrap().len(), 6);
    assert_eq!(all["jobs"][0]["id"], analysis);
    assert_eq!(api.get("/v1/jobs?status=failed").await.body["jobs"].as_array().unwrap().len(), 0);
    app.stop().await;
}

#[tokio::test]
async fn a_job_that_takes_the_service_down_is_given_up() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    let id = app.api.sweep(&long_sweep_of(&model, 500)).await;
    app.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    // Being told to stop is no crash, however often.
    app.stop().await;
    let job = JobId::parse(&id).unwrap();
    for crashes in 0..12 {
        let store = Store::open(data.path()).await.unwrap();
        let [Unfinished { crashes: counted, .. }] = store.unfinished_jobs().await.unwrap()[..] else {
            panic!()
        };
        assert_eq!(counted, crashes);
        // Here the process dies: nobody takes the mark away.
        std::mem::forget(store.mark_computing(job));
        store.close().await;
        let store = Store::open(data.path()).await.unwrap();
        store.count_crashes().await.unwrap();
        store.close().await;
    }
    let app = TestApp::start_on(data.path()).await;
    let job = app.api.job(&id).await.body;
    assert_eq!(job["status"], "failed", "{job}");
    assert!(job["error"]["detail"].as_str().unwrap().contains("ended 12 times"), "{job}");
    app.stop().await;
}
