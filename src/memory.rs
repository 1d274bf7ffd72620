//! Memory shared among all that takes much of it: reductions, generations, speeds, uploads, downloads.

use std::sync::Arc;

use tokio::sync::{Mutex, OwnedMutexGuard, OwnedSemaphorePermit, Semaphore};

/// Bytes of the smallest amount that can be claimed.
const UNIT: u64 = 1 << 16;

/// Parts into which memory is divided. The reductions of small models get one each; a large one gets all but one, so that
/// small ones, speeds and uploads need not wait for it.
const SHARES: u64 = 8;

/// DOF of a sector up to which a model is small: its reduction ends within seconds and fits into a share, unless the
/// service has very little memory.
const SMALL_DOFS: u64 = 10_000;

/// Memory that all computations may take together, however many run.
#[derive(Debug)]
pub(crate) struct Memory {
    bytes: Option<u64>,
    units: Arc<Semaphore>,
    /// Lock held by the large computation that runs or is next: the others wait here, not for memory, where small ones would queue up behind them.
    turn: Arc<Mutex<()>>,
}

/// Claim on memory, for as long as it is held.
#[derive(Debug, Default)]
pub struct Allowance {
    /// Bytes that may be taken; `None` for no limit.
    pub(crate) bytes: Option<u64>,
    _units: Option<OwnedSemaphorePermit>,
    turn: Option<OwnedMutexGuard<()>>,
}

impl Allowance {
    /// Whether so many bytes may be taken.
    pub(crate) fn allows(&self, bytes: u64) -> bool {
        self.bytes.is_none_or(|allowed| bytes <= allowed)
    }

    /// Whether no computation can get more.
    pub(crate) fn is_most(&self) -> bool {
        self.turn.is_some()
    }
}

/// Request for more memory than one computation can get.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooLarge {
    /// Bytes that the computation needs.
    pub(crate) needed: u64,
    /// Bytes that one computation can get.
    pub(crate) allowed: u64,
}

impl Memory {
    /// Memory of so many `bytes` to be shared; `None` for no limit.
    pub(crate) fn new(bytes: Option<u64>) -> Self {
        // Without a limit shares still bound how many reductions run at once.
        let units = bytes.map_or(SHARES, |bytes| (bytes / UNIT).max(SHARES));
        Self { bytes, units: Arc::new(Semaphore::new(units as usize)), turn: Arc::default() }
    }

    /// Memory claimed now, in bytes; 0 without a limit.
    pub(crate) fn claimed_bytes(&self) -> u64 {
        let all = self.bytes.map_or(0, |bytes| (bytes / UNIT).max(SHARES));
        all.saturating_sub(self.units.available_permits() as u64) * UNIT
    }

    /// Claims the memory that the reduction of a sector of `dofs` DOF should need, as soon as that is free.
    pub(crate) async fn claim(&self, dofs: u64) -> Allowance {
        if dofs <= SMALL_DOFS { self.take_shares(1, None).await } else { self.claim_most().await }
    }

    /// Claims all that one computation can get.
    pub(crate) async fn claim_most(&self) -> Allowance {
        let turn = Arc::clone(&self.turn).lock_owned().await;
        self.take_shares(SHARES - 1, Some(turn)).await
    }

    /// Claims `bytes`, as soon as they are free.
    pub(crate) async fn hold(&self, bytes: u64) -> Result<Allowance, TooLarge> {
        let Some(most) = self.most() else {
            return Ok(Allowance { bytes: None, _units: None, turn: None });
        };
        if bytes > most {
            return Err(TooLarge { needed: bytes, allowed: most });
        }
        Ok(self.take(bytes.div_ceil(UNIT), None).await)
    }

    /// Claims `bytes`, or all that one computation can get if that is less.
    pub(crate) async fn hold_up_to(&self, bytes: u64) -> Allowance {
        let bytes = bytes.min(self.most().unwrap_or(0));
        self.take(bytes.div_ceil(UNIT), None).await
    }

    /// Bytes that one computation can get; `None` for no limit.
    pub(crate) fn most(&self) -> Option<u64> {
        self.bytes.map(|_| self.share() * (SHARES - 1) * UNIT)
    }

    /// Number of units of a share.
    fn share(&self) -> u64 {
        self.bytes.map_or(1, |bytes| (bytes / UNIT / SHARES).max(1))
    }

    async fn take_shares(&self, shares: u64, turn: Option<OwnedMutexGuard<()>>) -> Allowance {
        self.take(shares * self.share(), turn).await
    }

    async fn take(&self, units: u64, turn: Option<OwnedMutexGuard<()>>) -> Allowance {
        // Refused only once the semaphore is closed, which nobody does.
        let units = u32::try_from(units).unwrap_or(u32::MAX);
        let permit = Arc::clone(&self.units).acquire_many_owned(units).await.ok();
        Allowance { bytes: self.bytes.map(|_| u64::from(units) * UNIT), _units: permit, turn }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures::FutureExt;

    const MIB: u64 = 1 << 20;

    #[tokio::test]
    async fn large_models_come_one_at_a_time_and_small_ones_pass_them() {
        let memory = Memory::new(Some(8 * MIB));
        let large = memory.claim(120_000).await;
        assert_eq!(large.bytes, Some(7 * MIB));
        let mut second = Box::pin(memory.claim(120_000));
        assert!((&mut second).now_or_never().is_none());
        // A small one has a share, though two large ones came before it.
        let small = memory.claim(3000).await;
        assert_eq!(small.bytes, Some(MIB));
        assert!(memory.claim(3000).now_or_never().is_none(), "no more than 8 MiB together");
        drop(large);
        let second = second.await;
        assert_eq!(second.bytes, Some(7 * MIB));
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

    #[tokio::test]
    async fn bytes_are_held_beside_shares_and_never_more_than_there_are() {
        let memory = Memory::new(Some(8 * MIB));
        let large = memory.claim_most().await;
        let speed = memory.hold(MIB).await.unwrap();
        assert!(memory.hold(1).now_or_never().is_none());
        drop(large);
        assert!(memory.hold(6 * MIB).now_or_never().is_some());
        drop(speed);
        assert_eq!(
            memory.hold(7 * MIB + 1).await.unwrap_err(),
            TooLarge { needed: 7 * MIB + 1, allowed: 7 * MIB }
        );
        assert_eq!(memory.hold_up_to(100 * MIB).await.bytes, Some(7 * MIB));
        let boundless = Memory::new(None);
        assert_eq!(boundless.hold(u64::MAX).await.unwrap().bytes, None);
        assert_eq!(boundless.hold_up_to(u64::MAX).await.bytes, None);
    }
}
