//! Copy of a data folder into the database and the object store that the processes of a cluster share.
//!
//! Files go first, one by one, and files that are there already are left out: an interrupted copy continues with the next file. Rows go in
//! one transaction, read back and compared before it ends: services and workers that run meanwhile see a job with all its results or not at
//! all. Existing rows and objects are never overwritten.

mod error;
mod files;
mod rows;
mod tables;
mod tally;

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::Path;

use sqlx::{AnyConnection, ConnectOptions, Connection};

pub use self::error::CopyError;
use self::error::Differences;
pub use self::tally::{Copied, CopyProgress};
use super::address::Address;
use crate::store::backup::expect_data_folder;
use crate::store::error::StoreError;
use crate::store::handle::LOCK;
use crate::store::objects::Objects;
use crate::store::reserve::Reserve;
use crate::store::{postgres, sqlite};

/// Copies all contents of the data folder `data`, on which no service may run, into the database at `url`, which is brought up to date, and
/// the object store at `address`. The folder is only read. Unfinished jobs wait there for a worker.
///
/// # Errors
/// Existing rows or objects that differ from those of the folder; no row is copied then.
pub async fn copy(
    data: &Path,
    url: &str,
    address: &Address,
    mut progress: impl FnMut(CopyProgress),
) -> Result<Copied, CopyError> {
    expect_data_folder(data)?;
    let _lock = lock(data)?;
    let mut source = sqlite::address(data, "ro")?.connect().await.map_err(StoreError::from)?;
    expect_up_to_date(&mut source).await?;
    postgres::migrate(url).await?;
    let objects = Objects::open(address, data, Reserve::of(data)).await.map_err(StoreError::Objects)?;

    let mut copied = Copied::default();
    let mut differences = Differences::default();
    files::copy(data, &mut source, &objects, &mut copied, &mut differences, &mut progress).await?;
    let mut target = postgres::connect(url).await?;
    let mut transaction = target.begin().await.map_err(StoreError::from)?;
    rows::copy(&mut source, &mut transaction, &mut copied, &mut differences, &mut progress).await?;
    differences.expect_none()?;
    transaction.commit().await.map_err(StoreError::from)?;
    source.close().await.map_err(StoreError::from)?;
    target.close().await.map_err(StoreError::from)?;
    Ok(copied)
}

/// Locks the data folder as a service does; none where no service has ever run, as in a backup.
fn lock(data: &Path) -> Result<Option<File>, CopyError> {
    let file = match File::open(data.join(LOCK)) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        file => file.map_err(StoreError::from)?,
    };
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(CopyError::InUse(data.to_owned())),
        Err(TryLockError::Error(error)) => Err(StoreError::from(error).into()),
    }
}

async fn expect_up_to_date(source: &mut AnyConnection) -> Result<(), CopyError> {
    let (found, known) = (sqlite::version(source).await?, sqlite::known_version());
    if found == known { Ok(()) } else { Err(CopyError::Version { found, known }) }
}
