//! Planning thread: short computations that requests wait for. Owners take turns.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::oneshot;

use crate::pool::{CpuPool, Panicked, Work, caught};
use crate::store::limits::LimitReached;

/// Requests of one owner that may be planned or checked at once.
const MOST_ASKED: usize = 256;

/// Threads of a pool, on which owners take turns.
#[derive(Clone)]
pub(super) struct Planner {
    pool: CpuPool,
    lines: Arc<Mutex<Lines>>,
}

#[derive(Default)]
struct Lines {
    /// Work that waits, one line for each owner; the first is next.
    waiting: VecDeque<(String, VecDeque<Work>)>,
    /// Requests of each owner that were admitted.
    asked: HashMap<String, usize>,
}

/// Permit for a request to be planned, held for as long as that takes.
pub(super) struct Permit {
    owner: String,
    lines: Arc<Mutex<Lines>>,
}

impl Planner {
    pub(super) fn new(pool: CpuPool) -> Self {
        Self { pool, lines: Arc::default() }
    }

    /// Threads for work that belongs to no owner.
    pub(super) fn pool(&self) -> &CpuPool {
        &self.pool
    }

    /// Admits a request of `owner`.
    ///
    /// # Errors
    /// If too many requests of this owner are being planned.
    pub(super) fn admit(&self, owner: &str) -> Result<Permit, LimitReached> {
        let mut lines = lock(&self.lines);
        let asked = lines.asked.entry(owner.to_owned()).or_default();
        if *asked >= MOST_ASKED {
            return Err(LimitReached::Plans { limit: MOST_ASKED });
        }
        *asked += 1;
        drop(lines);
        Ok(Permit { owner: owner.to_owned(), lines: Arc::clone(&self.lines) })
    }

    /// Queues `compute` in the line of `owner` and waits for its result; owners take turns. Work whose caller has gone is not begun.
    pub(super) async fn run<T, F>(&self, owner: &str, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let (sender, receiver) = oneshot::channel();
        let work: Work = Box::new(move || {
            if !sender.is_closed() {
                // Nobody waits any more: the result is not wanted.
                let _ = sender.send(caught(compute));
            }
        });
        {
            let mut lines = lock(&self.lines);
            match lines.waiting.iter_mut().find(|(known, _)| known == owner) {
                Some((_, line)) => line.push_back(work),
                None => lines.waiting.push_back((owner.to_owned(), VecDeque::from([work]))),
            }
        }
        // One piece of work is done for each that came, whoever's turn it is then.
        let lines = Arc::clone(&self.lines);
        self.pool.give(Box::new(move || {
            if let Some(work) = next(&lines) {
                work();
            }
        }))?;
        receiver.await.map_err(|_| Panicked::of_a_lost_thread())?
    }
}

impl std::fmt::Debug for Planner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Planner").field("pool", &self.pool).finish_non_exhaustive()
    }
}

/// Takes the next work; its owner goes to the end.
fn next(lines: &Mutex<Lines>) -> Option<Work> {
    let mut lines = lock(lines);
    let (owner, mut line) = lines.waiting.pop_front()?;
    let work = line.pop_front();
    if !line.is_empty() {
        lines.waiting.push_back((owner, line));
    }
    work
}

impl Drop for Permit {
    fn drop(&mut self) {
        let mut lines = lock(&self.lines);
        if let Some(asked) = lines.asked.get_mut(&self.owner) {
            *asked -= 1;
            if *asked == 0 {
                lines.asked.remove(&self.owner);
            }
        }
    }
}

fn lock(lines: &Mutex<Lines>) -> MutexGuard<'_, Lines> {
    lines.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[tokio::test]
    async fn owners_take_turns() {
        let planner = Planner::new(CpuPool::start("test", 1, 1).unwrap());
        let (hold, held) = mpsc::channel::<()>();
        let (said, order) = mpsc::channel();
        let first = planner.run("a", move || held.recv().is_ok());
        let say = |what: &'static str| {
            let said = said.clone();
            move || said.send(what).unwrap()
        };
        let later = async {
            let all = tokio::join!(
                planner.run("a", say("a1")),
                planner.run("a", say("a2")),
                planner.run("a", say("a3")),
                planner.run("b", say("b1")),
            );
            all.3.unwrap();
        };
        let release = async {
            tokio::task::yield_now().await;
            hold.send(()).unwrap();
        };
        let (first, ..) = tokio::join!(first, later, release);
        assert!(first.unwrap());
        let order: Vec<&str> = order.try_iter().collect();
        let turn = order.iter().position(|said| *said == "b1");
        assert!(order.len() == 4 && turn.is_some_and(|turn| turn <= 1), "{order:?}");
    }

    #[tokio::test]
    async fn a_panic_is_told_to_its_caller_and_others_are_planned() {
        let planner = Planner::new(CpuPool::start("test", 1, 1).unwrap());
        let broken = planner.run("a", || -> u32 { panic!("division by cucumber") });
        let (broken, whole) = tokio::join!(broken, planner.run("b", || 6 * 7));
        assert_eq!(broken.unwrap_err().message, "division by cucumber");
        assert_eq!(whole.unwrap(), 42);
    }

    #[tokio::test]
    async fn what_nobody_waits_for_is_passed_over() {
        let planner = Planner::new(CpuPool::start("test", 1, 1).unwrap());
        let (said, order) = mpsc::channel();
        let (hold, held) = mpsc::channel::<()>();
        let first = planner.run("a", move || held.recv().is_ok());
        let rest = async {
            let left = Box::pin(planner.run("a", move || said.send(()).unwrap()));
            // Its first poll queues it.
            assert!(tokio::time::timeout(std::time::Duration::ZERO, left).await.is_err());
            hold.send(()).unwrap();
        };
        assert!(tokio::join!(first, rest).0.unwrap());
        planner.run("b", || ()).await.unwrap();
        assert!(order.try_recv().is_err());
    }

    #[test]
    fn one_owner_has_so_many_requests_at_once() {
        let planner = Planner::new(CpuPool::start("test", 1, 1).unwrap());
        let asked: Vec<Permit> = (0..MOST_ASKED).map(|_| planner.admit("a").ok().unwrap()).collect();
        assert!(planner.admit("a").is_err() && planner.admit("b").is_ok());
        drop(asked);
        assert!(planner.admit("a").is_ok());
    }
}
