//! Patience with a full disk, a locked database, no descriptors left: what was asked for or computed waits until that has passed.

use std::io::ErrorKind;
use std::time::Duration;

use super::error::{Interruption, waiting_for};
use super::progress::Watch;
use crate::store::StoreError;

/// Time between two attempts to write.
pub(super) const BETWEEN_ATTEMPTS: Duration = Duration::from_secs(1);

/// Longest time that a write may take. A server that was cut off in the middle of one never answers, and nobody says so.
pub(super) const LONGEST_WRITE: Duration = Duration::from_secs(300);

/// Writes a result, again and again while the store cannot take it, unless the job is not wanted any more: what was
/// computed is not computed again. What costs nothing to repeat is repeated with its whole task.
pub(super) async fn patiently<T, W>(watch: &Watch, mut write: impl FnMut() -> W) -> Result<T, Interruption>
where
    W: Future<Output = Result<T, StoreError>>,
{
    until_written(watch, || in_time(LONGEST_WRITE, write())).await
}

/// Writes a result that is a file, again and again while the store cannot take it. A single write may take any time:
/// the store of files gives up by itself when a write makes no progress.
pub(super) async fn until_written<T, W>(
    watch: &Watch,
    mut write: impl FnMut() -> W,
) -> Result<T, Interruption>
where
    W: Future<Output = Result<T, StoreError>>,
{
    let mut waiting = None;
    loop {
        match write().await {
            Err(error) if error.may_pass() => {
                if watch.is_cancelled() {
                    return Err(Interruption::NotWanted);
                }
                if waiting.is_none() {
                    tracing::error!(%error, "a result waits until the storage takes it");
                    waiting = Some(watch.waits_for(waiting_for(&error)));
                }
                tokio::time::sleep(BETWEEN_ATTEMPTS).await;
            }
            written => return Ok(written?),
        }
    }
}

/// Writes within a time limit; a write that takes longer may be repeated.
pub(super) async fn in_time<T>(
    limit: Duration,
    write: impl Future<Output = Result<T, StoreError>>,
) -> Result<T, StoreError> {
    let written = tokio::time::timeout(limit, write).await;
    written.unwrap_or_else(|_| Err(StoreError::File(ErrorKind::TimedOut.into())))
}

#[cfg(test)]
mod tests {
    use std::io::Error;
    use std::sync::Arc;

    use super::*;
    use crate::store::jobs::JobId;

    fn watch() -> Arc<Watch> {
        Watch::new(JobId::new(), 1, Arc::default(), Arc::default())
    }

    #[tokio::test]
    async fn a_result_outlasts_what_passes_and_nothing_else() {
        let mut failures = vec![ErrorKind::PermissionDenied, ErrorKind::StorageFull, ErrorKind::ResourceBusy];
        let mut write = || {
            let failure = failures.pop();
            async move { failure.map_or(Ok(7), |kind| Err(StoreError::File(Error::from(kind)))) }
        };
        assert!(matches!(patiently(&watch(), &mut write).await, Err(Interruption::Store(_))));
        assert!(matches!(patiently(&watch(), &mut write).await, Ok(7)));
    }

    #[tokio::test]
    async fn what_is_never_answered_may_be_said_again() {
        let answer = in_time(Duration::from_millis(1), std::future::pending::<Result<(), _>>()).await;
        assert!(answer.unwrap_err().may_pass());
    }

    #[tokio::test]
    async fn a_dismissed_job_does_not_wait() {
        let watch = watch();
        watch.dismiss();
        let full = || async { Err::<(), _>(StoreError::File(Error::from(ErrorKind::StorageFull))) };
        assert!(matches!(patiently(&watch, full).await, Err(Interruption::NotWanted)));
    }
}
