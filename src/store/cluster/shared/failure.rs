//! Errors of an object store, as errors of files.

use std::io::{self, ErrorKind};

use super::address::Address;

/// Error of an object store.
#[derive(Debug, thiserror::Error)]
#[error("object store {address}: {}{failure}", name.as_ref().map(|name| format!("{name}: ")).unwrap_or_default())]
struct ObjectError {
    address: Address,
    /// Name of the object; none where the error concerns the store.
    name: Option<String>,
    failure: Failure,
}

/// Kind of failure of an object store.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    /// Store that cannot be reached now, but may answer later.
    #[error("it cannot be reached or cannot serve now: {0}")]
    Away(String),
    /// Store that refuses access.
    #[error(
        "it refuses access: whose the keys are (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY), or who runs the service, must be allowed to \
         list, read, write and delete there"
    )]
    Denied,
    /// Object that does not exist.
    #[error("it is not there")]
    Absent,
    /// Bucket that does not exist.
    #[error("there is no such bucket: make it, or correct its name")]
    NoBucket,
    /// Shared folder without room.
    #[error("there is no room left: {0}")]
    Full(String),
    /// Object that ended before its length.
    #[error("it was cut off after {found} of {expected} bytes")]
    Cut {
        /// Number of bytes received.
        found: u64,
        /// Length of the object, bytes.
        expected: u64,
    },
    /// Settings that make no sense.
    #[error("{0}")]
    Settings(String),
}

impl Failure {
    /// Converts the failure to an error of a file, whose kind says whether it may pass.
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
