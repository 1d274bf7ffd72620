//! Calibrations: costs of time steps on each kind of machine.

use super::error::StoreError;
use super::handle::Store;
use super::time::now;
use crate::analysis::run::{Calibration, VERSION};

impl Store {
    /// Costs that this version of the program measured on such a machine, if it did.
    pub async fn calibration(&self, machine: &str) -> Result<Option<Calibration>, StoreError> {
        let body: Option<String> =
            sqlx::query_scalar("select body from calibrations where version = $1 and machine = $2")
                .bind(VERSION)
                .bind(machine)
                .fetch_optional(&self.readers)
                .await?;
        // An unreadable calibration is measured again.
        Ok(body.and_then(|body| serde_json::from_str(&body).ok()))
    }

    /// Stores the costs measured on such a machine, in place of earlier ones.
    pub async fn insert_calibration(&self, machine: &str, measured: &Calibration) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query(
            "insert into calibrations (version, machine, body, created_at) values ($1, $2, $3, $4)
             on conflict (version, machine) do update
             set body = excluded.body, created_at = excluded.created_at",
        )
        .bind(VERSION)
        .bind(machine)
        .bind(serde_json::to_string(measured)?)
        .bind(now())
        .execute(&mut *write)
        .await?;
        write.commit().await
    }
}
