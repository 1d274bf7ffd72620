//! What users call their jobs and models.

use sqlx::any::{AnyArguments, AnyRow};
use sqlx::query::Query;
use sqlx::{Any, AssertSqlSafe, Row};

use super::error::StoreError;

/// What an owner calls a job or a model, to find it again. Nothing is computed from it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Labels {
    /// A name, which need not be unique.
    pub name: Option<String>,
    /// Words to group by, without commas.
    pub tags: Vec<String>,
    /// Anything worth remembering.
    pub notes: Option<String>,
}

/// Changes of labels: `None` leaves what there is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LabelChanges {
    /// Another name, or none any more.
    pub name: Option<Option<String>>,
    /// Other tags in place of all.
    pub tags: Option<Vec<String>>,
    /// Other notes, or none any more.
    pub notes: Option<Option<String>>,
}

/// Sets the columns of the labels, by parameters 1 to 5.
const SET: &str = "name = case when $1 then $2 else name end, tags = coalesce($3, tags), notes = case when $4 then $5 else notes end";

impl LabelChanges {
    /// The statement that makes them in the rows of `table` that `whose` describes, with parameters from $6 on.
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

/// What the column of tags has in it if `tag` is one of them, and otherwise not: tags are quoted and have no commas, so that no quote
/// in between two of them is taken for the first of one.
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
