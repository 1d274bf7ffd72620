//! A full disk: what was computed waits until somebody makes room.

use std::time::Duration;

use super::error::Halt;
use super::progress::Watch;
use crate::store::StoreError;

/// Time between two attempts.
const BETWEEN_ATTEMPTS: Duration = Duration::from_secs(2);

/// Writes a result, again and again while the disk is full, unless the job is not wanted any more.
pub(super) async fn once_there_is_room<T, W>(watch: &Watch, mut write: impl FnMut() -> W) -> Result<T, Halt>
where
    W: Future<Output = Result<T, StoreError>>,
{
    let mut warned = false;
    loop {
        match write().await {
            Err(error) if error.is_disk_full() => {
                if watch.is_cancelled() {
                    return Err(Halt::NotWanted);
                }
                if !warned {
                    tracing::error!(%error, "the disk of the data folder is full; a result waits for room");
                    warned = true;
                }
                tokio::time::sleep(BETWEEN_ATTEMPTS).await;
            }
            written => return Ok(written?),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Error, ErrorKind};
    use std::sync::Arc;

    use super::*;
    use crate::store::jobs::JobId;

    fn watch() -> Arc<Watch> {
        Watch::new(JobId::new(), 1, Arc::default(), Arc::default())
    }

    #[tokio::test]
    async fn a_result_outlasts_a_full_disk_and_no_other_failure() {
        let mut failures = vec![ErrorKind::PermissionDenied, ErrorKind::StorageFull];
        let mut write = || {
            let failure = failures.pop();
            async move { failure.map_or(Ok(7), |kind| Err(StoreError::File(Error::from(kind)))) }
        };
        assert!(matches!(once_there_is_room(&watch(), &mut write).await, Err(Halt::Store(_))));
        assert!(matches!(once_there_is_room(&watch(), &mut write).await, Ok(7)));
    }

    #[tokio::test]
    async fn a_dismissed_job_does_not_wait() {
        let watch = watch();
        watch.dismiss();
        let full = || async { Err::<(), _>(StoreError::File(Error::from(ErrorKind::StorageFull))) };
        assert!(matches!(once_there_is_room(&watch, full).await, Err(Halt::NotWanted)));
    }
}
