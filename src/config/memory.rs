//! Memory that this machine or container leaves to the service.
//!
//! `sysinfo` (0.40) reads the same files and is silent where we need its word: its limits of the system are those of the
//! outermost group alone, and its limits of a process none as soon as one file on the way out from there is missing.
//! Version 2 has no `memory.max` in a group to which the memory controller is not handed down, though a group around it
//! may limit it; and a container may name a group that only its host has.

use std::path::{Path, PathBuf};

/// Bytes that may be taken now: the smaller of what the kernel calls available and the limits of the control groups
/// this process is in. `None` where the kernel does not say (not Linux).
pub(super) fn available_bytes() -> Option<u64> {
    let available = available_on_machine(&std::fs::read_to_string("/proc/meminfo").ok()?)?;
    let groups = std::fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let limit = smallest_limit(&groups, Path::new("/sys/fs/cgroup"));
    Some(limit.map_or(available, |limit| limit.min(available)))
}

/// Bytes of `MemAvailable` in `/proc/meminfo`.
fn available_on_machine(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

/// Smallest memory limit of the control groups in `/proc/self/cgroup` (versions 1 and 2) and of all groups around them.
///
/// Within a container the file may name groups as the host sees them; of these only the root exists there, and it has
/// the container's limit.
fn smallest_limit(groups: &str, mount: &Path) -> Option<u64> {
    let mut limits = Vec::new();
    for group in groups.lines() {
        let mut fields = group.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (fields.next(), fields.next()) else { continue };
        let (root, file) = match controllers {
            "" => (mount.to_owned(), "memory.max"),
            controllers if controllers.split(',').any(|controller| controller == "memory") => {
                (mount.join("memory"), "memory.limit_in_bytes")
            }
            _ => continue,
        };
        let folder = root.join(path.trim_start_matches('/'));
        let around = folder.ancestors().take_while(|folder| folder.starts_with(&root));
        limits.extend(around.filter_map(|folder| limit(folder.join(file))));
    }
    limits.into_iter().min()
}

/// Memory limit in `file`; `None` if there is none ("max").
fn limit(file: PathBuf) -> Option<u64> {
    std::fs::read_to_string(file).ok()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(root: &Path, file: &str, text: &str) {
        let path = root.join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    #[test]
    fn available_memory_is_read_in_bytes() {
        let meminfo = "MemTotal:       24689764 kB\nMemFree:   2 kB\nMemAvailable:   22605232 kB\n";
        assert_eq!(available_on_machine(meminfo), Some(22_605_232 * 1024));
        assert_eq!(available_on_machine("MemTotal: 1 kB\n"), None);
        if cfg!(target_os = "linux") {
            assert!(available_bytes().unwrap() > 1 << 20);
        }
    }

    #[test]
    fn version_2_limits_of_all_groups_around_count() {
        let root = tempfile::tempdir().unwrap();
        put(root.path(), "memory.max", "9000\n");
        put(root.path(), "system.slice/memory.max", "4000\n");
        put(root.path(), "system.slice/rubmap.service/memory.max", "max\n");
        assert_eq!(smallest_limit("0::/system.slice/rubmap.service\n", root.path()), Some(4000));
        // The host's name for a container's group.
        assert_eq!(smallest_limit("0::/docker/4f5a\n", root.path()), Some(9000));
        assert_eq!(smallest_limit("0::/\n", Path::new("/nowhere")), None);
    }

    #[test]
    fn version_1_has_a_tree_of_its_own_for_memory() {
        let root = tempfile::tempdir().unwrap();
        put(root.path(), "memory/memory.limit_in_bytes", "9223372036854771712\n");
        put(root.path(), "memory/docker/4f5a/memory.limit_in_bytes", "7000\n");
        put(root.path(), "cpu/docker/4f5a/memory.limit_in_bytes", "1\n");
        let groups = "5:cpu,cpuacct:/docker/4f5a\n4:memory:/docker/4f5a\n0::/\n";
        assert_eq!(smallest_limit(groups, root.path()), Some(7000));
    }
}
