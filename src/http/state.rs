//! State of the service that handlers work with.

use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use super::contract::Contract;
use super::followed::Followed;
use super::renderings::Renderings;
use super::stream::LargeAnswers;
use super::transport::Transport;
use crate::import::Importer;
use crate::jobs::Jobs;
use crate::store::Store;
use crate::store::limits::Limits;
use crate::tokens::Tokens;

/// State of the service that handlers work with.
#[derive(Debug, Clone)]
pub struct AppState {
    /// Store of models, jobs and results.
    pub store: Store,
    /// Bounds on the number, memory and room of large answers.
    pub answers: LargeAnswers,
    /// Drawings that were made already.
    pub renderings: Arc<Renderings>,
    /// Tokens of those who may use the service; `None`: anybody who reaches it may.
    pub tokens: Option<Tokens>,
    /// Limits of what one owner may have.
    pub limits: Limits,
    /// Jobs that are queued and computed.
    pub jobs: Jobs,
    /// Importer of model packages.
    pub importer: Arc<Importer>,
    /// Memory that all reductions together may take, bytes; `None` where it is not known.
    pub memory_bytes: Option<u64>,
    /// Jobs that clients follow.
    pub followed: Followed,
    /// Token that is cancelled when the service stops: answers that last as long as a job end then.
    pub stop: CancellationToken,
    /// Limits, checks and counters of connections and requests.
    pub transport: Arc<Transport>,
    /// Contract as JSON.
    pub openapi: Arc<str>,
    /// Contract against which requests are checked.
    pub contract: Arc<Contract>,
}
