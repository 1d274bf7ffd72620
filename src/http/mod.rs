//! The service as the world sees it. The only place that knows status codes; it computes nothing.

mod access;
mod body;
mod contract;
mod document;
mod extract;
mod health;
mod host;
mod hosts;
mod idempotency;
mod job_body;
mod jobs;
mod metrics;
mod modal_analyses;
mod models;
mod openapi;
mod pace;
mod page;
mod principal;
mod probe;
pub mod problem;
mod request_metrics;
mod results;
mod router;
pub mod server;
mod state;
mod stream;
mod studies;
mod submit;
mod sweeps;
mod transport;
mod version;

pub use document::document;
pub use router::router;
pub use state::AppState;
pub use stream::LargeAnswers;
pub use transport::Transport;
