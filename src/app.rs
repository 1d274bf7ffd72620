//! The service as one object: built from settings, run until told to stop.

use std::fs::{File, TryLockError};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

use crate::config::Config;
use crate::http::server::{self, descriptors};
use crate::http::{self, AppState, Contract, Followed, LargeAnswers, Transport};
use crate::jobs::{Runner, Settings};
use crate::store::{LOCK, Store, StoreError};
use crate::tokens::{Tokens, TokensError};
use crate::version;

/// Time between two attempts to open the store.
const BETWEEN_ATTEMPTS: Duration = Duration::from_secs(1);

/// Number of large answers that are made at once.
const LARGE_ANSWERS: usize = 4;

/// Role of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Service: takes requests.
    Service,
    /// Worker: computes what services are asked for.
    Worker,
}

/// The service, bound to its address, with its workers running.
#[derive(Debug)]
pub struct App {
    listener: TcpListener,
    addr: SocketAddr,
    role: Role,
    state: AppState,
    store: Store,
    runner: Runner,
    /// Lock of the data folder, held as long as the folder is in use.
    _lock: File,
}

/// Reason why the service could not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data folder cannot be used.
    #[error("the data folder {}: {source}", folder.display())]
    Folder {
        /// Path of the data folder.
        folder: PathBuf,
        /// Cause, as the system reports it.
        source: std::io::Error,
    },
    /// Another process has the data folder.
    #[error(
        "the data folder {} is in use by another rubmap; stop it, or give this one its own with --data",
        .0.display()
    )]
    InUse(PathBuf),
    /// The file of tokens cannot be used.
    #[error(transparent)]
    Tokens(#[from] TokensError),
    /// Address that other machines can reach, while no tokens tell their users apart.
    #[error(
        "{0} can be reached from other machines: say with --tokens FILE who may use the service, or with --open that everybody may"
    )]
    Exposed(SocketAddr),
    /// The database cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The address cannot be bound.
    #[error("cannot listen on {addr}: {source}")]
    Bind {
        /// Address to listen on.
        addr: SocketAddr,
        /// Cause, as the system reports it.
        source: std::io::Error,
    },
    /// Too few open files to serve anybody.
    #[error(
        "the system allows this process {limit} open files, of which storage and computations need {}; raise the limit, \
         for example with `ulimit -n 1024`",
        descriptors::RESERVE
    )]
    OpenFiles {
        /// Number of open files that the system allows this process.
        limit: u64,
    },
    /// Nobody would compute: no workers here, and no other process shares the database.
    #[error(
        "--workers 0: nobody would compute, because no other process has the data folder; leave it out, or name a --database that others work on"
    )]
    NoWorkers,
    /// The contract does not serialise: a defect.
    #[error("the OpenAPI document: {0}")]
    Contract(#[from] serde_json::Error),
}

impl App {
    /// Opens the data folder, binds the address and resumes unfinished jobs.
    pub async fn build(config: Config) -> Result<Self, StartError> {
        Self::build_as(Role::Service, config).await
    }

    /// Opens the data folder, binds the address and resumes unfinished jobs, as a process of this role.
    pub async fn build_as(role: Role, config: Config) -> Result<Self, StartError> {
        let limit = descriptors::raise_limit();
        let connections = descriptors::connections(config.transport.connections, limit)
            .ok_or(StartError::OpenFiles { limit: limit.unwrap_or_default() })?;
        if config.worker_threads() == 0 && !config.shared.is_shared() {
            return Err(StartError::NoWorkers);
        }
        let lock = lock(&config.data)?;
        let tokens = config.tokens.as_deref().map(Tokens::read).transpose()?;
        if tokens.is_none() && !config.open && !config.addr.ip().is_loopback() {
            return Err(StartError::Exposed(config.addr));
        }
        let store = open_store(&config).await?;
        store.remove_leftovers().await;
        let bind = |source| StartError::Bind { addr: config.addr, source };
        let listener = TcpListener::bind(config.addr).await.map_err(bind)?;
        let addr = listener.local_addr().map_err(bind)?;
        let memory_bytes = config.memory_limit();
        let settings = Settings {
            workers: config.worker_threads(),
            memory_bytes,
            keep_days: config.keep_days,
            limits: config.owner_limits(),
            upload_bytes: config.upload_bytes,
            package_limits: config.upload_limits(memory_bytes),
        };
        tracing::info!(
            %addr, data = %config.data.display(), workers = settings.workers, memory_bytes,
            expanded_bytes = settings.package_limits.expanded_bytes, connections, commit = version::COMMIT, "starting"
        );
        let runner = Runner::start(store.clone(), settings).await?;
        let document = http::document();
        let state = AppState {
            store: store.clone(),
            answers: LargeAnswers::new(LARGE_ANSWERS, &config.data),
            renderings: Arc::default(),
            tokens,
            limits: config.owner_limits(),
            jobs: runner.jobs(),
            importer: runner.importer(),
            memory_bytes,
            followed: Followed::default(),
            stop: CancellationToken::new(),
            transport: Arc::new(Transport::new(config.transport, addr.ip(), connections)),
            openapi: Arc::from(document.to_json()?),
            contract: Arc::new(Contract::of(&serde_json::to_value(&document)?)),
        };
        Ok(Self { listener, addr, role, state, store, runner, _lock: lock })
    }

    /// Address that the service listens on.
    pub fn addr(&self) -> SocketAddr {
        self.addr
    }

    /// Serves until `stop`; then ends requests, interrupts computations, which resume at the next start, and closes
    /// the data folder.
    pub async fn run_until_stopped(self, stop: CancellationToken) {
        let Self { listener, role, state, store, runner, _lock, .. } = self;
        let transport = Arc::clone(&state.transport);
        let state = AppState { stop: stop.clone(), ..state };
        let router = match role {
            Role::Service => http::router(state),
            Role::Worker => http::observation(state),
        };
        server::serve(listener, router, &transport.limits, &transport.connections, stop).await;
        tracing::info!("stopping");
        runner.stop().await;
        // A lock that another program holds would keep it for longer than who stops the service waits.
        if tokio::time::timeout(Duration::from_millis(500), store.close()).await.is_err() {
            tracing::warn!("the database is in use; its log is folded in at the next start");
        }
        tracing::info!("stopped");
    }
}

/// Opens the store, again and again while the disk is full or another program has the database: whoever starts the service
/// may not come back to it. Credentials that are refused from the beginning were never right.
async fn open_store(config: &Config) -> Result<Store, StoreError> {
    let mut warned = false;
    loop {
        match config.shared.open(&config.data).await {
            Err(error) if error.may_pass() && !error.is_denied() => {
                if !warned {
                    tracing::error!(%error, "this process starts as soon as what it needs can be used");
                    warned = true;
                }
                tokio::time::sleep(BETWEEN_ATTEMPTS).await;
            }
            opened => return opened,
        }
    }
}

/// Locks the data folder for this process; makes the folder if need be.
fn lock(folder: &Path) -> Result<File, StartError> {
    let failed = |source| StartError::Folder { folder: folder.to_owned(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    let file = File::create(folder.join(LOCK)).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(StartError::InUse(folder.to_owned())),
        Err(TryLockError::Error(source)) => Err(failed(source)),
    }
}
