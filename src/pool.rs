//! Threads that compute: a fixed number, apart from those that serve requests.
//!
//! tokio's `spawn_blocking` behind a semaphore would be some lines less, and lose two things. It takes threads from the
//! system as work comes, and panics where the system has none left at that moment (tokio 1.54, under a limit of
//! processes); these are there from the start or there is no start. And who drops a runtime waits for what was given to
//! it, however long that computes; these end with the process.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

use tokio::sync::oneshot;

pub(crate) type Work = Box<dyn FnOnce() + Send>;

/// A fixed number of threads that take work in order of arrival.
#[derive(Debug, Clone)]
pub(crate) struct CpuPool {
    sender: mpsc::Sender<Work>,
    threads: usize,
    /// Number of threads for work that is parallel in itself.
    inner_threads: usize,
}

/// Panic of a computation: a defect of the program.
#[derive(Debug, Clone, thiserror::Error)]
#[error("the computation panicked: {message}")]
pub struct Panicked {
    /// Message of the panic.
    pub message: String,
}

impl Panicked {
    pub(crate) fn of_a_lost_thread() -> Self {
        Self { message: "its thread is gone".to_owned() }
    }
}

/// Result of `compute`, or the message of its panic.
pub(crate) fn caught<T>(compute: impl FnOnce() -> T) -> Result<T, Panicked> {
    catch_unwind(AssertUnwindSafe(compute)).map_err(|payload| Panicked {
        message: payload
            .downcast_ref::<&str>()
            .map(ToString::to_string)
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "no message".to_owned()),
    })
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

    /// Number of threads of the pool.
    pub(crate) fn threads(&self) -> usize {
        self.threads
    }

    /// Runs `compute` on one of the threads and waits for its result.
    pub(crate) async fn run<T, F>(&self, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let (sender, receiver) = oneshot::channel();
        self.give(Box::new(move || {
            // The result is not wanted where nobody waits any more.
            let _ = sender.send(caught(compute));
        }))?;
        receiver.await.map_err(|_| Panicked::of_a_lost_thread())?
    }

    /// Queues work that catches its own panics.
    pub(crate) fn give(&self, work: Work) -> Result<(), Panicked> {
        self.sender.send(work).map_err(|_| Panicked::of_a_lost_thread())
    }

    /// Runs `compute`, which is parallel in itself (`rayon`), and waits for its result.
    ///
    /// Such work gets threads of its own: in a pool that all share, a small upload would wait behind every piece of a reduction of minutes.
    pub(crate) async fn run_parallel<T, F>(&self, compute: F) -> Result<T, Panicked>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let inner_threads = self.inner_threads;
        self.run(move || match rayon::ThreadPoolBuilder::new().num_threads(inner_threads).build() {
            Ok(threads) => threads.install(compute),
            // The system gives no more threads: the work runs on those that are there.
            Err(_) => compute(),
        })
        .await
    }
}

#[cfg(test)]
mod tests {
    use super::CpuPool;

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
