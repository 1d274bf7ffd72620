//! Numbers of the database, all of which are 64-bit integers, and lists in its statements.

use sqlx::Row;
use sqlx::any::AnyRow;

use super::error::StoreError;
use crate::analysis::kinds::kind::Units;
use crate::kinds::names_of;

/// Kinds whose jobs are computed in these units, as a list in a statement.
pub(super) fn kinds_of(units: Units) -> String {
    let names: Vec<String> = names_of(units).map(|name| format!("'{name}'")).collect();
    format!("({})", names.join(", "))
}

/// Number in a column of `row`.
pub(super) fn number<T: TryFrom<i64>>(row: &AnyRow, column: &'static str) -> Result<T, StoreError> {
    of(column, row.try_get(column)?)
}

/// Converts a number that `column` holds.
pub(super) fn of<T: TryFrom<i64>>(column: &'static str, value: i64) -> Result<T, StoreError> {
    T::try_from(value).map_err(|_| StoreError::Unknown { column, value: value.to_string() })
}
