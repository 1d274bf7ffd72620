//! `rubmap worker`: computes what services are asked for, until a signal ends it.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use crate::app::Role;
use crate::cli::serve;
use crate::config::Config;
use crate::config::cluster::{DatabaseUrl, SharedConfig};
use crate::store::cluster::address::Address;

/// Settings of a worker.
#[derive(Debug, Args)]
pub(in crate::cli) struct WorkerArgs {
    /// Address of /healthz, /readyz and /metrics; port 0 takes any free port.
    #[arg(long, env = "RUBMAP_ADDR", default_value = "127.0.0.1:0")]
    addr: SocketAddr,
    /// Folder for this worker alone; made if missing.
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    data: PathBuf,
    /// PostgreSQL database that the worker shares with the service.
    #[arg(long, env = "RUBMAP_DATABASE", hide_env_values = true, value_name = "postgres://USER@HOST/NAME")]
    database: DatabaseUrl,
    /// Object storage that the worker shares with the service: s3://bucket/prefix, or a folder that both see.
    #[arg(long, env = "RUBMAP_OBJECTS", value_name = "s3://BUCKET/PREFIX")]
    objects: Address,
    /// Threads that compute [default: one per core].
    #[arg(long, env = "RUBMAP_WORKERS", value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Memory that computations may take together, in bytes [default: three quarters of what the machine or container leaves].
    #[arg(long, env = "RUBMAP_MEMORY_BYTES", value_parser = clap::value_parser!(u64).range(1 << 20..))]
    memory_bytes: Option<u64>,
    /// Bytes of models and results that one owner may have stored, as the gateways limit them: a generated model has its size once it
    /// is made [default: no limit].
    #[arg(long, env = "RUBMAP_OWNER_BYTES")]
    owner_bytes: Option<u64>,
    /// Stop, too, when standard input ends
    #[arg(long)]
    until_eof: bool,
}

/// Runs the worker until SIGTERM or SIGINT.
pub(super) fn run(args: WorkerArgs) -> anyhow::Result<()> {
    let WorkerArgs { addr, data, database, objects, workers, memory_bytes, owner_bytes, until_eof } = args;
    let config = Config {
        addr,
        shared: SharedConfig { database: Some(database), objects: Some(objects) },
        workers,
        memory_bytes,
        owner_bytes,
        // Answers of a worker are not about anybody's jobs.
        open: true,
        ..Config::local(&data)
    };
    serve::until_told(config, Role::Worker, until_eof)
}
