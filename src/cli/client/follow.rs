//! Following a job to its end: by its events, or by asking again and again where the service has none.

use std::future::ready;
use std::time::Duration;

use futures::{Stream, StreamExt};
use reqwest::Method;
use sse_stream::{Sse, SseByteStream};
use tokio::time::timeout;

use super::answer::Answer;
use super::error::ClientError;
use super::http::Client;
use super::job::Job;

/// Time between two looks at a job, and before events that broke off are asked for again.
const INTERVAL: Duration = Duration::from_millis(200);

/// Silence after which a connection without an event is made anew, as nothing tells whether it is still there. Keep-alive
/// comments are no events; a job that computes changes more often, and one that waits is reported again at once.
const SILENCE: Duration = Duration::from_secs(60);

impl Client {
    /// Follows a job to its end, whatever that is; `seen` gets the job at once and whenever it has changed.
    ///
    /// # Errors
    /// [`ClientError`].
    pub(in crate::cli) async fn follow(
        &self,
        id: &str,
        mut seen: impl FnMut(&Job),
    ) -> anyhow::Result<Answer<Job>> {
        let mut has_events = true;
        loop {
            let events = if has_events { self.events(id).await? } else { None };
            let ended = match events {
                Some(events) => last(events, &mut seen).await,
                None => {
                    has_events = false;
                    let job = self.job(id).await?;
                    seen(&job);
                    Some(job).filter(|job| job.status.is_final())
                }
            };
            match ended {
                Some(job) => return Ok(job),
                None => tokio::time::sleep(INTERVAL).await,
            }
        }
    }

    /// Events of a job, from `GET /v1/jobs/{id}/events`, if the service has it: the job at once and after every change.
    async fn events(&self, id: &str) -> anyhow::Result<Option<impl Stream<Item = Answer<Job>> + Unpin>> {
        let path = format!("/v1/jobs/{id}/events");
        let request = || self.request(Method::GET, &path).header("accept", "text/event-stream");
        let response = match self.patiently(|| async { self.send(request()).await }).await {
            Err(error) if error.downcast_ref().is_some_and(ClientError::is_no_route) => return Ok(None),
            response => response?,
        };
        let events = SseByteStream::new(response.bytes_stream());
        // Events that break off are asked for again.
        let events = events.take_while(|event| ready(event.is_ok()));
        Ok(Some(events.filter_map(|event| ready(event.ok().as_ref().and_then(job)))))
    }
}

/// Job that an event carries.
fn job(event: &Sse) -> Option<Answer<Job>> {
    let data = event.data.as_ref().filter(|_| event.event.as_deref() == Some("job"))?;
    serde_json::from_str(data).ok()
}

/// Job of the last event, when it has ended; `None` if the events end before, or fall silent.
async fn last(
    mut events: impl Stream<Item = Answer<Job>> + Unpin,
    seen: &mut impl FnMut(&Job),
) -> Option<Answer<Job>> {
    while let Some(job) = timeout(SILENCE, events.next()).await.ok()? {
        seen(&job);
        if job.status.is_final() {
            return Some(job);
        }
    }
    None
}
