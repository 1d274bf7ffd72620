//! Events of a job as it changes (server-sent events).
//!
//! However many clients follow a job, it is read and written as JSON once after a change, by a task of its own that lives as long
//! as any of them follows.

use std::convert::Infallible;
use std::time::Duration;

use axum::Extension;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use futures::{Stream, StreamExt, stream};
use tokio::sync::watch::Receiver;
use tokio::time::sleep;
use utoipa::ToSchema;

use super::extract::JobPath;
use super::followed::Teller;
use super::jobs;
use super::principal::bearer;
use super::problem::Problem;
use super::results::find;
use super::server::Lasting;
use super::state::AppState;
use crate::store::StoreError;
use crate::store::jobs::{Job, JobId};
use crate::tokens::{Principal, Tokens};

/// Least time between two events of a job: nobody reads faster.
const BETWEEN_EVENTS: Duration = Duration::from_millis(334);

/// Time between two attempts to read a job.
const BETWEEN_ATTEMPTS: Duration = Duration::from_secs(1);

/// Time between two checks of the token of a stream: with the second that changes of the token file take, less than 5 s.
const BETWEEN_TOKEN_LOOKS: Duration = Duration::from_secs(3);

/// Time without an event after which a comment is sent, so that no proxy takes the connection for dead.
const SILENCE: Duration = Duration::from_secs(15);

/// Event of a job that is followed.
#[derive(ToSchema)]
#[expect(dead_code, reason = "says what a stream has, which is not written from it")]
struct JobEvent {
    /// Name of the event: `job`.
    event: String,
    /// Answer of `GET /v1/jobs/{id}` at the time of the event without the posted request, as JSON in one line.
    data: String,
}

/// Follow a job as it changes.
///
/// Server-sent events: an event `job` at once and after every change, but no more than three a second. The data of an event are the
/// answer of `GET /v1/jobs/{id}` at that time without `posted` and `posted_to`, in one line. The stream ends after the event of a job that has ended, and once the
/// job is deleted. It may end before, when the service stops, has too many connections or does not know the token any more; the
/// client then asks for it again. Lines that begin with a colon keep the connection alive.
#[utoipa::path(get, path = "/v1/jobs/{id}/events", operation_id = "follow_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job, each time that it has changed.", body = JobEvent,
            content_type = "text/event-stream"),
    ))]
pub(super) async fn follow_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    find(&state, &whose, id).await?;
    let stopped = state.stop.clone().cancelled_owned();
    let withdrawn = withdrawn(state.tokens.clone(), bearer(&headers).map(str::to_owned), whose);
    let (news, teller) = state.followed.follow(id);
    if let Some(teller) = teller {
        tokio::spawn(tell(state.0.clone(), teller));
    }
    let events = told(news).take_until(stopped).take_until(withdrawn);
    let events = Sse::new(events).keep_alive(KeepAlive::new().interval(SILENCE));
    // nginx would keep events until it has a buffer full.
    let unbuffered = [("x-accel-buffering", "no")];
    Ok((Extension(Lasting), unbuffered, events).into_response())
}

/// Ends once `token` does not belong to `whose` any more; never on a service without tokens.
async fn withdrawn(tokens: Option<Tokens>, token: Option<String>, whose: Principal) {
    let (Some(tokens), Some(token)) = (tokens, token) else { return std::future::pending().await };
    while tokens.principal(&token).as_ref() == Some(&whose) {
        sleep(BETWEEN_TOKEN_LOOKS).await;
    }
}

/// Stream of the events of a job from here on, beginning with the latest.
fn told(mut told: Receiver<Option<Event>>) -> impl Stream<Item = Result<Event, Infallible>> {
    told.mark_changed();
    let events = stream::unfold(told, |mut told| async {
        told.changed().await.ok()?;
        let event = told.borrow_and_update().clone();
        Some((event, told))
    });
    events.filter_map(async |event| event.map(Ok))
}

/// Sends the events of a job to those who follow it, until the job has ended or is gone, or nobody follows it any more.
async fn tell(state: AppState, teller: Teller) {
    let change = state.store.changes().of(teller.id());
    let mut latest = String::new();
    loop {
        match look(&state, teller.id()).await {
            Ok(None) => return,
            Ok(Some((job, has_ended))) => {
                if job != latest {
                    teller.tell(Event::default().event("job").data(&job));
                    latest = job;
                }
                if has_ended {
                    return;
                }
                sleep(BETWEEN_EVENTS).await;
            }
            Err(error) => {
                tracing::warn!(job.id = %teller.id(), %error, "could not read a job that is followed");
                sleep(BETWEEN_ATTEMPTS).await;
                change.notify_one();
            }
        }
        tokio::select! {
            () = change.notified() => {}
            () = teller.alone() => if teller.leaves() { return },
        }
    }
}

/// Reads the job as JSON, and whether it has ended; `None` if the job is gone.
async fn look(state: &AppState, id: JobId) -> Result<Option<(String, bool)>, StoreError> {
    let Some(job) = state.store.job(id).await? else { return Ok(None) };
    let has_ended = job.status.is_final();
    // The posted request may be large and never changes: it is not sent again with every step of the job.
    let job = jobs::detail(state, Job { posted: None, ..job }).await?;
    Ok(Some((serde_json::to_string(&job)?, has_ended)))
}
