//! The latest look at the database.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::Mutex;
use tokio::time::timeout;

use crate::store::Store;

/// How long is waited for the database and the disk.
pub(super) const PATIENCE: Duration = Duration::from_secs(2);

/// How long a look at the database counts: each is a write and a flush, and anybody may ask.
const COUNTS: Duration = Duration::from_secs(1);

/// The latest look at the database. Locked while somebody looks.
#[derive(Debug, Clone, Default)]
pub(super) struct Probed(Arc<Mutex<Option<Look>>>);

/// One look at the database.
#[derive(Debug)]
struct Look {
    ended: Instant,
    /// How long it took, or what went wrong.
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
    /// Looks, unless somebody just did. In a task of its own: a write that nobody waits for any more still comes to its end.
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
