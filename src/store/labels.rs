//! Labels that users give their jobs and models.

use sqlx::any::{AnyArguments, AnyRow};
use sqlx::query::Query;
use sqlx::{Any, AssertSqlSafe, Row};

use super::error::StoreError;

/// Labels that an owner gives a job or a model, to find it again. Nothing is computed from them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Labels {
    /// Name, which need not be unique.
    pub name: Option<String>,
    /// Tags to group by, without commas.
    pub tags: Vec<String>,
    /// Notes of any kind.
    pub notes: Option<String>,
}

/// Changes of labels: `None` leaves a label as it is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LabelChanges {
    /// New name, or none any more.
    pub name: Option<Option<String>>,
    /// New tags in place of all.
    pub tags: Option<Vec<String>>,
    /// New notes, or none any more.
    pub notes: Option<Option<String>>,
}

/// Assignments of the columns of the labels, by parameters 1 to 5.
const SET: &str = "name = case when $1 then $2 else name end, tags = coalesce($3, tags), notes = case when $4 then $5 else notes end";

impl LabelChanges {
    /// Statement that makes the changes in the rows of `table` that `whose` selects, with parameters from $6 on.
    pub(super) fn update(
        self,
        table: &str,
        whose: &str,
    ) -> Result<Query<'static, Any, AnyArguments>, StoreError> {
        let tags = self.tags.as_ref().map(serde_json::to_string).transpose()?;
        Ok(sqlx::query(AssertSqlSafe(format!("update {table} set {SET} where {whose}")))
            .bind(self.name.is_some())
            .bind(self.name.flatten())
            .bind(tags)
            .bind(self.notes.is_some())
            .bind(self.notes.flatten()))
    }
}

/// Text that the column of tags contains exactly if `tag` is one of them: tags are quoted and have no commas, so that a quote between two
/// tags is never taken for the beginning of one.
pub(super) fn quoted(tag: &str) -> Result<String, StoreError> {
    Ok(serde_json::to_string(tag)?)
}

pub(super) fn read(row: &AnyRow) -> Result<Labels, StoreError> {
    Ok(Labels {
        name: row.try_get("name")?,
        tags: serde_json::from_str(row.try_get("tags")?)?,
        notes: row.try_get("notes")?,
    })
}
