//! Reasons why a task of a job ended early.

use crate::analysis::error::AnalysisError;
use crate::dynamics::error::ModelError;
use crate::dynamics::findings::DigitNoise;
use crate::impeller::ImpellerError;
use crate::memory::TooLarge;
use crate::package::PackageError;
use crate::pool::Panicked;
use crate::store::StoreError;
use crate::store::jobs::{Failure, FailureCause};
use crate::store::limits::LimitReached;

/// Advice on how to get more memory.
const MORE_MEMORY: &str = "let the service take more (--memory-bytes or RUBMAP_MEMORY_BYTES, of which seven eighths go to \
                           one large model), or run it on a machine with more memory";

/// Reason why a task of a job ended early.
#[derive(Debug)]
pub(super) enum Interruption {
    /// Task that is not wanted any more: the job was dismissed, or the service is stopping. Nothing to record.
    NotWanted,
    /// Job that cannot be computed.
    Failed(Failure),
    /// Data that the task needs could not be read or stored.
    Store(StoreError),
}

impl Interruption {
    /// Interruption by a stored package that cannot be read: for a while, or because it is not what it was.
    pub(super) fn stored_package(error: PackageError) -> Self {
        match error {
            PackageError::Io { source } => Self::Store(StoreError::Package(source)),
            error => {
                let message = format!("the stored package cannot be read any more: {error}");
                Self::Failed(Failure { cause: FailureCause::Package, message, violations: Vec::new() })
            }
        }
    }

    /// Failure of a model whose matrices were written with few digits and that cannot be reduced, probably for that reason.
    pub(super) fn few_digits(error: &ModelError, digits: &DigitNoise) -> Self {
        let message = format!("{error}. A likely cause: {}", digits.warning());
        Self::Failed(Failure { cause: FailureCause::Model, message, violations: Vec::new() })
    }

    /// Failure of a job of which one speed needs more memory than there is for all.
    pub(super) fn speed_memory(TooLarge { needed, allowed }: TooLarge) -> Self {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let message = format!(
            "a speed of this job needs about {:.1} MiB of memory while it runs and may take {:.1} MiB: ask for fewer sensors, \
             revolutions or engine orders, {MORE_MEMORY}",
            mib(needed),
            mib(allowed)
        );
        Self::Failed(Failure { cause: FailureCause::Memory, message, violations: Vec::new() })
    }

    /// Failure of a job for which the bending of second order needs more memory than there is.
    pub(super) fn bending_memory(TooLarge { needed, allowed }: TooLarge) -> Self {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let message = format!(
            "the bending of second order of this model needs about {:.1} MiB of memory and may take {:.1} MiB: ask \
             for fewer coordinates, remove `geometric_nonlinearity` or `backbones` from the request, {MORE_MEMORY}",
            mib(needed),
            mib(allowed)
        );
        Self::Failed(Failure { cause: FailureCause::Memory, message, violations: Vec::new() })
    }

    /// Failure of a job whose owner has too much already.
    pub(super) fn limit(reached: LimitReached) -> Self {
        let message = reached.to_string();
        Self::Failed(Failure { cause: FailureCause::Limit, message, violations: Vec::new() })
    }

    /// Failure of a job for which the generator made a package that the importer refuses.
    pub(super) fn generated_package(error: PackageError) -> Self {
        if let PackageError::Io { source } = error {
            return Self::Store(StoreError::File(source));
        }
        let message = format!("these parameters give no valid model: {error}");
        Self::Failed(Failure { cause: FailureCause::Refused, message, violations: Vec::new() })
    }

    /// Failure of a job for which the generator needs more memory than it may take.
    pub(super) fn generation_memory(needed_bytes: u64, allowed_bytes: u64) -> Self {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let message = format!(
            "generating this model needs about {:.1} MiB of memory and may take {:.1} MiB: ask for a coarser mesh or for \
             8-node elements, {MORE_MEMORY}",
            mib(needed_bytes),
            mib(allowed_bytes)
        );
        Self::Failed(Failure { cause: FailureCause::Memory, message, violations: Vec::new() })
    }
}

/// Text for a job that waits because the store failed with `error`.
pub(super) fn waiting_for(error: &StoreError) -> &'static str {
    if error.is_disk_full() {
        "waiting for room on the disk of the storage"
    } else if error.is_missing_package() {
        "waiting for the package of its model, which is not in the storage: upload it again"
    } else {
        "waiting for the storage, which cannot be used for the moment"
    }
}

/// Failure of a job whose model's package has been missing for too long.
pub(super) fn lost_package() -> Failure {
    let message =
        "the package of its model is not in the storage any more; upload the model and send the job again";
    Failure { cause: FailureCause::Package, message: message.to_owned(), violations: Vec::new() }
}

/// Failure of a job whose stored data do not read back.
pub(super) fn unreadable() -> Failure {
    let message = "the storage holds something that cannot be read; the service's log says more";
    Failure { cause: FailureCause::Storage, message: message.to_owned(), violations: Vec::new() }
}

/// Failure of a job under which the service died too often.
pub(super) fn crashed(times: u32) -> Failure {
    let message = format!(
        "the service ended {times} times while it computed this job and nothing else that it ended under before, \
         without finishing anything of it in between; why, the logs of the service and of the system say. If it was memory, \
         ask for less (modes_per_speed, mesh) or give the service less of it (--memory-bytes)"
    );
    Failure { cause: FailureCause::Defect, message, violations: Vec::new() }
}

impl From<StoreError> for Interruption {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

impl From<serde_json::Error> for Interruption {
    fn from(error: serde_json::Error) -> Self {
        Self::Store(error.into())
    }
}

impl From<Panicked> for Interruption {
    fn from(panicked: Panicked) -> Self {
        let message = format!("{panicked}. This is a defect of the program; please report it with the model");
        Self::Failed(Failure { cause: FailureCause::Defect, message, violations: Vec::new() })
    }
}

impl From<AnalysisError> for Interruption {
    fn from(error: AnalysisError) -> Self {
        let message = error.to_string();
        match error {
            AnalysisError::Cancelled => Self::NotWanted,
            AnalysisError::Refused(violations) => {
                Self::Failed(Failure { cause: FailureCause::Refused, message, violations })
            }
            AnalysisError::Model(_) => {
                Self::Failed(Failure { cause: FailureCause::Model, message, violations: Vec::new() })
            }
            AnalysisError::Memory { .. } => {
                let message = format!("{message}: ask for fewer modes_per_speed, {MORE_MEMORY}");
                Self::Failed(Failure { cause: FailureCause::Memory, message, violations: Vec::new() })
            }
        }
    }
}

impl From<ImpellerError> for Interruption {
    fn from(error: ImpellerError) -> Self {
        let message = error.to_string();
        let cause = match error {
            ImpellerError::Parameter { .. }
            | ImpellerError::Field { .. }
            | ImpellerError::Jacobian { .. } => FailureCause::Refused,
            ImpellerError::CanMove(_) => FailureCause::Model,
        };
        Self::Failed(Failure { cause, message, violations: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_generated_package_that_cannot_be_opened_is_no_verdict() {
        let lack = PackageError::Io { source: std::io::Error::from_raw_os_error(24) };
        let Interruption::Store(error) = Interruption::generated_package(lack) else { panic!("a verdict") };
        assert!(error.may_pass());
    }
}
