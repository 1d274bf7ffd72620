//! What users call their jobs and models.

use sqlx::Row;
use sqlx::sqlite::SqliteRow;

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

/// Sets the columns of the labels; takes the values of [`LabelChanges::columns`] as parameters 1 to 5.
pub(super) const SET: &str = "name = case when ?1 then ?2 else name end, tags = coalesce(?3, tags), notes = case when ?4 then ?5 else notes end";

impl LabelChanges {
    /// The parameters of [`SET`].
    pub(super) fn columns(
        self,
    ) -> Result<(bool, Option<String>, Option<String>, bool, Option<String>), StoreError> {
        let tags = self.tags.as_ref().map(serde_json::to_string).transpose()?;
        Ok((self.name.is_some(), self.name.flatten(), tags, self.notes.is_some(), self.notes.flatten()))
    }
}

/// What the column of tags has in it if `tag` is one of them, and otherwise not: tags are quoted and have no commas, so that no quote
/// in between two of them is taken for the first of one.
pub(super) fn quoted(tag: &str) -> Result<String, StoreError> {
    Ok(serde_json::to_string(tag)?)
}

pub(super) fn read(row: &SqliteRow) -> Result<Labels, StoreError> {
    Ok(Labels {
        name: row.try_get("name")?,
        tags: serde_json::from_str(row.try_get("tags")?)?,
        notes: row.try_get("notes")?,
    })
}
