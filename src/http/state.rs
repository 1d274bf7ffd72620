//! What handlers work with.

use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use super::contract::Contract;
use super::followed::Followed;
use super::renderings::Renderings;
use super::stream::LargeAnswers;
use super::transport::Transport;
use crate::jobs::Jobs;
use crate::package;
use crate::store::Store;
use crate::store::limits::Limits;
use crate::tokens::Tokens;

/// What handlers work with.
#[derive(Debug, Clone)]
pub struct AppState {
    /// What is remembered.
    pub store: Store,
    /// Bounds what large answers take.
    pub answers: LargeAnswers,
    /// Drawings that were made already.
    pub renderings: Arc<Renderings>,
    /// Who may use the service; `None`: whoever reaches it.
    pub tokens: Option<Tokens>,
    /// What one owner may have.
    pub limits: Limits,
    /// What is computed.
    pub jobs: Jobs,
    /// Largest upload, in bytes as sent.
    pub upload_bytes: u64,
    /// Limits while reading an uploaded package.
    pub package_limits: package::Limits,
    /// Memory that reductions may take together; `None` where nothing is known about it.
    pub memory_bytes: Option<u64>,
    /// Jobs that somebody follows.
    pub followed: Followed,
    /// Told when the service stops: answers that last as long as a job end then.
    pub stop: CancellationToken,
    /// What connections and requests are subject to and counted by.
    pub transport: Arc<Transport>,
    /// The contract, as JSON.
    pub openapi: Arc<str>,
    /// The contract, as requests are held against it.
    pub contract: Arc<Contract>,
}
