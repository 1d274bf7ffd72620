//! Why there is no field.

use rubmap_wheel::dynamics::error::ModelError;

/// Why there is no field.
#[derive(Debug, thiserror::Error)]
pub enum FieldError {
    /// A parameter that names nothing that is there.
    #[error("{parameter}: {message}")]
    Parameter {
        /// Its name.
        parameter: &'static str,
        /// What would be right.
        message: String,
    },
    /// The wheel cannot be evaluated.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The basis cannot be read.
    #[error("the basis cannot be read: {0}")]
    Basis(#[from] std::io::Error),
}

impl FieldError {
    /// A parameter that is wrong.
    pub(super) fn parameter(parameter: &'static str, message: impl Into<String>) -> Self {
        Self::Parameter { parameter, message: message.into() }
    }
}
