//! A job as it changes (server-sent events).
//!
//! However many follow a job, it is read and written as JSON once after a change, by a task of its own that lives as long as they do.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::convert::Infallible;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::Extension;
use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use futures::{Stream, StreamExt, stream};
use tokio::sync::watch::{Receiver, Sender};
use tokio::time::sleep;

use super::extract::JobPath;
use super::jobs;
use super::problem::Problem;
use super::results::find;
use super::server::Lasting;
use super::state::AppState;
use crate::store::StoreError;
use crate::store::jobs::JobId;
use crate::tokens::Principal;

/// Least time between two events of a job: nobody reads faster.
const BETWEEN_EVENTS: Duration = Duration::from_millis(300);

/// Time between two attempts to read a job.
const BETWEEN_ATTEMPTS: Duration = Duration::from_secs(1);

/// Time without a word after which a comment is sent, so that nobody between the two takes the connection for dead.
const SILENCE: Duration = Duration::from_secs(15);

/// Jobs that somebody follows.
#[derive(Debug, Clone, Default)]
pub struct Followed {
    jobs: Arc<Mutex<HashMap<JobId, Sender<Option<Event>>>>>,
}

/// Follow a job as it changes.
///
/// Server-sent events: an event `job` at once, and after every change, but no more than three a second. Its data are what
/// `GET /v1/jobs/{id}` says of the job then, in one line. After the event of a job that has ended, or once it is deleted, the stream
/// ends; it may end before, when the service stops or has too many connections, and is asked for again. Lines that begin with a colon
/// keep the connection alive.
#[utoipa::path(get, path = "/v1/jobs/{id}/events", operation_id = "follow_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job, each time that it has changed.", body = String,
            content_type = "text/event-stream"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn follow_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Response, Problem> {
    find(&state, &whose, id).await?;
    let stopped = state.stop.clone().cancelled_owned();
    let events = told(state.followed.follow(&state, id)).take_until(stopped);
    let events = Sse::new(events).keep_alive(KeepAlive::new().interval(SILENCE));
    // nginx would keep events until it has a buffer full.
    let unbuffered = [("x-accel-buffering", "no")];
    Ok((Extension(Lasting), unbuffered, events).into_response())
}

/// What is told from here on, beginning with the latest.
fn told(mut told: Receiver<Option<Event>>) -> impl Stream<Item = Result<Event, Infallible>> {
    told.mark_changed();
    let events = stream::unfold(told, |mut told| async {
        told.changed().await.ok()?;
        let event = told.borrow_and_update().clone();
        Some((event, told))
    });
    events.filter_map(async |event| event.map(Ok))
}

impl Followed {
    fn follow(&self, state: &AppState, id: JobId) -> Receiver<Option<Event>> {
        match self.lock().entry(id) {
            Entry::Occupied(followed) => followed.get().subscribe(),
            Entry::Vacant(place) => {
                let (sender, receiver) = tokio::sync::watch::channel(None);
                let teller = Teller { followed: self.clone(), id, told: sender.clone() };
                place.insert(sender);
                tokio::spawn(teller.tell(state.clone()));
                receiver
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<JobId, Sender<Option<Event>>>> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Tells those who follow a job.
#[derive(Debug)]
struct Teller {
    followed: Followed,
    id: JobId,
    told: Sender<Option<Event>>,
}

impl Teller {
    /// Until the job has ended or is gone, or nobody follows it any more.
    async fn tell(self, state: AppState) {
        let change = state.store.changes().of(self.id);
        let mut latest = String::new();
        loop {
            match look(&state, self.id).await {
                Ok(None) => return,
                Ok(Some((job, has_ended))) => {
                    if job != latest {
                        self.told.send_replace(Some(Event::default().event("job").data(&job)));
                        latest = job;
                    }
                    if has_ended {
                        return;
                    }
                    sleep(BETWEEN_EVENTS).await;
                }
                Err(error) => {
                    tracing::warn!(job.id = %self.id, %error, "could not read a job that is followed");
                    sleep(BETWEEN_ATTEMPTS).await;
                    change.notify_one();
                }
            }
            tokio::select! {
                () = change.notified() => {}
                () = self.told.closed() => if self.leaves() { return },
            }
        }
    }

    /// Whether nobody follows the job any more; the next one who does finds another teller.
    fn leaves(&self) -> bool {
        let mut followed = self.followed.lock();
        let alone = self.told.is_closed();
        if alone {
            followed.remove(&self.id);
        }
        alone
    }
}

impl Drop for Teller {
    /// What was told last is still heard; then the streams end.
    fn drop(&mut self) {
        let mut followed = self.followed.lock();
        if followed.get(&self.id).is_some_and(|told| told.same_channel(&self.told)) {
            followed.remove(&self.id);
        }
    }
}

/// The job as JSON, and whether it has ended; `None` if it is not there any more.
async fn look(state: &AppState, id: JobId) -> Result<Option<(String, bool)>, StoreError> {
    let Some(job) = state.store.job(id).await? else { return Ok(None) };
    let has_ended = job.status.is_final();
    let job = jobs::detail(state, job).await?;
    Ok(Some((serde_json::to_string(&job)?, has_ended)))
}
