//! Threads that compute: a fixed number, apart from those that serve requests.
//!
//! tokio's `spawn_blocking` behind a semaphore would be some lines less, and lose two things. It takes threads from the
//! system as work comes, and panics where the system has none left at that moment (tokio 1.54, under a limit of
//! processes); these are there from the start or there is no start. And who drops a runtime waits for what was given to
//! it, however long that computes; these end with the process.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

use tokio::sync::oneshot;

type Work = Box<dyn FnOnce() + Send>;

/// A fixed number of threads that take work in order of arrival.
#[derive(Debug, Clone)]
pub(crate) struct CpuPool {
    sender: mpsc::Sender<Work>,
    threads: usize,
    /// Threads for work that is parallel in itself.
    inner_threads: usize,
}

/// A computation panicked: a defect of the program.
#[derive(Debug, Clone, thiserror::Error)]
#[error("the computation panicked: {message}")]
pub struct Panicked {
    /// What the panic said.
    pub message: String,
}

impl CpuPool {
    /// Starts `threads` threads called `name`; [`CpuPool::run_parallel`] gives each piece of work `inner_threads` more.
    /// They end when the last handle on the pool is gone.
    pub(crate) fn start(name: &str, threads: usize, inner_threads: usize) -> std::io::Result<Self> {
        let (sender, receiver) = mpsc::channel::<Work>();
        let receiver = Arc::new(Mutex::new(receiver));
        for index in 0..threads {
            let receiver = Arc::clone(&receiver);
            std::thread::Builder::new().name(format!("{name}-{index}")).spawn(move || {
                loop {
                    // The lock is held while waiting for work, never while doing it.
                    let work = receiver.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok(work) = work else { break };
                    work();
                }
            })?;
        }
        Ok(Self { sender, threads, inner_threads })
    }

    /// Its threads.
    pub(crate) fn threads(&self) -> usize {
        self.threads
    }

    /// Runs `compute` on one of the threads and waits for its result.
    pub(crate) async fn run<T, F>(&self, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        self.queue(compute, false).await
    }

    /// Like [`CpuPool::run`], for work that only its result is wanted of: it does not begin once nobody waits for it any more.
    pub(crate) async fn run_while_awaited<T, F>(&self, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        self.queue(compute, true).await
    }

    async fn queue<T, F>(&self, compute: F, only_awaited: bool) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let (sender, receiver) = oneshot::channel();
        let work: Work = Box::new(move || {
            if only_awaited && sender.is_closed() {
                return;
            }
            let result = catch_unwind(AssertUnwindSafe(compute)).map_err(|payload| Panicked {
                message: payload
                    .downcast_ref::<&str>()
                    .map(ToString::to_string)
                    .or_else(|| payload.downcast_ref::<String>().cloned())
                    .unwrap_or_else(|| "no message".to_owned()),
            });
            // Nobody waits any more: the result is not wanted.
            let _ = sender.send(result);
        });
        let gone = || Panicked { message: "its thread is gone".to_owned() };
        self.sender.send(work).map_err(|_| gone())?;
        receiver.await.map_err(|_| gone())?
    }

    /// Like [`CpuPool::run`], for work that is parallel in itself (`rayon`).
    ///
    /// It gets threads of its own: in a pool that all share, a small upload would wait behind every piece of a
    /// reduction of minutes.
    pub(crate) async fn run_parallel<T, F>(&self, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let inner_threads = self.inner_threads;
        self.run(move || match rayon::ThreadPoolBuilder::new().num_threads(inner_threads).build() {
            Ok(threads) => threads.install(compute),
            // The system gives no more threads: then with those that are there.
            Err(_) => compute(),
        })
        .await
    }
}

#[cfg(test)]
mod tests {
    use super::CpuPool;
    use std::pin::Pin;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::time::Duration;
    use tokio::time::timeout;

    #[tokio::test]
    async fn work_that_nobody_awaits_does_not_begin() {
        let pool = CpuPool::start("test", 1, 1).unwrap();
        let (hold, held) = std::sync::mpsc::channel::<()>();
        let busy = pool.clone();
        let first = tokio::spawn(async move { busy.run(move || held.recv().is_ok()).await });
        // The first is queued before the others.
        tokio::task::yield_now().await;
        let begun = Arc::new(AtomicU32::new(0));
        let count = || {
            let begun = Arc::clone(&begun);
            move || begun.fetch_add(1, Ordering::SeqCst)
        };
        // Both are queued by their first poll and given up.
        let (dropped, kept) = (pool.run_while_awaited(count()), pool.run(count()));
        for left in [Box::pin(dropped) as Pin<Box<dyn Future<Output = _>>>, Box::pin(kept)] {
            assert!(timeout(Duration::ZERO, left).await.is_err());
        }
        hold.send(()).unwrap();
        assert!(first.await.unwrap().unwrap());
        pool.run(|| ()).await.unwrap();
        assert_eq!(begun.load(Ordering::SeqCst), 1, "only what runs whatever becomes of its caller");
    }

    #[tokio::test]
    async fn a_panic_is_a_result_and_the_thread_lives_on() {
        let pool = CpuPool::start("test", 1, 3).unwrap();
        let panicked = pool.run(|| panic!("division by cucumber")).await.unwrap_err();
        assert_eq!(panicked.message, "division by cucumber");
        let panicked = pool.run_parallel(|| panic!("division by marrow")).await.unwrap_err();
        assert_eq!(panicked.message, "division by marrow");
        assert_eq!(pool.run(|| 6 * 7).await.unwrap(), 42);
        assert_eq!(pool.run_parallel(rayon::current_num_threads).await.unwrap(), 3);
    }
}
