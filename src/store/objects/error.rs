//! What goes wrong with an object store, as errors of files.

use std::io::{self, ErrorKind};

use super::address::Address;

/// Something of an object store failed.
#[derive(Debug, thiserror::Error)]
#[error("object store {address}: {}{failure}", name.as_ref().map(|name| format!("{name}: ")).unwrap_or_default())]
struct ObjectError {
    address: Address,
    /// The object; none where it is about the store.
    name: Option<String>,
    failure: Failure,
}

/// What failed.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    /// It may answer later.
    #[error("it cannot be reached or cannot serve now: {0}")]
    Away(String),
    /// The store refuses.
    #[error(
        "it refuses access: whose the keys are (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY), or who runs the service, must be allowed to \
         list, read, write and delete there"
    )]
    Denied,
    /// There is nothing of that name.
    #[error("it is not there")]
    Absent,
    /// There is no store.
    #[error("there is no such bucket: make it, or correct its name")]
    NoBucket,
    /// A shared folder has no room.
    #[error("there is no room left: {0}")]
    Full(String),
    /// It ended before its length.
    #[error("it was cut off after {found} of {expected} bytes")]
    Cut {
        /// Bytes that came.
        found: u64,
        /// Its length.
        expected: u64,
    },
    /// Settings that make no sense.
    #[error("{0}")]
    Settings(String),
}

impl Failure {
    /// As an error of a file: its kind says whether it may pass.
    pub(super) fn of(self, address: &Address, name: Option<&str>) -> io::Error {
        let kind = match &self {
            Self::Away(_) | Self::Cut { .. } => ErrorKind::HostUnreachable,
            Self::Denied => ErrorKind::PermissionDenied,
            Self::Absent | Self::NoBucket => ErrorKind::NotFound,
            Self::Full(_) => ErrorKind::StorageFull,
            Self::Settings(_) => ErrorKind::InvalidInput,
        };
        let (address, name) = (address.clone(), name.map(ToOwned::to_owned));
        io::Error::new(kind, ObjectError { address, name, failure: self })
    }
}
