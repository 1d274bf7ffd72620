//! Why a finite-element model could not be made.

use crate::package::error::ManifestProblem;

/// Refusals of the generator; each names the field or the element at fault.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpellerError {
    /// A parameter lies outside its range.
    #[error("parameter `{field}` = {value}: {requirement}")]
    Parameter {
        /// Field of the parameter set.
        field: &'static str,
        /// Its value, as given.
        value: String,
        /// What it must satisfy.
        requirement: &'static str,
    },
    /// A field of a parameter set is unknown, is of the wrong type, or names units that do not fit.
    #[error("parameter `{field}`: {problem}")]
    Field {
        /// Path of the field, as `mesh.disk`.
        field: String,
        /// What is wrong with it.
        problem: FieldProblem,
    },
    /// An element is turned inside out or collapsed.
    #[error(
        "element {element} near r = {radius:.4}, z = {axial:.4} is degenerate or turned inside out (smallest Jacobian \
         determinant {determinant:.3e}): use a finer mesh there, or less wrap, backsweep or thickness"
    )]
    Jacobian {
        /// Number of the element, from 1.
        element: usize,
        /// Radius of its centre.
        radius: f64,
        /// Axial position of its centre.
        axial: f64,
        /// Smallest Jacobian determinant over its corners and points of integration.
        determinant: f64,
    },
    /// The stiffness matrix at rest has no Cholesky factor.
    #[error("the sector's stiffness at rest is not positive definite: is anything clamped?")]
    NotPositiveDefinite,
}

/// What is wrong with a field, apart from its range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FieldProblem {
    /// Unknown, lacking or of the wrong type.
    #[error("{message}")]
    Syntax {
        /// The JSON reader's words, shortened.
        message: String,
    },
    /// A list, which serde would take for an object with its fields in order.
    #[error("expected no list here, but a value or an object with named fields")]
    List,
    /// Units without a name, or that do not fit each other.
    #[error(transparent)]
    Units(#[from] ManifestProblem),
}
