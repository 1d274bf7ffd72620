//! Polling of a queue: when a worker asks it for tasks.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use apalis::prelude::{PollSnapshot, PollStrategy};
use tokio::sync::Notify;

/// Wakes a worker when it is notified, and now and then without: a notification that arrives while the worker is asking
/// the queue would otherwise be lost.
pub(super) struct Awake {
    notifications: Pin<Box<dyn futures::Stream<Item = ()> + Send + Sync>>,
    interval: tokio::time::Interval,
}

impl Awake {
    pub(super) fn by(notify: &Arc<Notify>, idle: Duration) -> Self {
        let notifications = futures::stream::unfold(Arc::clone(notify), |notify| async move {
            notify.notified().await;
            Some(((), notify))
        });
        Self { notifications: Box::pin(notifications), interval: tokio::time::interval(idle) }
    }
}

impl PollStrategy for Awake {
    /// Arranges only to be woken: the worker asks its queue whenever it is polled.
    fn poll_drive(&mut self, cx: &mut Context<'_>, _: &PollSnapshot) -> Poll<Option<()>> {
        while self.notifications.as_mut().poll_next(cx).is_ready() {}
        while self.interval.poll_tick(cx).is_ready() {}
        Poll::Pending
    }
}
