//! Health of the service: whether it lives, and whether it can work.

use axum::Json;
use axum::extract::State;
use serde::Serialize;
use tokio::time::timeout;
use utoipa::ToSchema;

use super::probe::PATIENCE;
use super::problem::{Kind, Problem, ProblemItem};
use super::server::descriptors;
use super::state::AppState;
use crate::jobs::Work;
use crate::store::StoreError;

/// Sign of life of the process.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Health {
    /// Status of the process, always `ok`.
    #[schema(example = "ok")]
    status: &'static str,
    /// Version of the program.
    version: &'static str,
    /// Memory that all reductions together may take, in bytes; absent where it is not known, and on a service with tokens, which
    /// reports it in its metrics.
    #[serde(skip_serializing_if = "Option::is_none")]
    memory_bytes: Option<u64>,
}

/// Readiness of the service: everything that was checked to find out whether it can work.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Readiness {
    #[serde(flatten)]
    health: Health,
    /// Checks of everything that is needed to work.
    checks: Vec<Check>,
}

/// Check of one thing that is needed to work.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Check {
    /// Name of the check: `database`, `disk`, `files` or `workers`.
    #[schema(example = "disk")]
    name: &'static str,
    #[serde(skip)]
    fine: bool,
    /// Finding of the check, in words.
    #[schema(example = "7516192768 bytes are free, at least 67108864 are wanted")]
    detail: String,
    /// Figure that was found, where there is one: seconds, bytes, files or queues.
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
}

impl Health {
    fn of(state: &AppState) -> Self {
        Self {
            status: "ok",
            version: crate::version::VERSION,
            memory_bytes: if state.tokens.is_none() { state.memory_bytes } else { None },
        }
    }
}

/// Report that the process lives.
#[utoipa::path(get, path = "/healthz", operation_id = "get_health", tag = "service",
    responses((status = 200, description = "The process lives.", body = Health)))]
pub(super) async fn get_health(state: State<AppState>) -> Json<Health> {
    Json(Health::of(&state))
}

/// Report whether the service can work.
///
/// The service can work if a row is written to the database and read back, the disk has room, the process has files left, and the
/// queues are being worked on.
#[utoipa::path(get, path = "/readyz", operation_id = "get_readiness", tag = "service",
    responses(
        (status = 200, description = "It can.", body = Readiness),
        (status = 503, description = "It cannot: `errors` has every check that failed.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_readiness(state: State<AppState>) -> Result<Json<Readiness>, Problem> {
    let checks = vec![database(&state).await, disk(&state).await, files(), workers(&state)];
    if checks.iter().all(|check| check.fine) {
        return Ok(Json(Readiness { health: Health::of(&state), checks }));
    }
    let failed: Vec<_> = checks.into_iter().filter(|check| !check.fine).map(Check::into_words).collect();
    tracing::error!(failed = failed.join("; "), "not ready");
    let mut problem = Problem::new(Kind::Unavailable, failed.join("; "));
    problem.errors =
        failed.into_iter().map(|detail| ProblemItem { detail, ..ProblemItem::default() }).collect();
    Err(problem)
}

impl Check {
    fn new(name: &'static str, fine: bool, detail: impl Into<String>, value: Option<f64>) -> Self {
        Self { name, fine, detail: detail.into(), value }
    }

    fn into_words(self) -> String {
        format!("{}: {}", self.name, self.detail)
    }
}

async fn database(state: &AppState) -> Check {
    match state.transport.probed.look(&state.store).await {
        Ok(took) => {
            let seconds = took.as_secs_f64();
            Check::new("database", true, "a row was written and read back", Some(seconds))
        }
        Err(detail) => Check::new("database", false, detail, None),
    }
}

/// Free bytes on the disk of the data folder.
pub(super) async fn free_bytes(state: &AppState) -> Result<u64, String> {
    let store = state.store.clone();
    let asked = tokio::task::spawn_blocking(move || store.free_bytes());
    let late = |_| format!("the disk did not answer within {} s", PATIENCE.as_secs());
    let answered: Result<u64, StoreError> =
        timeout(PATIENCE, asked).await.map_err(late)?.map_err(|error| error.to_string())?;
    answered.map_err(|error| error.to_string())
}

async fn disk(state: &AppState) -> Check {
    let wanted = state.transport.min_free_bytes;
    match free_bytes(state).await {
        Ok(free) => {
            let detail = format!("{free} bytes are free, at least {wanted} are wanted");
            Check::new("disk", free >= wanted, detail, Some(free as f64))
        }
        Err(detail) => Check::new("disk", false, detail, None),
    }
}

fn files() -> Check {
    let Some(limit) = descriptors::limit() else {
        return Check::new("files", true, "the system sets no limit of open files", None);
    };
    match descriptors::open() {
        Some(open) => {
            let free = limit.saturating_sub(open);
            let wanted = descriptors::RESERVE / 4;
            let detail = format!("{open} of {limit} files are open, at least {wanted} shall be left");
            Check::new("files", free >= wanted, detail, Some(free as f64))
        }
        None => {
            Check::new("files", false, "open files cannot be counted, perhaps because none is left", None)
        }
    }
}

fn workers(state: &AppState) -> Check {
    let Work { workers, queues, .. } = state.jobs.work();
    let detail = match queues {
        0 => "other processes compute".to_owned(),
        _ => format!("{workers} of {queues} queues are being worked on"),
    };
    Check::new("workers", workers == queues, detail, Some(f64::from(workers)))
}
