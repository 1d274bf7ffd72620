//! Metrics of requests, which are counted as they are answered.

use std::time::{Duration, Instant};

use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::Registry;

use crate::version;

/// Prefix of the names of all metrics.
pub(super) const PREFIX: &str = "rubmap";

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Answered {
    method: &'static str,
    /// Template of the route; `none` for paths without one.
    route: String,
    /// Status of the answer; `none` if the client was gone before there was one.
    status: String,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Asked {
    method: &'static str,
    route: String,
}

/// Metrics of requests, with the registry that writes them.
#[derive(Debug)]
pub(super) struct Metrics {
    pub(super) registry: Registry,
    requests: Family<Answered, Counter>,
    seconds: Family<Asked, Histogram, fn() -> Histogram>,
    pub(super) begin: Instant,
}

impl Default for Metrics {
    fn default() -> Self {
        let requests = Family::<Answered, Counter>::default();
        // From 1 ms to 32 s, doubling.
        let histogram: fn() -> Histogram = || Histogram::new(exponential_buckets(0.001, 2.0, 16));
        let seconds = Family::<Asked, Histogram, fn() -> Histogram>::new_with_constructor(histogram);
        let mut registry = Registry::with_prefix(PREFIX);
        registry.register(
            "http_requests",
            "Requests answered, by method, route and status",
            requests.clone(),
        );
        registry.register(
            "http_request_duration_seconds",
            "Time from the head of a request to the end of its answer",
            seconds.clone(),
        );
        let build =
            [("version", version::VERSION), ("commit", version::COMMIT), ("profile", version::PROFILE)];
        registry.register("build", "What the program was built from", Info::new(build.to_vec()));
        Self { registry, requests, seconds, begin: Instant::now() }
    }
}

impl Metrics {
    /// Counts a request that was answered or whose client is gone.
    pub(super) fn request(&self, method: &'static str, route: &str, status: Option<u16>, took: Duration) {
        let status = status.map_or_else(|| "none".to_owned(), |status| status.to_string());
        self.requests.get_or_create(&Answered { method, route: route.to_owned(), status }).inc();
        self.seconds.get_or_create(&Asked { method, route: route.to_owned() }).observe(took.as_secs_f64());
    }
}
