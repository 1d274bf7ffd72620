//! Errors of the stress of a speed.

use thiserror::Error;

use rubmap_numerics::hermitian::EigenError;

/// Reason why stress is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub(crate) enum StressError {
    #[error("an eigenvalue iteration failed")]
    Eigen(#[from] EigenError),
    #[error("it is not finite: the response, the static part or the stress of the reduction is not")]
    NotFinite,
}
