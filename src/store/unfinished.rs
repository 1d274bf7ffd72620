//! Unfinished files, which have no final name yet.

use std::fs::File;
use std::io;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

use tempfile::NamedTempFile;

/// Prefix of the names of files that are being written.
pub(super) const UNFINISHED: &str = "unfinished-";

/// Creates an empty file in `folder` whose name begins with `prefix`, removed when dropped.
///
/// Opened here, because `tempfile` wraps errors of the system, and a lack of descriptors is recognised as passing only by its number.
pub(super) fn unfinished_file(folder: &Path, prefix: &str) -> io::Result<NamedTempFile> {
    let open = |path: &Path| File::options().read(true).write(true).create_new(true).mode(0o600).open(path);
    tempfile::Builder::new().prefix(prefix).make_in(folder, open)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_keeps_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let error = unfinished_file(&folder.path().join("absent"), "a").unwrap_err();
        assert_eq!(error.raw_os_error(), Some(2), "{error:?}");
        let file = unfinished_file(folder.path(), "a").unwrap();
        assert!(file.path().exists());
        let path = file.path().to_owned();
        drop(file);
        assert!(!path.exists());
    }
}
