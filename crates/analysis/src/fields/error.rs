//! Errors of fields.

use rubmap_wheel::dynamics::error::ModelError;

/// Reason why a field cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FieldError {
    /// Parameter with a value that does not exist.
    #[error("{parameter}: {message}")]
    Parameter {
        /// Name of the parameter.
        parameter: &'static str,
        /// Values that would be valid.
        message: String,
    },
    /// Error of the reduced wheel, which cannot be evaluated.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Error of reading the basis.
    #[error("the basis cannot be read: {0}")]
    Basis(#[from] std::io::Error),
}

impl FieldError {
    /// Error of a `parameter` with a wrong value.
    pub(super) fn parameter(parameter: &'static str, message: impl Into<String>) -> Self {
        Self::Parameter { parameter, message: message.into() }
    }
}
