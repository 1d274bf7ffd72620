//! Rows of a data folder, copied into the tables of a server.

use std::collections::HashMap;

use futures::TryStreamExt;
use sqlx::any::AnyRow;
use sqlx::{AnyConnection, AssertSqlSafe, Row};

use super::error::{CopyError, Differences};
use super::tables::{Column, Kind, Table, tables};
use super::tally::{Copied, CopyProgress};
use crate::store::error::StoreError;

/// Largest number of rows sent at once: a statement takes 65,535 values.
const ROWS: usize = 100;

/// Size in bytes from which a batch of rows is sent.
const BYTES: usize = 8 << 20;

/// Table whose existing rows stay: costs measured by the processes there are as good.
const MEASURED: &str = "calibrations";

/// Value of a row.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Value {
    Integer(Option<i64>),
    /// Bits of the number.
    Real(Option<u64>),
    Text(Option<String>),
    Blob(Option<Vec<u8>>),
}

/// Copies all rows of `source` that `target` lacks, and checks that `target` has what was sent.
pub(super) async fn copy(
    source: &mut AnyConnection,
    target: &mut AnyConnection,
    copied: &mut Copied,
    differences: &mut Differences,
    progress: &mut impl FnMut(CopyProgress),
) -> Result<(), CopyError> {
    let tables = tables(source).await?;
    let mut total = 0;
    for table in &tables {
        let rows = count(source, table).await?;
        match table.name.as_str() {
            "models" => copied.models = rows,
            "jobs" => copied.jobs = rows,
            _ => {}
        }
        total += rows;
    }
    for table in &tables {
        let select = select(table);
        let mut rows = sqlx::query(AssertSqlSafe(select)).fetch(&mut *source);
        let mut batch = Batch { table, rows: Vec::new(), bytes: 0 };
        loop {
            let row = rows.try_next().await.map_err(StoreError::from)?;
            let is_last = row.is_none();
            if let Some(row) = row {
                batch.add(read(table, &row)?);
            }
            if batch.is_full() || is_last {
                copied.new_rows += batch.send(target, differences).await?;
                copied.rows += batch.rows.len() as u64;
                progress(CopyProgress::Rows(copied.rows, total));
                batch = Batch { table, rows: Vec::new(), bytes: 0 };
            }
            if is_last {
                break;
            }
        }
    }
    Ok(())
}

async fn count(source: &mut AnyConnection, table: &Table) -> Result<u64, StoreError> {
    let count = format!("select count(*) from \"{}\"", table.name);
    let rows: i64 = sqlx::query_scalar(AssertSqlSafe(count)).fetch_one(source).await?;
    Ok(rows.unsigned_abs())
}

/// Query of all rows in the order of their insertion, in which models are listed. Running jobs become accepted, as nobody computes them
/// yet.
fn select(table: &Table) -> String {
    let columns = table.columns.iter().map(|column| match (table.name.as_str(), column.name.as_str()) {
        ("jobs", "status") => "case status when 'running' then 'accepted' else status end".to_owned(),
        (_, name) => format!("\"{name}\""),
    });
    let columns: Vec<String> = columns.collect();
    format!("select {} from \"{}\" order by rowid", columns.join(", "), table.name)
}

fn read(table: &Table, row: &AnyRow) -> Result<Vec<Value>, StoreError> {
    let values = table.columns.iter().enumerate().map(|(at, column)| {
        Ok(match column.kind {
            Kind::Integer => Value::Integer(row.try_get(at)?),
            Kind::Real => Value::Real(row.try_get::<Option<f64>, _>(at)?.map(f64::to_bits)),
            Kind::Text => Value::Text(row.try_get(at)?),
            Kind::Blob => Value::Blob(row.try_get(at)?),
        })
    });
    values.collect()
}

/// Rows that are sent at once.
struct Batch<'a> {
    table: &'a Table,
    rows: Vec<Vec<Value>>,
    bytes: usize,
}

impl Batch<'_> {
    fn add(&mut self, row: Vec<Value>) {
        self.bytes += row.iter().map(Value::bytes).sum::<usize>();
        self.rows.push(row);
    }

    fn is_full(&self) -> bool {
        self.rows.len() >= ROWS || self.bytes >= BYTES
    }

    /// Inserts the rows that `target` lacks, and compares all. Returns the number of new ones.
    async fn send(
        &self,
        target: &mut AnyConnection,
        differences: &mut Differences,
    ) -> Result<u64, StoreError> {
        if self.rows.is_empty() {
            return Ok(0);
        }
        let names = names(self.table.columns.iter());
        let insert = format!(
            "insert into \"{}\" ({names}) values {} on conflict do nothing",
            self.table.name,
            places(self.rows.len(), self.table.columns.len()),
        );
        let inserted = bound(insert, self.rows.iter().flatten()).execute(&mut *target).await?;
        if self.table.name == MEASURED {
            return Ok(inserted.rows_affected());
        }
        let keys = self.table.columns.iter().filter(|column| column.is_key);
        let select = format!(
            "select {names} from \"{}\" where ({}) in ({})",
            self.table.name,
            self::names(keys.clone()),
            places(self.rows.len(), keys.count()),
        );
        let keys: Vec<Vec<Value>> = self.rows.iter().map(|row| self.key(row)).collect();
        let found = bound(select, keys.iter().flatten()).fetch_all(target).await?;
        let mut there = HashMap::new();
        for row in found {
            let row = read(self.table, &row)?;
            there.insert(self.key(&row), row);
        }
        for (key, row) in keys.iter().zip(&self.rows) {
            if there.get(key) != Some(row) {
                differences.add(|| self.name(key));
            }
        }
        Ok(inserted.rows_affected())
    }

    fn key(&self, row: &[Value]) -> Vec<Value> {
        let values = self.table.columns.iter().zip(row);
        values.filter(|(column, _)| column.is_key).map(|(_, value)| value.clone()).collect()
    }

    /// Name of a row: its table and key.
    fn name(&self, key: &[Value]) -> String {
        let keys = self.table.columns.iter().filter(|column| column.is_key).zip(key);
        let keys: Vec<String> = keys.map(|(column, value)| format!("{} {value}", column.name)).collect();
        format!("{} {}", self.table.name, keys.join(", "))
    }
}

fn names<'a>(columns: impl Iterator<Item = &'a Column>) -> String {
    columns.map(|column| format!("\"{}\"", column.name)).collect::<Vec<_>>().join(", ")
}

/// Placeholders for the values of `rows` rows of `columns` columns.
fn places(rows: usize, columns: usize) -> String {
    let row = |row: usize| {
        let places: Vec<String> =
            (1..=columns).map(|column| format!("${}", row * columns + column)).collect();
        format!("({})", places.join(", "))
    };
    (0..rows).map(row).collect::<Vec<_>>().join(", ")
}

fn bound<'a>(
    statement: String,
    values: impl Iterator<Item = &'a Value>,
) -> sqlx::query::Query<'static, sqlx::Any, sqlx::any::AnyArguments> {
    let statement = sqlx::query(AssertSqlSafe(statement));
    values.fold(statement, |statement, value| match value.clone() {
        Value::Integer(value) => statement.bind(value),
        Value::Real(value) => statement.bind(value.map(f64::from_bits)),
        Value::Text(value) => statement.bind(value),
        Value::Blob(value) => statement.bind(value),
    })
}

impl Value {
    fn bytes(&self) -> usize {
        match self {
            Self::Text(Some(text)) => text.len(),
            Self::Blob(Some(bytes)) => bytes.len(),
            _ => size_of::<u64>(),
        }
    }
}

/// Display of key values in names of rows: always present and short.
impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integer(Some(value)) => value.fmt(f),
            Self::Text(Some(value)) => value.fmt(f),
            other => write!(f, "{other:?}"),
        }
    }
}
