//! Answers to requests with an `Idempotency-Key`, to be repeated when the POST is repeated.

use sqlx::{AnyConnection, Row};

use super::error::StoreError;
use super::handle::Store;
use super::sql::number;
use super::time::{now, timestamp};

/// Number of days after which a key may be used for another request.
pub const KEPT_DAYS: i64 = 7;

/// Answer with the request it belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// Owner of the key.
    pub owner: String,
    /// Idempotency key that the client chose.
    pub key: String,
    /// Digest of route and body of the request.
    pub fingerprint: String,
    /// HTTP status.
    pub status: u16,
    /// `Location` header.
    pub location: String,
    /// JSON body.
    pub body: String,
}

impl Store {
    /// Finds the answer given under the `key` of `owner`.
    pub async fn answer(&self, owner: &str, key: &str) -> Result<Option<Answer>, StoreError> {
        let row =
            sqlx::query("select * from idempotency_keys where owner = $1 and key = $2 and created_at > $3")
                .bind(owner)
                .bind(key)
                .bind(expiry())
                .fetch_optional(&self.readers)
                .await?;
        row.map(|row| {
            Ok(Answer {
                owner: row.try_get("owner")?,
                key: row.try_get("key")?,
                fingerprint: row.try_get("fingerprint")?,
                status: number(&row, "status")?,
                location: row.try_get("location")?,
                body: row.try_get("body")?,
            })
        })
        .transpose()
    }

    /// Stores `answer` for repetition. False if its key was taken meanwhile.
    pub async fn insert_answer(&self, answer: &Answer) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        let inserted = insert(&mut transaction, answer).await?;
        transaction.commit().await?;
        Ok(inserted)
    }
}

/// Stores `answer` within a transaction. False if its key was taken meanwhile.
pub(super) async fn insert(connection: &mut AnyConnection, answer: &Answer) -> Result<bool, StoreError> {
    sqlx::query("delete from idempotency_keys where created_at <= $1")
        .bind(expiry())
        .execute(&mut *connection)
        .await?;
    let inserted = sqlx::query(
        "insert into idempotency_keys (owner, key, fingerprint, status, location, body, created_at)
         values ($1, $2, $3, $4, $5, $6, $7) on conflict (owner, key) do nothing",
    )
    .bind(&answer.owner)
    .bind(&answer.key)
    .bind(&answer.fingerprint)
    .bind(i64::from(answer.status))
    .bind(&answer.location)
    .bind(&answer.body)
    .bind(now())
    .execute(connection)
    .await?;
    Ok(inserted.rows_affected() == 1)
}

fn expiry() -> String {
    timestamp(chrono::Utc::now() - chrono::TimeDelta::days(KEPT_DAYS))
}
