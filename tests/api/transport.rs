//! Connections as clients may (mis)use them, over sockets of our own.

use std::process::Command;
use std::time::Duration;

use rubmap::config::TransportConfig;
use serde_json::Value;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::time::timeout;

use super::app::{Answer, PATIENCE, TestApp, sweep_of};
use super::model;
use super::program::Program;

/// Limit in seconds that no test reaches: what happens all the same does not happen because of it.
const NEVER: u64 = 3600;

/// Request of which the end never comes.
const HALF_A_HEAD: &str = "GET /healthz HTTP/1.1\r\nHost: local";
const TOO_LONG_A_BODY: &str = "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 3000000\r\nConnection: close\r\n\r\n{";
const HALF_A_BODY: &str = "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{";

async fn app(change: impl FnOnce(&mut TransportConfig)) -> TestApp {
    let unlimited = TransportConfig {
        head_seconds: NEVER,
        idle_seconds: NEVER,
        stall_seconds: NEVER,
        ..TransportConfig::default()
    };
    TestApp::start_with(|config| {
        config.transport = unlimited;
        change(&mut config.transport);
    })
    .await
}

/// Opens a connection, sends `text` and leaves the connection open.
async fn say(base: &str, text: &str) -> TcpStream {
    let address = base.strip_prefix("http://").unwrap();
    let mut stream = TcpStream::connect(address).await.unwrap();
    stream.write_all(text.as_bytes()).await.unwrap();
    stream
}

/// Reads until the service closes the connection.
async fn hear(mut stream: TcpStream) -> String {
    let mut heard = Vec::new();
    // A reset is an end as well.
    let _ = timeout(PATIENCE, stream.read_to_end(&mut heard)).await.expect("the connection stays open");
    String::from_utf8_lossy(&heard).into_owned()
}

/// Status and problem of an answer.
fn problem(answer: &str) -> (u16, Value) {
    let status = answer.split(' ').nth(1).unwrap_or_else(|| panic!("{answer:?}")).parse().unwrap();
    let body = answer.split_once("\r\n\r\n").unwrap().1;
    (status, serde_json::from_str(body).unwrap())
}

/// Reads one of the numbers at `/metrics`.
async fn number(app: &TestApp, name: &str) -> f64 {
    super::metrics::number(&app.api, name).await
}

#[tokio::test]
async fn clients_that_send_half_a_request_shut_nobody_out() {
    let app = app(|transport| transport.connections = 24).await;
    let mut lazy = Vec::new();
    for _ in 0..40 {
        lazy.push(say(app.api.base(), HALF_A_HEAD).await);
        lazy.push(say(app.api.base(), HALF_A_BODY).await);
    }
    // No limit of time lets anybody in.
    let answer = timeout(PATIENCE, app.api.get("/readyz")).await.expect("an honest client is shut out");
    assert_eq!(answer.status, 200, "{}", answer.body);
    assert!(number(&app, "rubmap_connections_given_up_total").await > 0.0);
    assert!(number(&app, "rubmap_connections_open").await <= 24.0);
    app.stop().await;
}

/// Lazy clients (400, with 300 open files) leave files to uploads and jobs, which once found none to open.
#[tokio::test]
async fn lazy_clients_leave_files_to_jobs() {
    let data = tempfile::tempdir().unwrap();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -n 300 && exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_rubmap")]);
    let program = Program::run(command, data.path());
    let mut lazy = Vec::new();
    for _ in 0..400 {
        lazy.push(say(program.api.base(), HALF_A_HEAD).await);
    }
    let model = program.api.model(model::package(1.0)).await;
    let id = program.api.sweep(&sweep_of(&model)).await;
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    assert_eq!(program.api.get("/readyz").await.status, 200);
}

#[tokio::test]
async fn heads_rests_and_bodies_have_their_limits() {
    let limited = app(|transport| {
        (transport.head_seconds, transport.idle_seconds, transport.stall_seconds) = (1, 1, 1);
    })
    .await;
    let base = limited.api.base();
    assert_eq!(hear(say(base, HALF_A_HEAD).await).await, "");
    assert!(
        hear(say(base, "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").await).await.contains("200 OK")
    );
    assert!(number(&limited, "rubmap_connections_overdue_heads_total").await > 0.0);
    assert!(number(&limited, "rubmap_connections_overdue_rests_total").await > 0.0);

    let upload = HALF_A_BODY.replace("/v1/sweeps", "/v1/models").replace("json", "zip");
    for half in [HALF_A_BODY, &upload] {
        let (status, problem) = problem(&hear(say(base, half).await).await);
        assert_eq!((status, &problem["type"]), (408, &"urn:rubmap:problem:upload-stalled".into()));
    }
    limited.stop().await;
}

/// Bodies that declare too great a length are refused at once; once they were waited for, and refused all the same.
#[tokio::test]
async fn a_body_that_says_it_is_too_long_is_not_waited_for() {
    let app = app(|_| {}).await;
    let (status, problem) = problem(&hear(say(app.api.base(), TOO_LONG_A_BODY).await).await);
    assert_eq!((status, &problem["type"]), (413, &"urn:rubmap:problem:payload-too-large".into()));
    app.stop().await;
}

#[tokio::test]
async fn a_trickle_is_no_progress() {
    let limited = app(|transport| (transport.head_seconds, transport.stall_seconds) = (1, 1)).await;
    for (begin, end) in [("GET /healthz HTTP/1.1\r\n", ""), (HALF_A_BODY, "408 Request Timeout")] {
        let (mut answer, mut request) = say(limited.api.base(), begin).await.into_split();
        let trickle = tokio::spawn(async move {
            while request.write_all(b"a").await.is_ok() {
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        });
        let mut heard = Vec::new();
        let _ = timeout(PATIENCE, answer.read_to_end(&mut heard)).await.expect("a trickle keeps it open");
        trickle.abort();
        let heard = String::from_utf8_lossy(&heard);
        assert!(heard.contains(end), "{heard}");
    }
    limited.stop().await;
}

#[tokio::test]
async fn a_client_that_does_not_take_its_answers_is_left() {
    let limited = app(|transport| transport.stall_seconds = 1).await;
    let request = "GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n";
    // The requests are more than the buffers between the two hold.
    let deaf = say(limited.api.base(), &request.repeat(500)).await;
    let left = async {
        while number(&limited, "rubmap_connections_overdue_answers_total").await == 0.0 {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    timeout(PATIENCE, left).await.expect("it keeps its connection");
    drop(deaf);
    limited.stop().await;
}

#[tokio::test]
async fn a_client_may_say_all_it_has_to_say_and_listen() {
    let app = app(|_| {}).await;
    let mut stream = say(app.api.base(), "GET /readyz HTTP/1.1\r\nHost: localhost\r\n\r\n").await;
    stream.shutdown().await.unwrap();
    assert!(hear(stream).await.starts_with("HTTP/1.1 200 OK\r\n"));
    app.stop().await;
}

#[tokio::test]
async fn a_request_is_meant_for_one_host_and_for_this_one() {
    let local = app(|transport| transport.hosts = vec!["rubmap.example".to_owned()]).await;
    let ask = |version: &str, hosts: &[&str]| {
        let hosts: String = hosts.iter().map(|host| format!("Host: {host}\r\n")).collect();
        let request = format!("GET /v1/jobs HTTP/{version}\r\n{hosts}Connection: close\r\n\r\n");
        let base = local.api.base().to_owned();
        async move { hear(say(&base, &request).await).await }
    };
    for (hosts, expected, kind) in [
        (&[][..], 400, "bad-request"),
        (&["localhost", "localhost"], 400, "bad-request"),
        (&["rubmap.example", "evil.example"], 400, "bad-request"),
        (&["not a host"], 400, "bad-request"),
        (&[&"a".repeat(254)], 400, "bad-request"),
        (&["evil.example"], 421, "misdirected-request"),
        (&["localhost.evil.example:8080"], 421, "misdirected-request"),
    ] {
        let (status, problem) = problem(&ask("1.1", hosts).await);
        assert_eq!((status, problem["status"].as_u64()), (expected, Some(expected.into())), "{hosts:?}");
        assert_eq!(problem["type"], format!("urn:rubmap:problem:{kind}"), "{hosts:?}");
        assert_eq!(problem["instance"], "/v1/jobs");
    }
    for host in ["localhost", "127.0.0.1:8080", "[::1]:80", "rubmap.example", "RUBMAP.example:443"] {
        assert!(ask("1.1", &[host]).await.starts_with("HTTP/1.1 200"), "{host}");
    }
    assert!(ask("1.0", &[]).await.starts_with("HTTP/1.0 200"), "HTTP/1.0 knows no Host");
    assert_eq!(problem(&ask("1.0", &["evil.example"]).await).0, 421);
    let absolute = "GET http://evil.example/v1/jobs HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    assert_eq!(problem(&hear(say(local.api.base(), absolute).await).await).0, 421);
    local.stop().await;
}

#[tokio::test]
async fn open_connections_do_not_delay_a_stop() {
    let app = app(|_| {}).await;
    let request = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
    let mut open = Vec::new();
    for text in ["", HALF_A_HEAD, HALF_A_BODY, request, &request.repeat(3)] {
        open.push(say(app.api.base(), text).await);
    }
    // All are known to the service once a later one has its answer.
    assert_eq!(app.api.get("/healthz").await.status, 200);
    timeout(PATIENCE, app.stop()).await.expect("the service waits for its clients");
}

#[tokio::test]
async fn answers_say_what_browsers_and_logs_need() {
    let app = app(|transport| transport.cors_origins = vec!["https://tools.example".parse().unwrap()]).await;
    let ask = |method: &str, path: &str, header: &str, value: &str| {
        let request = app.api.request(method, path).header(header, value);
        async move { request.send().await.unwrap() }
    };
    let text = |response: &reqwest::Response, name: &str| {
        response.headers().get(name).map(|value| value.to_str().unwrap().to_owned())
    };
    for path in ["/healthz", "/v1/models/none", "/nothing"] {
        let answer = ask("GET", path, "x-request-id", "my-request.7").await;
        assert_eq!(text(&answer, "x-content-type-options").as_deref(), Some("nosniff"), "{path}");
        assert_eq!(text(&answer, "x-request-id").as_deref(), Some("my-request.7"), "{path}");
        assert_eq!(text(&answer, "access-control-allow-origin"), None, "{path}");
    }
    let long = "a".repeat(65);
    let replaced = text(&ask("GET", "/healthz", "x-request-id", &long).await, "x-request-id").unwrap();
    assert_eq!(uuid::Uuid::parse_str(&replaced).unwrap().get_version_num(), 7);

    let allowed = |response: &reqwest::Response| text(response, "access-control-allow-origin");
    let page = ask("GET", "/healthz", "origin", "https://tools.example").await;
    assert_eq!(allowed(&page).as_deref(), Some("https://tools.example"));
    assert_eq!(allowed(&ask("GET", "/healthz", "origin", "https://evil.example").await), None);
    let preflight = app.api.request("OPTIONS", "/v1/sweeps").header("access-control-request-method", "POST");
    let preflight = preflight.header("origin", "https://tools.example").send().await.unwrap();
    assert_eq!(preflight.status(), 200);
    assert!(text(&preflight, "access-control-allow-headers").unwrap().contains("idempotency-key"));
    assert!(text(&preflight, "access-control-allow-methods").unwrap().contains("PATCH"));
    app.stop().await;
}

#[tokio::test]
async fn by_default_no_page_of_others_reads_an_answer() {
    let app = TestApp::start().await;
    let request = app.api.request("GET", "/healthz").header("origin", "https://tools.example");
    let answer = request.send().await.unwrap();
    assert!(answer.headers().keys().all(|name| !name.as_str().starts_with("access-control-allow")));
    // OPTIONS is no method here: a page does not even learn whether it may ask.
    let preflight = app
        .api
        .request("OPTIONS", "/v1/sweeps")
        .header("origin", "https://tools.example")
        .header("access-control-request-method", "POST");
    Answer::of(preflight.send().await.unwrap()).await.problem(405, "method-not-allowed");
    app.stop().await;
}

/// Requests from a page of another site, which need no preflight, may not pause, continue or delete jobs of a service without tokens.
#[tokio::test]
async fn pages_of_other_sites_change_nothing() {
    let app = app(|transport| transport.cors_origins = vec!["https://tools.example".parse().unwrap()]).await;
    let ask = async |method: &str, path: &str, headers: &[(&str, &str)]| {
        let mut request = app.api.request(method, path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        Answer::of(request.send().await.unwrap()).await
    };
    let evil = [("origin", "https://evil.example"), ("sec-fetch-site", "cross-site")];
    for (method, path) in [
        ("POST", "/v1/jobs/none/pause"),
        ("POST", "/v1/jobs/none/continue"),
        ("DELETE", "/v1/jobs/none"),
        ("POST", "/v1/sweeps"),
        ("PATCH", "/v1/models/none"),
    ] {
        ask(method, path, &evil).await.problem(403, "cross-site");
        ask(method, path, &evil[..1]).await.problem(403, "cross-site");
    }
    for headers in [
        &[][..],
        &[("sec-fetch-site", "same-origin"), ("origin", "https://behind-a-proxy.example")],
        &[("sec-fetch-site", "cross-site"), ("origin", "https://tools.example")],
    ] {
        ask("POST", "/v1/jobs/none/pause", headers).await.problem(404, "job-not-found");
    }
    ask("GET", "/v1/jobs/none", &evil).await.problem(404, "job-not-found");
    app.stop().await;
}
