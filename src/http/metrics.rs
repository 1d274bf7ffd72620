//! Metrics of the service, as Prometheus reads them.

use std::fmt::Debug;
use std::sync::atomic::Ordering;

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use prometheus_client::encoding::{EncodeMetric, text};
use prometheus_client::metrics::TypedMetric;
use prometheus_client::metrics::counter::ConstCounter;
use prometheus_client::metrics::gauge::ConstGauge;
use prometheus_client::registry::Registry;
use tokio::time::timeout;

use super::problem::{Kind, Problem};
use super::request_metrics::PREFIX;
use super::server::descriptors;
use super::state::AppState;
use super::{health, probe};

/// Media type of an answer with metrics.
const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// Metrics that are read at the moment of the request.
struct Snapshot(Registry);

impl Snapshot {
    fn gauge(&mut self, name: &str, help: &str, value: u64) {
        self.register(name, help, ConstGauge::new(value));
    }

    fn counter(&mut self, name: &str, help: &str, value: u64) {
        self.register(name, help, ConstCounter::new(value));
    }

    fn register(
        &mut self,
        name: &str,
        help: &str,
        metric: impl EncodeMetric + TypedMetric + Debug + Send + Sync + 'static,
    ) {
        self.0.register(name, help, metric);
    }
}

/// Read the metrics of the service.
///
/// The answer is in the text format of `OpenMetrics`, which Prometheus reads. A metric that cannot be read at the moment is left out.
#[utoipa::path(get, path = "/metrics", operation_id = "get_metrics", tag = "service",
    responses((status = 200, description = "The numbers.", body = String,
        content_type = "application/openmetrics-text")))]
pub(super) async fn get_metrics(state: State<AppState>) -> Result<Response, Problem> {
    let now = snapshot(&state).await;
    let mut written = String::new();
    text::encode_registry(&mut written, &state.transport.metrics.registry)
        .and_then(|()| text::encode_registry(&mut written, &now.0))
        .and_then(|()| text::encode_eof(&mut written))
        .map_err(|error| {
            tracing::error!(%error, "could not write the metrics");
            Problem::new(Kind::Internal, "a defect of the program; the service's log says more")
        })?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], written).into_response())
}

async fn snapshot(state: &AppState) -> Snapshot {
    let mut now = Snapshot(Registry::with_prefix(PREFIX));
    let transport = &state.transport;
    now.gauge("uptime_seconds", "Time since the start", transport.metrics.begin.elapsed().as_secs());

    let connections = &transport.connections;
    now.gauge("connections_open", "Connections open", connections.open.load(Ordering::Relaxed) as u64);
    now.gauge("connections_limit", "Connections that may be open", transport.limits.connections as u64);
    for (name, help, counter) in [
        ("connections_accepted", "Connections accepted", &connections.accepted),
        (
            "connections_overdue_heads",
            "Connections closed because a request did not come",
            &connections.overdue_heads,
        ),
        ("connections_overdue_rests", "Connections closed after a rest", &connections.overdue_rests),
        (
            "connections_overdue_answers",
            "Connections closed because an answer was not taken",
            &connections.overdue_answers,
        ),
        ("connections_given_up", "Connections closed to make room for others", &connections.given_up),
    ] {
        now.counter(name, help, counter.load(Ordering::Relaxed));
    }

    if let Some(open) = descriptors::open() {
        now.gauge("open_files", "Files open in this process", open);
    }
    if let Some(limit) = descriptors::limit() {
        now.gauge("open_files_limit", "Files that may be open in this process", limit);
    }
    if let Ok(free) = health::free_bytes(state).await {
        now.gauge("disk_free_bytes", "Room on the disk of the data folder", free);
    }

    now.gauge(
        "answers_waiting_bytes",
        "Parts of answers that wait in files for slow clients",
        state.answers.spooled_bytes(),
    );

    let work = state.jobs.work();
    now.gauge("workers", "Queues that are being worked on", u64::from(work.workers));
    now.gauge("queues", "Queues that shall be worked on", u64::from(work.queues));
    now.gauge("threads", "Threads that compute", work.threads as u64);
    now.gauge("speeds_running", "Speeds being computed", work.speeds_running);
    now.counter("speeds_finished", "Speeds finished since the start", work.speeds_finished);
    now.counter("steps", "Time steps of the speeds finished since the start", work.steps);
    now.gauge("memory_claimed_bytes", "Memory claimed by computations", work.memory_claimed_bytes);
    if let Some(budget) = state.memory_bytes {
        now.gauge("memory_budget_bytes", "Memory that computations may claim together", budget);
    }
    match timeout(probe::PATIENCE, state.store.backlog()).await {
        Ok(Ok(backlog)) => {
            now.gauge("jobs_accepted", "Jobs that wait for their turn", backlog.jobs_accepted);
            now.gauge("jobs_running", "Jobs under way", backlog.jobs_running);
            now.gauge(
                "speeds_waiting",
                "Speeds of these jobs that are not finished",
                backlog.speeds_unfinished,
            );
        }
        Ok(Err(error)) => tracing::warn!(%error, "no numbers of the queue"),
        Err(_) => tracing::warn!("no numbers of the queue within {} s", probe::PATIENCE.as_secs()),
    }
    now
}
