//! Services that are busy, break off, or are none.

use std::convert::Infallible;
use std::process::Stdio;

use axum::Json;
use axum::http::StatusCode;
use axum::response::sse::{Event, Sse};
use axum::response::{IntoResponse, Response};
use futures::StreamExt;

use super::shell::Shell;
use super::stub::{JOB, Stub, job, problem};

/// Response with events of a job, then the end of the connection.
fn events(jobs: Vec<serde_json::Value>) -> Response {
    let events = jobs
        .into_iter()
        .map(|job| Ok::<_, Infallible>(Event::default().event("job").json_data(job).unwrap()));
    let comment = futures::stream::once(async { Ok(Event::default().comment("here")) });
    let other = futures::stream::once(async { Ok(Event::default().event("other").data("{}")) });
    Sse::new(comment.chain(other).chain(futures::stream::iter(events))).into_response()
}

#[test]
fn a_submission_is_sent_again_with_its_key() {
    let stub = Stub::start(|before, _| async move {
        match before {
            0 => problem(503, "unavailable", Some(1)),
            1 => problem(429, "limit-reached", Some(0)),
            // This is a gateway that cannot reach the service.
            2 => (StatusCode::BAD_GATEWAY, "<html>").into_response(),
            _ => (StatusCode::ACCEPTED, Json(job("accepted", 0))).into_response(),
        }
    });
    let shell = Shell::of(&stub.address);
    shell.write("request.yaml", "scene: {}\n");
    assert_eq!(shell.done("sweep request.yaml"), JOB);
    let asked = stub.asked();
    assert_eq!(asked.len(), 4);
    assert!(asked.iter().all(|one| *one == ("POST /v1/sweeps".to_owned(), asked[0].1.clone())), "{asked:?}");
    assert!(!asked[0].1.is_empty());
    shell.done("sweep request.yaml");
    assert_ne!(stub.asked()[4].1, asked[0].1, "another submission has another key");
}

#[test]
fn who_asks_for_more_patience_than_there_is_gets_none() {
    let stub = Stub::start(|_, _| async { problem(503, "unavailable", Some(60)) });
    let shell = Shell::of(&stub.address);
    let left = shell.run("ls --patience 5");
    assert!(left.code == 6 && left.err.contains("not now"), "{left:?}");
    assert_eq!(stub.asked().len(), 1);
}

/// Cancellation whose answer is lost: DELETE of a job that has ended takes its results away, unless only cancelling is asked for.
#[test]
fn a_cancellation_whose_answer_is_lost_deletes_nothing() {
    let stub = Stub::start(|before, request| async move {
        match (request.method().as_str(), request.uri().query(), before) {
            ("DELETE", _, 0) => panic!("the connection breaks"),
            ("DELETE", Some("cancel_only=true"), _) => Json(job("dismissed", 10)).into_response(),
            asked => panic!("{asked:?}"),
        }
    });
    let shell = Shell::of(&stub.address);
    assert_eq!(shell.json(&format!("cancel {JOB} --json"))["jobs"][0]["status"], "dismissed");
    assert_eq!(stub.asked().len(), 2);
}

#[test]
fn what_is_no_rubmap_is_said() {
    let stub = Stub::start(|_, request| async move {
        match request.uri().path() {
            "/v1/models" => (StatusCode::INTERNAL_SERVER_ERROR, "<h1>oops</h1>").into_response(),
            _ => Json(serde_json::json!({"hello": 1})).into_response(),
        }
    });
    let shell = Shell::of(&stub.address);
    for words in ["ls", "ls --models"] {
        let left = shell.run(words);
        assert!(left.code == 6 && left.err.contains("does not answer as a rubmap service does"), "{left:?}");
    }
}

#[test]
fn jobs_are_followed_by_their_events() {
    let stub = Stub::start(|before, request| async move {
        match (request.uri().path().ends_with("/events"), before) {
            (false, _) => Json(job("running", 10)).into_response(),
            // The stream breaks off, and goes on when it is asked for again.
            (true, 1) => events(vec![job("running", 20), job("running", 30)]),
            (true, _) => events(vec![job("running", 70), job("successful", 100)]),
        }
    });
    let shell = Shell::of(&stub.address);
    let watched = shell.json(&format!("watch {JOB} --json"));
    assert_eq!(watched["jobs"][0], job("successful", 100), "all that the service says");
    let asked: Vec<String> = stub.asked().into_iter().map(|(what, _)| what).collect();
    let path = format!("GET /v1/jobs/{JOB}");
    assert_eq!(
        asked,
        [path.clone(), format!("{path}/events"), format!("{path}/events")],
        "nothing is polled"
    );
}

#[test]
fn a_service_without_events_is_asked_again_and_again() {
    let stub = Stub::start(|before, request| async move {
        match (request.uri().path().ends_with("/events"), before) {
            (true, _) => problem(404, "not-found", None),
            (false, 0..4) => Json(job("running", 10)).into_response(),
            (false, _) => Json(job("failed", 10)).into_response(),
        }
    });
    let shell = Shell::of(&stub.address);
    assert_eq!(shell.run(&format!("watch {JOB}")).code, 4);
    assert_eq!(stub.asked().iter().filter(|(what, _)| what.ends_with("/events")).count(), 1);
}

/// Largest memory that a running process has had, kB.
fn high_water(id: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse().ok()
}

#[test]
fn an_upload_takes_no_memory_and_a_broken_one_is_said() {
    const BYTES: u64 = 400 << 20;
    let stub = Stub::start(|before, request| async move {
        let mut pieces = request.into_body().into_data_stream();
        let mut bytes = 0;
        while let Some(Ok(piece)) = pieces.next().await {
            bytes += piece.len() as u64;
            assert!(before == 0, "hangs up in the middle");
        }
        let whole = if bytes == BYTES { "invalid-package" } else { "cut-off" };
        problem(422, whole, None)
    });
    let shell = Shell::of(&stub.address);
    std::fs::File::create(shell.path("large.zip")).unwrap().set_len(BYTES).unwrap();
    let mut upload =
        shell.command("upload large.zip --patience 0 --json").stdout(Stdio::piped()).spawn().unwrap();
    let mut highest = 0;
    while upload.try_wait().unwrap().is_none() {
        highest = highest.max(high_water(upload.id()).unwrap_or_default());
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let output = upload.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(
        String::from_utf8_lossy(&output.stdout).contains("invalid-package"),
        "all of it came: {output:?}"
    );
    assert!((1..100_000).contains(&highest), "{highest} kB");

    let broken = shell.run("upload large.zip --patience 0");
    assert!(broken.code == 6 && broken.err.contains("does not answer"), "{broken:?}");
}
