//! The service as one object: built from settings, run until told to stop.

use std::fs::{File, TryLockError};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

use crate::config::Config;
use crate::http::server::{self, descriptors};
use crate::http::{self, AppState, Transport};
use crate::jobs::{Runner, Settings};
use crate::store::{Store, StoreError};
use crate::version;

/// The service, bound to its address, with its workers running.
#[derive(Debug)]
pub struct App {
    listener: TcpListener,
    addr: SocketAddr,
    state: AppState,
    store: Store,
    runner: Runner,
    /// Held as long as the data folder is in use.
    _lock: File,
}

/// Why the service could not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data folder cannot be used.
    #[error("the data folder {}: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Another process has the data folder.
    #[error(
        "the data folder {} is in use by another rubmap; stop it, or give this one its own with --data",
        .0.display()
    )]
    InUse(PathBuf),
    /// The database cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The address cannot be bound.
    #[error("cannot listen on {addr}: {source}")]
    Bind {
        /// The address.
        addr: SocketAddr,
        /// Why.
        source: std::io::Error,
    },
    /// There are too few open files to serve anybody.
    #[error(
        "the system allows this process {limit} open files, of which storage and computations need {}; raise the limit, \
         for example with `ulimit -n 1024`",
        descriptors::RESERVE
    )]
    OpenFiles {
        /// The limit.
        limit: u64,
    },
    /// The contract does not serialise: a defect.
    #[error("the OpenAPI document: {0}")]
    Contract(#[from] serde_json::Error),
}

impl App {
    /// Opens the data folder, binds the address and resumes unfinished jobs.
    pub async fn build(config: Config) -> Result<Self, StartError> {
        let limit = descriptors::raise_limit();
        let connections = descriptors::connections(config.transport.connections, limit)
            .ok_or(StartError::OpenFiles { limit: limit.unwrap_or_default() })?;
        let lock = lock(&config.data)?;
        let store = Store::open(&config.data).await?;
        store.remove_leftovers().await;
        let bind = |source| StartError::Bind { addr: config.addr, source };
        let listener = TcpListener::bind(config.addr).await.map_err(bind)?;
        let addr = listener.local_addr().map_err(bind)?;
        let memory_bytes = config.memory_limit();
        let package_limits = config.upload_limits(memory_bytes);
        let settings = Settings { data: config.data.clone(), workers: config.worker_threads(), memory_bytes };
        tracing::info!(
            %addr, data = %config.data.display(), workers = settings.workers, memory_bytes,
            expanded_bytes = package_limits.expanded_bytes, connections, commit = version::COMMIT, "starting"
        );
        let runner = Runner::start(store.clone(), settings).await?;
        let state = AppState {
            store: store.clone(),
            jobs: runner.jobs(),
            upload_bytes: config.upload_bytes,
            package_limits,
            memory_bytes,
            transport: Arc::new(Transport::new(config.transport, addr.ip(), connections)),
            openapi: Arc::from(http::document().to_json()?),
        };
        Ok(Self { listener, addr, state, store, runner, _lock: lock })
    }

    /// The address it listens on.
    pub fn addr(&self) -> SocketAddr {
        self.addr
    }

    /// Serves until `stop`; then ends requests, interrupts computations, which resume at the next start, and closes
    /// the data folder.
    pub async fn run_until_stopped(self, stop: CancellationToken) {
        let Self { listener, state, store, runner, _lock, .. } = self;
        let transport = Arc::clone(&state.transport);
        server::serve(listener, http::router(state), &transport.limits, &transport.connections, stop).await;
        tracing::info!("stopping");
        runner.stop().await;
        store.close().await;
        tracing::info!("stopped");
    }
}

/// Makes the data folder if need be and takes it for this process.
fn lock(folder: &Path) -> Result<File, StartError> {
    let failed = |source| StartError::Folder { folder: folder.to_owned(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    let file = File::create(folder.join("lock")).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(StartError::InUse(folder.to_owned())),
        Err(TryLockError::Error(source)) => Err(failed(source)),
    }
}
