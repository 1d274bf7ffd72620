//! Costs of steps on this machine.

use std::sync::Arc;

use tokio::sync::OnceCell;

use super::machine;
use crate::analysis::run::Calibration;
use crate::pool::{CpuPool, Panicked};
use crate::store::{Store, StoreError};

/// Costs of steps on this machine: from the store, or measured at first use.
#[derive(Debug)]
pub(super) struct Calibrated {
    store: Store,
    known: OnceCell<Arc<Calibration>>,
}

impl Calibrated {
    pub(super) fn new(store: Store) -> Self {
        Self { store, known: OnceCell::new() }
    }

    /// Gives the costs; measures them on a thread of `pool` where none are stored.
    pub(super) async fn get<E: From<StoreError> + From<Panicked>>(
        &self,
        pool: &CpuPool,
    ) -> Result<Arc<Calibration>, E> {
        let known = self
            .known
            .get_or_try_init(|| async {
                let machine = machine::kind(&machine::here());
                if let Some(kept) = self.store.calibration(&machine).await? {
                    return Ok::<_, E>(Arc::new(kept));
                }
                let measured = pool.run(Calibration::measure).await?;
                tracing::info!(machine, ?measured, "measured what a step costs");
                if let Err(error) = self.store.insert_calibration(&machine, &measured).await {
                    tracing::warn!(%error, "could not keep what a step costs; the next start measures again");
                }
                Ok(Arc::new(measured))
            })
            .await?;
        Ok(Arc::clone(known))
    }
}
