//! Addresses of object stores.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// Address of an object store: `s3://bucket/prefix`, `file:///folder`, or a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Address {
    /// Bucket whose objects are used if their names begin with the prefix and a slash; all where the prefix is empty.
    Bucket {
        /// Name of the bucket.
        bucket: String,
        /// Prefix of the names, without slashes at its ends.
        prefix: String,
    },
    /// Folder that several machines see.
    Folder(PathBuf),
}

/// Error of an invalid address of an object store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AddressError {
    /// Scheme that is not supported.
    #[error("it begins with s3:// or file:///, or is a folder")]
    Scheme,
    /// Bucket that is missing, or has more than its name.
    #[error(
        "s3:// is followed by the name of a bucket and, if need be, a slash and a prefix; keys and the endpoint are taken from the \
         environment (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, AWS_ENDPOINT)"
    )]
    Bucket,
    /// Prefix that object names would not preserve.
    #[error("a prefix has no empty parts, no `.` and no `..` between its slashes")]
    Prefix,
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        if let Some(rest) = text.strip_prefix("s3://") {
            let (bucket, prefix) = rest.split_once('/').unwrap_or((rest, ""));
            let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_');
            if bucket.is_empty() || !bucket.chars().all(is_name) {
                return Err(AddressError::Bucket);
            }
            let prefix = prefix.trim_matches('/');
            if !prefix.is_empty() && prefix.split('/').any(|part| matches!(part, "" | "." | "..")) {
                return Err(AddressError::Prefix);
            }
            return Ok(Self::Bucket { bucket: bucket.to_owned(), prefix: prefix.to_owned() });
        }
        match text.strip_prefix("file://") {
            Some(path) if path.starts_with('/') => Ok(Self::Folder(path.into())),
            None if !text.is_empty() && !text.contains("://") => Ok(Self::Folder(text.into())),
            _ => Err(AddressError::Scheme),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bucket { bucket, prefix } if prefix.is_empty() => write!(f, "s3://{bucket}"),
            Self::Bucket { bucket, prefix } => write!(f, "s3://{bucket}/{prefix}"),
            Self::Folder(folder) => folder.display().fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_and_folders_are_told_apart() {
        let bucket = |bucket: &str, prefix: &str| {
            Ok(Address::Bucket { bucket: bucket.to_owned(), prefix: prefix.to_owned() })
        };
        let folder = |path: &str| Ok(Address::Folder(path.into()));
        for (text, expected) in [
            ("s3://wheels", bucket("wheels", "")),
            ("s3://wheels/", bucket("wheels", "")),
            ("s3://wheels/a/b/", bucket("wheels", "a/b")),
            ("file:///mnt/wheels", folder("/mnt/wheels")),
            ("/mnt/wheels", folder("/mnt/wheels")),
            ("wheels", folder("wheels")),
            ("", Err(AddressError::Scheme)),
            ("file://wheels", Err(AddressError::Scheme)),
            ("gs://wheels", Err(AddressError::Scheme)),
            ("s3://", Err(AddressError::Bucket)),
            ("s3://key:secret@wheels", Err(AddressError::Bucket)),
            ("s3://wheels/a//b", Err(AddressError::Prefix)),
            ("s3://wheels/../b", Err(AddressError::Prefix)),
        ] {
            assert_eq!(text.parse::<Address>(), expected, "{text}");
        }
        assert_eq!("s3://wheels/a/".parse::<Address>().unwrap().to_string(), "s3://wheels/a");
    }
}
