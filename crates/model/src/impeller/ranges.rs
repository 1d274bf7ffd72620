//! Checks of ranges, for parameters of any set.

use super::error::ImpellerError;

/// Refuses values that are not finite and positive.
pub(super) fn positive(field: &'static str, value: f64) -> Result<(), ImpellerError> {
    above(field, value, 0.0, "must be a positive number")
}

/// Refuses values that are not finite and above `bound`.
pub(super) fn above(
    field: &'static str,
    value: f64,
    bound: f64,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if value.is_finite() && value > bound {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}

/// Refuses values outside a closed range.
pub(super) fn inside(
    field: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}

/// Refuses counts below `least`.
pub(super) fn at_least(
    field: &'static str,
    value: usize,
    least: usize,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if value >= least {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}
