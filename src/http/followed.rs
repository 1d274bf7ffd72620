//! Followed jobs: who follows which job, and the task that sends its events to all of them.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::response::sse::Event;
use tokio::sync::watch::{self, Receiver, Sender};

use crate::store::jobs::JobId;

/// Jobs that clients follow.
#[derive(Debug, Clone, Default)]
pub struct Followed {
    jobs: Arc<Mutex<HashMap<JobId, Sender<Option<Event>>>>>,
}

/// Sender of a job's events to those who follow it; once it is dropped their streams end, after the last event.
#[derive(Debug)]
pub(super) struct Teller {
    followed: Followed,
    id: JobId,
    told: Sender<Option<Event>>,
}

impl Followed {
    /// Subscribes to the events of a job; with a teller if there is none yet, which the caller must set to work.
    pub(super) fn follow(&self, id: JobId) -> (Receiver<Option<Event>>, Option<Teller>) {
        match self.lock().entry(id) {
            Entry::Occupied(followed) => (followed.get().subscribe(), None),
            Entry::Vacant(place) => {
                let (told, receiver) = watch::channel(None);
                place.insert(told.clone());
                (receiver, Some(Teller { followed: self.clone(), id, told }))
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<JobId, Sender<Option<Event>>>> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Teller {
    /// Id of the followed job.
    pub(super) fn id(&self) -> JobId {
        self.id
    }

    /// Sends an event to all who follow the job.
    pub(super) fn tell(&self, event: Event) {
        self.told.send_replace(Some(event));
    }

    /// Waits until nobody follows the job.
    pub(super) async fn alone(&self) {
        self.told.closed().await;
    }

    /// Whether nobody follows the job any more; if so, it is given up, and the next one who follows it starts another teller.
    pub(super) fn leaves(&self) -> bool {
        let mut followed = self.followed.lock();
        let alone = self.told.is_closed();
        if alone {
            followed.remove(&self.id);
        }
        alone
    }
}

impl Drop for Teller {
    fn drop(&mut self) {
        let mut followed = self.followed.lock();
        if followed.get(&self.id).is_some_and(|told| told.same_channel(&self.told)) {
            followed.remove(&self.id);
        }
    }
}
