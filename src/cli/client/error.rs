//! Why a service did not do what it was asked.

use std::error::Error;
use std::time::Duration;

use reqwest::StatusCode;
use serde_json::Value;

use super::problem::Problem;

/// Kind of problem of a path that the service does not have.
const NO_ROUTE: &str = "urn:rubmap:problem:not-found";

/// Why a service did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum ClientError {
    /// There was no connection, or it broke.
    #[error("{server} does not answer: {cause}")]
    Unreachable {
        /// Its address.
        server: String,
        /// In the words of the system.
        cause: String,
    },
    /// The service answered with a problem.
    #[error("{path}: {status}: {problem}")]
    Refused {
        /// Path of the request.
        path: String,
        /// Status of the answer.
        status: StatusCode,
        /// The problem, as far as it is shown.
        problem: Box<Problem>,
        /// All of it.
        body: Value,
    },
    /// The answer is none of a rubmap service.
    #[error("{url} does not answer as a rubmap service does ({status})\n  {cause}")]
    Strange {
        /// Where it came from.
        url: String,
        /// Its status.
        status: StatusCode,
        /// What is strange about it.
        cause: String,
    },
    /// What was named is not there, is several things, or is not as it would have to be.
    #[error("{0}")]
    Unfit(String),
}

impl ClientError {
    /// No answer from a server.
    pub(super) fn unreachable(server: &str, error: &reqwest::Error) -> Self {
        Self::Unreachable { server: server.to_owned(), cause: innermost(error) }
    }

    /// Whether the same request may succeed in a moment.
    pub(super) fn may_pass(&self) -> bool {
        match self {
            Self::Unreachable { .. } => true,
            Self::Refused { status, .. } | Self::Strange { status, .. } => [
                StatusCode::TOO_MANY_REQUESTS,
                StatusCode::BAD_GATEWAY,
                StatusCode::SERVICE_UNAVAILABLE,
                StatusCode::GATEWAY_TIMEOUT,
            ]
            .contains(status),
            Self::Unfit(_) => false,
        }
    }

    /// How long the service wants it left alone.
    pub(super) fn retry_after(&self) -> Option<Duration> {
        match self {
            Self::Refused { problem, .. } => {
                problem.retry_after_s.map(|seconds| Duration::from_secs(seconds.into()))
            }
            _ => None,
        }
    }

    /// Whether the service does not know the path, such as one of an earlier version.
    pub(in crate::cli) fn is_no_route(&self) -> bool {
        matches!(self, Self::Refused { problem, .. } if problem.r#type == NO_ROUTE)
    }

    /// Whether the fault lies with the request, and not with the service or the way to it.
    pub(in crate::cli) fn is_refusal(&self) -> bool {
        match self {
            Self::Refused { status, .. } => {
                status.is_client_error() && *status != StatusCode::TOO_MANY_REQUESTS
            }
            Self::Unfit(_) => true,
            Self::Unreachable { .. } | Self::Strange { .. } => false,
        }
    }
}

/// The words of the cause that has no other, which says most.
fn innermost(error: &reqwest::Error) -> String {
    let mut cause: &dyn Error = error;
    while let Some(next) = cause.source() {
        cause = next;
    }
    cause.to_string()
}
