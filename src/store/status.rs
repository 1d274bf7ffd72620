//! Status of a job: which status may follow which.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::error::StoreError;

/// Status of a job (OGC API – Processes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum JobStatus {
    /// Waiting for its turn.
    Accepted,
    /// Being computed.
    Running,
    /// Paused by the user until resumed; finished parts stay.
    Paused,
    /// Finished; each speed reports how it ended, and at least one was completed.
    Successful,
    /// Failed: could not be computed, or none of its speeds was completed; `error` gives the reason. Speeds finished before stay readable.
    Failed,
    /// Cancelled by the user; speeds finished before stay readable.
    Dismissed,
}

impl JobStatus {
    /// List of all statuses.
    pub const ALL: [Self; 6] =
        [Self::Accepted, Self::Running, Self::Paused, Self::Successful, Self::Failed, Self::Dismissed];

    /// Whether the status is final.
    pub fn is_final(self) -> bool {
        matches!(self, Self::Successful | Self::Failed | Self::Dismissed)
    }

    /// Whether the job is to be computed as soon as it is its turn.
    pub fn wants_work(self) -> bool {
        matches!(self, Self::Accepted | Self::Running)
    }

    /// Whether `next` may follow this status: the transition table. A running job that a restart finds stays `running`; it is only queued
    /// again.
    pub fn may_become(self, next: Self) -> bool {
        match self {
            Self::Accepted => matches!(next, Self::Running | Self::Paused | Self::Failed | Self::Dismissed),
            Self::Running => matches!(next, Self::Paused | Self::Successful | Self::Failed | Self::Dismissed),
            Self::Paused => matches!(next, Self::Accepted | Self::Dismissed),
            Self::Successful | Self::Failed | Self::Dismissed => false,
        }
    }

    /// Word for the status in answers and in the database.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Running => "running",
            Self::Paused => "paused",
            Self::Successful => "successful",
            Self::Failed => "failed",
            Self::Dismissed => "dismissed",
        }
    }

    pub(super) fn from_column(value: &str) -> Result<Self, StoreError> {
        Self::ALL
            .into_iter()
            .find(|status| status.as_str() == value)
            .ok_or_else(|| StoreError::Unknown { column: "jobs.status", value: value.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::JobStatus::{self, Accepted, Dismissed, Failed, Paused, Running, Successful};

    #[test]
    fn the_whole_table() {
        let allowed = [
            (Accepted, Running),
            (Accepted, Paused),
            (Accepted, Failed),
            (Accepted, Dismissed),
            (Running, Paused),
            (Running, Successful),
            (Running, Failed),
            (Running, Dismissed),
            (Paused, Accepted),
            (Paused, Dismissed),
        ];
        for from in JobStatus::ALL {
            for to in JobStatus::ALL {
                assert_eq!(from.may_become(to), allowed.contains(&(from, to)), "{from:?} → {to:?}");
            }
        }
    }

    #[test]
    fn final_means_that_nothing_follows() {
        for from in JobStatus::ALL {
            assert_eq!(
                from.is_final(),
                !JobStatus::ALL.into_iter().any(|to| from.may_become(to)),
                "{from:?}"
            );
        }
    }

    #[test]
    fn words_read_back() {
        for status in JobStatus::ALL {
            assert_eq!(JobStatus::from_column(status.as_str()).unwrap(), status);
        }
    }
}
