//! Why a task of a job ended early.

use super::pool::Panicked;
use crate::analysis::error::AnalysisError;
use crate::impeller::ImpellerError;
use crate::package::PackageError;
use crate::store::StoreError;
use crate::store::jobs::{Failure, FailureCause};

/// How to get more memory.
const MORE_MEMORY: &str = "let the service take more (--memory-bytes or RUBMAP_MEMORY_BYTES, of which seven eighths go to \
                           one large model), or run it on a machine with more memory";

/// Why a task of a job ended early.
#[derive(Debug)]
pub(super) enum Halt {
    /// The job was dismissed, or the service is stopping: nothing to record.
    NotWanted,
    /// The job cannot be computed.
    Failed(Failure),
    /// What is needed could not be read or kept.
    Store(StoreError),
}

impl Halt {
    /// The generator made a package that the importer refuses.
    pub(super) fn generated_package(error: PackageError) -> Self {
        let message = format!("these parameters give no valid model: {error}");
        Self::Failed(Failure { cause: FailureCause::Refused, message, violations: Vec::new() })
    }

    /// The generator needs more memory than it may take.
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

    /// The service died under the job too often.
    pub(super) fn crashed(times: u32) -> Self {
        let message = format!(
            "the service ended {times} times while it computed this job, without finishing anything of it in between; \
             most likely it ran out of memory: ask for less (modes_per_speed, mesh), or give the service more"
        );
        Self::Failed(Failure { cause: FailureCause::Defect, message, violations: Vec::new() })
    }
}

impl From<StoreError> for Halt {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

impl From<serde_json::Error> for Halt {
    fn from(error: serde_json::Error) -> Self {
        Self::Store(error.into())
    }
}

impl From<Panicked> for Halt {
    fn from(panicked: Panicked) -> Self {
        let message = format!("{panicked}. This is a defect of the program; please report it with the model");
        Self::Failed(Failure { cause: FailureCause::Defect, message, violations: Vec::new() })
    }
}

impl From<AnalysisError> for Halt {
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

impl From<ImpellerError> for Halt {
    fn from(error: ImpellerError) -> Self {
        let message = error.to_string();
        let cause = match error {
            ImpellerError::Parameter { .. }
            | ImpellerError::Field { .. }
            | ImpellerError::Jacobian { .. } => FailureCause::Refused,
            ImpellerError::NotPositiveDefinite => FailureCause::Model,
        };
        Self::Failed(Failure { cause, message, violations: Vec::new() })
    }
}
