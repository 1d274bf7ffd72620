//! Memory, shared among the computations that take much of it.

use tokio::sync::{Mutex, MutexGuard, Semaphore, SemaphorePermit};

/// Parts into which memory is divided. Small models get one each; a large one gets all but one, so that small ones
/// need not wait for it.
const SHARES: u32 = 8;

/// DOF of a sector up to which a model is small: its reduction ends within seconds and fits into a share, unless the
/// service has very little memory.
const SMALL_DOFS: u64 = 10_000;

/// What reductions and generations may take together, however many run.
#[derive(Debug)]
pub(super) struct Memory {
    bytes: Option<u64>,
    shares: Semaphore,
    /// Held by the large computation that runs or is next: the others wait here, not for shares, where small ones would
    /// queue up behind them.
    turn: Mutex<()>,
}

/// A claim on memory, for as long as it is held.
#[derive(Debug)]
pub(super) struct Allowance<'a> {
    /// Bytes that may be taken; `None` for no limit.
    pub(super) bytes: Option<u64>,
    _shares: Option<SemaphorePermit<'a>>,
    turn: Option<MutexGuard<'a, ()>>,
}

impl Allowance<'_> {
    /// Whether so many bytes may be taken.
    pub(super) fn allows(&self, bytes: u64) -> bool {
        self.bytes.is_none_or(|allowed| bytes <= allowed)
    }

    /// Whether no computation can get more.
    pub(super) fn is_most(&self) -> bool {
        self.turn.is_some()
    }
}

impl Memory {
    /// `bytes` to be shared; `None` for no limit.
    pub(super) fn new(bytes: Option<u64>) -> Self {
        Self { bytes, shares: Semaphore::new(SHARES as usize), turn: Mutex::default() }
    }

    /// What is claimed now, in bytes; 0 without a limit.
    pub(super) fn claimed_bytes(&self) -> u64 {
        let free = self.shares.available_permits() as u64;
        self.bytes.unwrap_or(0) / u64::from(SHARES) * u64::from(SHARES).saturating_sub(free)
    }

    /// Claims what a sector of `dofs` DOF should need, as soon as that is free.
    pub(super) async fn claim(&self, dofs: u64) -> Allowance<'_> {
        if dofs <= SMALL_DOFS { self.take(1, None).await } else { self.claim_most().await }
    }

    /// Claims all that one computation can get.
    pub(super) async fn claim_most(&self) -> Allowance<'_> {
        let turn = self.turn.lock().await;
        self.take(SHARES - 1, Some(turn)).await
    }

    async fn take<'a>(&'a self, shares: u32, turn: Option<MutexGuard<'a, ()>>) -> Allowance<'a> {
        // Refused only once the semaphore is closed, which nobody does.
        let permit = self.shares.acquire_many(shares).await.ok();
        let bytes = self.bytes.map(|bytes| bytes / u64::from(SHARES) * u64::from(shares));
        Allowance { bytes, _shares: permit, turn }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures::FutureExt;

    #[tokio::test]
    async fn large_models_come_one_at_a_time_and_small_ones_pass_them() {
        let memory = Memory::new(Some(8000));
        let large = memory.claim(120_000).await;
        assert_eq!(large.bytes, Some(7000));
        let mut second = Box::pin(memory.claim(120_000));
        assert!((&mut second).now_or_never().is_none());
        // A small one has a share, though two large ones came before it.
        let small = memory.claim(3000).await;
        assert_eq!(small.bytes, Some(1000));
        assert!(memory.claim(3000).now_or_never().is_none(), "no more than 8000 bytes together");
        drop(large);
        let second = second.await;
        assert_eq!(second.bytes, Some(7000));
    }

    #[tokio::test]
    async fn as_many_small_ones_as_there_are_shares() {
        let memory = Memory::new(None);
        let mut held = Vec::new();
        for _ in 0..SHARES {
            held.push(memory.claim(SMALL_DOFS).await);
        }
        assert_eq!(held[0].bytes, None);
        assert!(memory.claim(SMALL_DOFS).now_or_never().is_none());
        assert!(memory.claim_most().now_or_never().is_none());
        drop(held);
        assert!(memory.claim_most().now_or_never().is_some());
    }
}
