//! Errors of the finite-element generator.

use crate::assembly::CanMove;
use crate::package::error::ManifestProblem;

/// Refusals of the generator; each names the field or the element at fault.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpellerError {
    /// Parameter outside its range.
    #[error("parameter `{field}` = {value}: {requirement}")]
    Parameter {
        /// Field of the parameter set.
        field: &'static str,
        /// Value of the parameter, as given.
        value: String,
        /// Requirement on the parameter.
        requirement: &'static str,
    },
    /// Field of a parameter set that is unknown or of the wrong type, or that names units that do not fit.
    #[error("parameter `{field}`: {problem}")]
    Field {
        /// Path of the field, as `mesh.disk`.
        field: String,
        /// Problem of the field.
        problem: FieldProblem,
    },
    /// Element that is turned inside out or collapsed.
    #[error(
        "element {element} near r = {radius:.4}, z = {axial:.4} is degenerate or turned inside out (smallest Jacobian \
         determinant {determinant:.3e}): use a finer mesh there, or less wrap, backsweep or thickness"
    )]
    Jacobian {
        /// Number of the element, from 1.
        element: usize,
        /// Radius of the element's centre.
        radius: f64,
        /// Axial position of the element's centre.
        axial: f64,
        /// Smallest Jacobian determinant over the element's corners and integration points.
        determinant: f64,
    },
    /// Sector that can move as a rigid body.
    #[error(transparent)]
    CanMove(#[from] CanMove),
}

/// Problem of a field, apart from its range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FieldProblem {
    /// Field that is unknown, missing or of the wrong type.
    #[error("{message}")]
    Syntax {
        /// Message of the JSON reader, shortened.
        message: String,
    },
    /// List, which serde would take for an object with its fields in order.
    #[error("expected no list here, but a value or an object with named fields")]
    List,
    /// Units without a name, or that do not fit each other.
    #[error(transparent)]
    Units(#[from] ManifestProblem),
}
