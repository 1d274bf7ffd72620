//! Refusals of a fit.

use rubmap_model::impeller::ImpellerError;

/// Reason why a fit cannot be made; each names the field at fault.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Request that is no JSON, or has a field that is unknown, missing or of the wrong type.
    #[error("`{field}`: {message}")]
    Syntax {
        /// Path of the field, as `targets[2].speed`.
        field: String,
        /// Message of the JSON reader.
        message: String,
    },
    /// Wheel that the generator refuses.
    #[error("`wheel`: {0}")]
    Wheel(#[from] ImpellerError),
    /// Value outside its range.
    #[error("`{field}` = {value}: {requirement}")]
    Value {
        /// Path of the field.
        field: String,
        /// Value as given.
        value: String,
        /// Requirement on the value.
        requirement: &'static str,
    },
    /// Parameter that cannot vary.
    #[error("`vary.{name}`: {reason}")]
    Fixed {
        /// Name of the parameter.
        name: String,
        /// Reason, and what to do.
        reason: &'static str,
    },
    /// Target at a speed above that of the stiffness matrices.
    #[error(
        "`targets[{index}].speed` = {speed} rpm: above the wheel's `top_speed_rad_s`, which is {top:.1} rpm; raise that"
    )]
    AboveTop {
        /// Index of the target.
        index: usize,
        /// Speed of the target, rpm.
        speed: f64,
        /// Highest speed of the stiffness matrices, rpm.
        top: f64,
    },
    /// Two targets for the frequency of one mode at one speed.
    #[error(
        "`targets[{first}]` and `targets[{second}]` are of one mode at one speed (nodal diameter {nodal_diameter}, family {family}, speed \
         {speed}), with frequencies {first_frequency} and {second_frequency}, {percent:.3} % apart; give one of them, with their mean"
    )]
    SameMode {
        /// Index of the first of the targets.
        first: usize,
        /// Index of the second one.
        second: usize,
        /// Nodal diameter of both.
        nodal_diameter: usize,
        /// Family of both, from 1.
        family: usize,
        /// Speed of both.
        speed: f64,
        /// Frequency of the first.
        first_frequency: f64,
        /// Frequency of the second.
        second_frequency: f64,
        /// Difference of the frequencies, in % of the first.
        percent: f64,
    },
    /// Fewer targets than unknowns.
    #[error(
        "{targets} targets for {unknowns} unknowns ({names}): give more targets, or vary fewer parameters"
    )]
    TooFewTargets {
        /// Number of targets.
        targets: usize,
        /// Number of unknowns.
        unknowns: usize,
        /// Names of the unknowns.
        names: String,
    },
    /// Bounds in which no starting point gives a valid wheel.
    #[error("none of the {starts} starting points gives a valid wheel; at the first one: {message}")]
    NoStart {
        /// Number of starting points.
        starts: usize,
        /// Reason at the first starting point.
        message: String,
    },
}
