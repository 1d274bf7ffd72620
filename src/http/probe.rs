//! Cache of the latest probe of the database.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::Mutex;
use tokio::time::timeout;

use crate::store::Store;

/// Longest wait for the database and the disk.
pub(super) const PATIENCE: Duration = Duration::from_secs(2);

/// Time for which a probe of the database counts: each is a write and a flush, and anybody may ask.
const COUNTS: Duration = Duration::from_secs(1);

/// Latest probe of the database. Locked while one runs.
#[derive(Debug, Clone, Default)]
pub(super) struct Probed(Arc<Mutex<Option<Look>>>);

/// Probe of the database.
#[derive(Debug)]
struct Look {
    ended: Instant,
    /// Time that the probe took, or the error that it met.
    outcome: Result<Duration, String>,
}

impl Look {
    async fn at(store: &Store) -> Self {
        let begin = Instant::now();
        let outcome = store.probe().await.map_err(|error| error.to_string());
        Self { ended: Instant::now(), outcome: outcome.map(|()| begin.elapsed()) }
    }
}

impl Probed {
    /// Probes the database, unless that was just done. In a task of its own: a write that nobody waits for any more still ends.
    pub(super) async fn look(&self, store: &Store) -> Result<Duration, String> {
        let (latest, store) = (Arc::clone(&self.0), store.clone());
        let looking = async {
            let mut latest = latest.lock_owned().await;
            let look = tokio::spawn(async move {
                let recent = latest.take().filter(|look| look.ended.elapsed() < COUNTS);
                let look = match recent {
                    Some(look) => look,
                    None => Look::at(&store).await,
                };
                latest.insert(look).outcome.clone()
            });
            look.await.map_err(|error| error.to_string())?
        };
        let late = |_| format!("no row could be written and read back within {} s", PATIENCE.as_secs());
        timeout(PATIENCE, looking).await.map_err(late)?
    }
}
