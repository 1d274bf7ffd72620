//! Open files of this process, which connections share with the database and the computations.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// Files that connections may not take: the databases with their logs (some forty), packages and checkpoints being read and
/// written, and what the system needs.
pub const RESERVE: u64 = 128;

/// Files of one connection, which may be an upload that has a file of its own.
const PER_CONNECTION: u64 = 2;

/// Fewest connections with which the service starts.
const FEWEST_CONNECTIONS: u64 = 16;

/// Raises the limit of open files as far as this process may, and returns it; `None` for no limit.
pub fn raise_limit() -> Option<u64> {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    if current == maximum {
        return current;
    }
    match setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum }) {
        Ok(()) => maximum,
        Err(error) => {
            tracing::warn!(%error, ?current, ?maximum, "could not raise the limit of open files");
            current
        }
    }
}

/// Limit of open files; `None` for no limit.
pub fn limit() -> Option<u64> {
    getrlimit(Resource::Nofile).current
}

/// Number of files open now; `None` where the system does not report it, or has no file left to report it with.
pub fn open() -> Option<u64> {
    // One of them is the folder being listed.
    Some((std::fs::read_dir("/dev/fd").ok()?.count() as u64).saturating_sub(1))
}

/// Number of connections that `limit` open files allow, at most `wanted`; `None` if these are too few to serve anybody.
pub fn connections(wanted: u32, limit: Option<u64>) -> Option<usize> {
    let Some(limit) = limit else { return Some(wanted as usize) };
    let allowed = limit.saturating_sub(RESERVE) / PER_CONNECTION;
    (allowed >= FEWEST_CONNECTIONS).then_some(allowed.min(u64::from(wanted)) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_leave_files_to_storage_and_uploads() {
        assert_eq!(connections(1000, None), Some(1000));
        assert_eq!(connections(1000, Some(1024)), Some(448));
        assert_eq!(connections(100, Some(1024)), Some(100));
        assert_eq!(connections(100, Some(160)), Some(16));
        assert_eq!(connections(1, Some(159)), None);
        assert_eq!(connections(1, Some(0)), None);
    }

    #[test]
    fn open_files_are_counted() {
        let before = open().unwrap();
        let files: Vec<_> = (0..50).map(|_| tempfile::tempfile().unwrap()).collect();
        // Other tests of this process open and close files, too.
        assert!(open().unwrap() + 25 > before + 50, "{before} before");
        drop(files);
        assert!(limit().is_none_or(|limit| limit > before));
    }
}
