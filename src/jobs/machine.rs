//! Machine that this process runs on.

use std::fs;
use std::thread::available_parallelism;

use crate::analysis::result::Machine;
use crate::analysis::run::vectors;

/// Description of this machine, as far as the system tells.
pub(super) fn here() -> Machine {
    Machine {
        name: rustix::system::uname().nodename().to_string_lossy().into_owned(),
        processor: processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        processors: available_parallelism().map_or(1, |n| n.get() as u32),
        vectors: vectors(),
    }
}

/// Key of a machine class: steps cost the same on machines of equal key.
pub(super) fn kind(Machine { processor, processors, vectors, .. }: &Machine) -> String {
    format!("{processor}, {processors} processors, {vectors}")
}

fn processor() -> Option<String> {
    let told = fs::read_to_string("/proc/cpuinfo").ok()?;
    let name = told.lines().find_map(|line| line.strip_prefix("model name"))?;
    Some(name.trim_start_matches(['\t', ' ', ':']).trim_end().to_owned())
}
