//! Reasons why a service did not do what it was asked.

use std::error::Error;
use std::time::Duration;

use reqwest::StatusCode;
use serde_json::Value;

use super::problem::Problem;

/// Kind of problem of a path that the service does not have.
const NO_ROUTE: &str = "urn:rubmap:problem:not-found";

/// Reason why a service did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum ClientError {
    /// No connection, or one that broke.
    #[error("{server} does not answer: {cause}")]
    Unreachable {
        /// Address of the service.
        server: String,
        /// Cause in the words of the system.
        cause: String,
    },
    /// Answer of the service with a problem.
    #[error("{path}: {status}: {problem}")]
    Refused {
        /// Path of the request.
        path: String,
        /// Status of the answer.
        status: StatusCode,
        /// Problem, as far as it is shown.
        problem: Box<Problem>,
        /// Body of the answer, the whole problem.
        body: Value,
    },
    /// Answer that does not come from a rubmap service.
    #[error("{url} does not answer as a rubmap service does ({status})\n  {cause}")]
    Strange {
        /// URL of the answer.
        url: String,
        /// Status of the answer.
        status: StatusCode,
        /// Description of what is strange about the answer.
        cause: String,
    },
    /// Named model, job or result that is not there, is ambiguous, or does not fit the command.
    #[error("{0}")]
    Unfit(String),
}

impl ClientError {
    /// Error of a server that gives no answer.
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

    /// Time for which the service asks to be left alone.
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

/// Words of the innermost cause, which say most.
fn innermost(error: &reqwest::Error) -> String {
    let mut cause: &dyn Error = error;
    while let Some(next) = cause.source() {
        cause = next;
    }
    cause.to_string()
}
