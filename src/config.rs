//! Settings of the service, from the command line or the environment.

mod memory;
mod transport;

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use crate::package::Limits;

pub use transport::TransportConfig;

/// Settings of the service.
#[derive(Debug, Clone, Args)]
pub struct Config {
    /// Address to listen on; port 0 takes any free port.
    #[arg(long, env = "RUBMAP_ADDR", default_value = "127.0.0.1:8080")]
    pub addr: SocketAddr,

    /// Folder for models, jobs and results; made if missing.
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    pub data: PathBuf,

    /// Threads that compute [default: one per core].
    #[arg(long, env = "RUBMAP_WORKERS", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,

    /// Largest model package accepted, in bytes as sent.
    #[arg(long, env = "RUBMAP_UPLOAD_BYTES", default_value_t = 2 << 30)]
    pub upload_bytes: u64,

    /// Largest model package accepted, in bytes once expanded [default: what fits into memory beside a reduction].
    #[arg(long, env = "RUBMAP_EXPANDED_BYTES")]
    pub expanded_bytes: Option<u64>,

    /// Memory that reductions and generations may take, in bytes [default: three quarters of what the machine or container leaves].
    #[arg(long, env = "RUBMAP_MEMORY_BYTES", value_parser = clap::value_parser!(u64).range(1 << 20..))]
    pub memory_bytes: Option<u64>,

    /// How the service meets its clients.
    #[command(flatten)]
    pub transport: TransportConfig,
}

impl Config {
    /// Threads that compute.
    pub fn worker_threads(&self) -> usize {
        match self.workers {
            Some(workers) => usize::from(workers),
            None => std::thread::available_parallelism().map_or(1, usize::from),
        }
    }

    /// Memory that reductions and generations may take; `None` where nothing is known about it.
    pub fn memory_limit(&self) -> Option<u64> {
        // A quarter is left to packages being read, speeds being run and the system.
        self.memory_bytes.or_else(|| memory::available_bytes().map(|available| available / 4 * 3))
    }

    /// Limits for uploads, with `memory_limit` bytes for reductions.
    pub fn upload_limits(&self, memory_limit: Option<u64>) -> Limits {
        let mut limits = Limits::default();
        // A byte of a package takes some 1.4 of memory while it is read (measured at 127,000 DOF), and reductions leave
        // a third of what they have.
        let fits = memory_limit.map_or(u64::MAX, |memory| memory / 5);
        limits.expanded_bytes = self.expanded_bytes.unwrap_or(limits.expanded_bytes.min(fits));
        limits
    }
}
