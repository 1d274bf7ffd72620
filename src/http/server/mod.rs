//! Connections: how many there are, how long they may keep the service waiting, and their end.
//!
//! `axum::serve` takes every connection and keeps it for as long as its client likes, so a few hundred lazy clients leave no open
//! file to anybody, the database included. Here there is a limit. Beyond it a new connection waits, not yet served, until another
//! ends, or one that keeps the service waiting is closed for it: first those at rest between two requests, then those whose request
//! is not coming, then those whose client follows a job and can ask again. No other connection is closed whose client keeps
//! sending, or waits for an answer. There is no share per address: behind a gateway all clients have one.

mod activity;
mod connection;
pub mod descriptors;
mod figures;
mod limits;
mod stream;

use std::collections::HashMap;
use std::io::ErrorKind;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use axum::Router;
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, Id, JoinSet};
use tokio_util::sync::CancellationToken;

use self::activity::{Activity, Overdue};

pub(super) use connection::Lasting;
pub use figures::Figures;
pub use limits::Limits;

/// Time between two checks of all connections.
const ROUND: Duration = Duration::from_millis(100);

/// Time that requests may take to end once the service is told to stop.
const LAST_REQUESTS: Duration = Duration::from_secs(3);

/// Serves connections until `stop`. Connections at rest are closed then; requests under way have a moment to end.
pub async fn serve(
    listener: TcpListener,
    router: Router,
    limits: &Limits,
    figures: &Figures,
    stop: CancellationToken,
) {
    let mut connections = Connections::new(router, limits, figures, stop.clone());
    let mut round = tokio::time::interval(ROUND);
    let mut newcomer = None;
    loop {
        tokio::select! {
            () = stop.cancelled() => break,
            accepted = accept(&listener), if newcomer.is_none() => newcomer = Some(accepted),
            Some(ended) = connections.tasks.join_next_with_id() => connections.ended(ended),
            _ = round.tick() => connections.close_overdue(),
        }
        if let Some((stream, peer)) = newcomer.take_if(|_| connections.has_room()) {
            connections.admit(stream, peer);
        }
    }
    drop(listener);
    connections.close_free();
    let all_ended = async {
        while let Some(ended) = connections.tasks.join_next_with_id().await {
            connections.ended(ended);
        }
    };
    if tokio::time::timeout(LAST_REQUESTS, all_ended).await.is_err() {
        tracing::warn!(connections = connections.open.len(), "cutting requests that do not end");
    }
}

/// Accepts the next connection. Errors are logged at most: they are the client's affair, or pass.
async fn accept(listener: &TcpListener) -> (TcpStream, SocketAddr) {
    loop {
        match listener.accept().await {
            Ok(accepted) => return accepted,
            Err(error) => match error.kind() {
                ErrorKind::ConnectionAborted | ErrorKind::ConnectionReset | ErrorKind::ConnectionRefused => {}
                _ => {
                    tracing::error!(%error, "could not accept a connection");
                    // Perhaps the system has no file for it. The client waits.
                    tokio::time::sleep(ROUND).await;
                }
            },
        }
    }
}

/// Open connections, and the tasks that serve them.
struct Connections<'a> {
    router: Router,
    limits: &'a Limits,
    figures: &'a Figures,
    stop: CancellationToken,
    tasks: JoinSet<()>,
    open: HashMap<Id, (AbortHandle, Arc<Activity>)>,
    /// Whether the log already has that there was no room.
    full: bool,
}

impl<'a> Connections<'a> {
    fn new(router: Router, limits: &'a Limits, figures: &'a Figures, stop: CancellationToken) -> Self {
        let (tasks, open) = (JoinSet::new(), HashMap::new());
        Self { router, limits, figures, stop, tasks, open, full: false }
    }

    fn admit(&mut self, stream: TcpStream, peer: SocketAddr) {
        let activity = Arc::new(Activity::new());
        let serving =
            connection::serve(stream, peer, self.router.clone(), Arc::clone(&activity), self.stop.clone());
        let task = self.tasks.spawn(serving);
        self.open.insert(task.id(), (task, activity));
        self.figures.accepted.fetch_add(1, Ordering::Relaxed);
        self.count();
    }

    fn ended(&mut self, ended: Result<(Id, ()), tokio::task::JoinError>) {
        let id = match ended {
            Ok((id, ())) => id,
            Err(error) => {
                if error.is_panic() {
                    tracing::error!(%error, "a connection panicked");
                }
                error.id()
            }
        };
        self.open.remove(&id);
        self.count();
    }

    /// Whether there is room for one more connection, for which another may be closed.
    fn has_room(&mut self) -> bool {
        if self.open.len() < self.limits.connections {
            self.full = false;
            return true;
        }
        if !std::mem::replace(&mut self.full, true) {
            tracing::warn!(
                limit = self.limits.connections,
                "as many connections as there may be; the laziest make room for new ones"
            );
        }
        let now = Instant::now();
        let laziest = self
            .open
            .iter()
            .filter_map(|(id, (_, activity))| Some((activity.dispensability(now)?, *id)))
            .max_by_key(|(dispensability, _)| *dispensability);
        let Some((_, id)) = laziest else { return false };
        self.close(id);
        self.figures.given_up.fetch_add(1, Ordering::Relaxed);
        true
    }

    fn close_overdue(&mut self) {
        let now = Instant::now();
        let overdue: Vec<_> = self
            .open
            .iter()
            .filter_map(|(id, (_, activity))| Some((*id, activity.overdue(now, self.limits)?)))
            .collect();
        for (id, reason) in overdue {
            self.close(id);
            let counter = match reason {
                Overdue::Head => &self.figures.overdue_heads,
                Overdue::Rest => &self.figures.overdue_rests,
                Overdue::Answer => &self.figures.overdue_answers,
            };
            counter.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Closes the connections with which nothing is lost.
    fn close_free(&mut self) {
        let free: Vec<_> =
            self.open.iter().filter(|(_, (_, activity))| activity.is_free()).map(|(id, _)| *id).collect();
        free.into_iter().for_each(|id| self.close(id));
    }

    fn close(&mut self, id: Id) {
        if let Some((task, _)) = self.open.remove(&id) {
            task.abort();
            self.count();
        }
    }

    fn count(&self) {
        self.figures.open.store(self.open.len(), Ordering::Relaxed);
    }
}
