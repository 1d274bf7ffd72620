//! Tables of a data folder, as its database describes them.

use std::collections::BTreeSet;

use sqlx::AnyConnection;

use super::error::CopyError;
use crate::store::error::StoreError;

/// Tables that are not copied: the history of migrations, which the other database has of its own, and the probe of readiness.
pub(super) const LEFT_OUT: [&str; 2] = ["_sqlx_migrations", "readiness"];

/// Table to be copied.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) name: String,
    pub(super) columns: Vec<Column>,
}

/// Column of a table.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Whether the column belongs to the primary key.
    pub(super) is_key: bool,
}

/// Type of the values of a column, which may be null as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Integer,
    Real,
    Text,
    Blob,
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "integer" => Self::Integer,
            "real" => Self::Real,
            "text" => Self::Text,
            "blob" => Self::Blob,
            _ => return None,
        })
    }
}

/// Tables to be copied, each after those that its rows refer to.
pub(super) async fn tables(source: &mut AnyConnection) -> Result<Vec<Table>, CopyError> {
    let names = "select name from sqlite_master where type = 'table' and name not like 'sqlite\\_%' escape '\\' order by name";
    let names: Vec<String> =
        sqlx::query_scalar(names).fetch_all(&mut *source).await.map_err(StoreError::from)?;
    let mut waiting = Vec::new();
    for name in names.into_iter().filter(|name| !LEFT_OUT.contains(&name.as_str())) {
        let references = "select \"table\" from pragma_foreign_key_list($1)";
        let references = sqlx::query_scalar(references).bind(name.clone()).fetch_all(&mut *source).await;
        let references: BTreeSet<String> = references.map_err(StoreError::from)?.into_iter().collect();
        let columns = columns(source, &name).await?;
        waiting.push((Table { name, columns }, references));
    }
    let mut ordered: Vec<Table> = Vec::new();
    while let Some(next) = waiting
        .iter()
        .position(|(_, needed)| needed.iter().all(|name| ordered.iter().any(|t| t.name == *name)))
    {
        ordered.push(waiting.remove(next).0);
    }
    // The other database would refuse circular references row by row.
    ordered.extend(waiting.into_iter().map(|(table, _)| table));
    Ok(ordered)
}

async fn columns(source: &mut AnyConnection, table: &str) -> Result<Vec<Column>, CopyError> {
    let columns = "select name, lower(type), pk from pragma_table_info($1)";
    let columns = sqlx::query_as(columns).bind(table.to_owned()).fetch_all(source).await;
    let columns: Vec<(String, String, i64)> = columns.map_err(StoreError::from)?;
    columns
        .into_iter()
        .map(|(name, kind, key)| match Kind::of(&kind) {
            Some(kind) => Ok(Column { name, kind, is_key: key > 0 }),
            None => Err(CopyError::Column { table: table.to_owned(), column: name, kind }),
        })
        .collect()
}
