//! Settings of the service, from the command line or the environment.

#[cfg_attr(feature = "cluster", path = "config/cluster/shared/mod.rs")]
#[cfg_attr(not(feature = "cluster"), path = "config/cluster/alone.rs")]
pub mod cluster;
mod memory;
mod transport;

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::package::Limits;
use crate::store::limits as owner;

pub use cluster::SharedConfig;
pub use transport::TransportConfig;

/// Largest package accepted unless told otherwise, in bytes as sent.
const UPLOAD_BYTES: u64 = 2 << 30;

/// Settings of the service.
#[derive(Debug, Clone, Args)]
pub struct Config {
    /// Address to listen on; port 0 takes any free port.
    #[arg(long, env = "RUBMAP_ADDR", default_value = "127.0.0.1:8080")]
    pub addr: SocketAddr,

    /// Folder for models, jobs and results; made if missing.
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    pub data: PathBuf,

    /// Settings of what several processes share.
    #[command(flatten)]
    pub shared: SharedConfig,

    /// Threads that compute; 0 leaves that to others of the same --database [default: one per core].
    #[arg(long, env = "RUBMAP_WORKERS", value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub workers: Option<u16>,

    /// Largest model package accepted, in bytes as sent.
    #[arg(long, env = "RUBMAP_UPLOAD_BYTES", default_value_t = UPLOAD_BYTES, value_parser = clap::value_parser!(u64).range(1..))]
    pub upload_bytes: u64,

    /// Largest model package accepted, in bytes once expanded [default: what fits into memory beside a reduction].
    #[arg(long, env = "RUBMAP_EXPANDED_BYTES")]
    pub expanded_bytes: Option<u64>,

    /// Days after which finished jobs are deleted with their results [default: never].
    #[arg(long, env = "RUBMAP_KEEP_DAYS", value_parser = clap::value_parser!(u32).range(1..=36_500))]
    pub keep_days: Option<u32>,

    /// File of bearer tokens (`rubmap token new`); with it every request needs one, and sees what belongs to its owner.
    #[arg(long, env = "RUBMAP_TOKENS")]
    pub tokens: Option<PathBuf>,

    /// Serve everybody who can reach an address that is not this machine's own, without tokens.
    #[arg(long, env = "RUBMAP_OPEN")]
    pub open: bool,

    /// Speeds that one owner may have waiting [default: no limit].
    #[arg(long, env = "RUBMAP_OWNER_SPEEDS", value_parser = clap::value_parser!(u64).range(1..))]
    pub owner_speeds: Option<u64>,

    /// Bytes of models and results that one owner may have stored [default: no limit].
    #[arg(long, env = "RUBMAP_OWNER_BYTES")]
    pub owner_bytes: Option<u64>,

    /// Models that one owner may have [default: no limit].
    #[arg(long, env = "RUBMAP_OWNER_MODELS")]
    pub owner_models: Option<u64>,

    /// Memory that computations, uploads and large downloads may take together, in bytes [default: three quarters of what the machine or container
    /// leaves].
    #[arg(long, env = "RUBMAP_MEMORY_BYTES", value_parser = clap::value_parser!(u64).range(1 << 20..))]
    pub memory_bytes: Option<u64>,

    /// Settings of the connections to clients.
    #[command(flatten)]
    pub transport: TransportConfig,
}

impl Config {
    /// Settings with all defaults, for this machine alone: the data folder `data`, any free port of the loopback address.
    pub fn local(data: &Path) -> Self {
        Self {
            addr: ([127, 0, 0, 1], 0).into(),
            data: data.to_owned(),
            shared: SharedConfig::default(),
            workers: None,
            upload_bytes: UPLOAD_BYTES,
            expanded_bytes: None,
            keep_days: None,
            tokens: None,
            open: false,
            owner_speeds: None,
            owner_bytes: None,
            owner_models: None,
            memory_bytes: None,
            transport: TransportConfig::default(),
        }
    }

    /// Threads that compute.
    pub fn worker_threads(&self) -> usize {
        match self.workers {
            Some(workers) => usize::from(workers),
            None => std::thread::available_parallelism().map_or(1, usize::from),
        }
    }

    /// Memory that computations, uploads and large downloads may take together; `None` where nothing is known about it.
    pub fn memory_limit(&self) -> Option<u64> {
        // A quarter is left to the program itself, its caches and the system.
        self.memory_bytes.or_else(|| memory::available_bytes().map(|available| available / 4 * 3))
    }

    /// Limits on what one owner may have.
    pub fn owner_limits(&self) -> owner::Limits {
        owner::Limits {
            queued_speeds: self.owner_speeds,
            stored_bytes: self.owner_bytes,
            models: self.owner_models,
        }
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
