//! Why a computation gave no result.

use serde::{Deserialize, Serialize};

/// A demand of a request that cannot be met, at a JSON pointer into that request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[error("{pointer}: {message}")]
pub struct Violation {
    /// RFC 6901 pointer to the offending field, for example `/integration/steps_per_revolution`.
    pub pointer: String,
    /// What is wrong and what would be right.
    pub message: String,
}

impl Violation {
    /// A violation at `pointer`.
    pub fn new(pointer: impl Into<String>, message: impl Into<String>) -> Self {
        Self { pointer: pointer.into(), message: message.into() }
    }
}

/// Why a computation gave no result.
#[derive(Debug, Clone, thiserror::Error)]
pub enum AnalysisError {
    /// The monitor asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// The request asks for something impossible.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Refused(Vec<Violation>),
    /// The model cannot be reduced or evaluated: the message says at which harmonic and speed, and why.
    #[error("{0}")]
    Model(#[from] rubmap_wheel::dynamics::error::ModelError),
    /// The reduction needs more memory than it may take.
    #[error("the reduction needs about {} of memory and may take {}", Bytes(*.needed_bytes), Bytes(*.allowed_bytes))]
    Memory {
        /// Estimated peak.
        needed_bytes: u64,
        /// What it was allowed.
        allowed_bytes: u64,
    },
}

/// Bytes in words.
struct Bytes(u64);

impl std::fmt::Display for Bytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mib = self.0 as f64 / f64::from(1 << 20);
        if mib < 1024.0 { write!(f, "{mib:.1} MiB") } else { write!(f, "{:.1} GiB", mib / 1024.0) }
    }
}
