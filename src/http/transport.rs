//! Limits, checks and counters of connections and requests, whatever their route.

use std::net::IpAddr;
use std::time::Duration;

use axum::http::HeaderValue;

use super::hosts::Hosts;
use super::probe::Probed;
use super::request_metrics::Metrics;
use super::server::{Figures, Limits};
use crate::config::TransportConfig;

/// Limits, checks and counters of connections and requests.
#[derive(Debug)]
pub struct Transport {
    /// Limits of connections.
    pub limits: Limits,
    /// Counters of connections.
    pub connections: Figures,
    pub(super) hosts: Hosts,
    pub(super) cors_origins: Vec<HeaderValue>,
    pub(super) metrics: Metrics,
    /// Latest probe of the database.
    pub(super) probed: Probed,
    /// Free bytes on the disk below which the service is not ready.
    pub(super) min_free_bytes: u64,
}

impl Transport {
    /// Transport of a service that listens on `bound` and has files for so many `connections`.
    pub fn new(config: TransportConfig, bound: IpAddr, connections: usize) -> Self {
        let TransportConfig {
            head_seconds,
            idle_seconds,
            stall_seconds,
            hosts,
            cors_origins,
            min_free_bytes,
            ..
        } = config;
        Self {
            limits: Limits {
                connections,
                head: Duration::from_secs(head_seconds),
                idle: Duration::from_secs(idle_seconds),
                stall: Duration::from_secs(stall_seconds),
            },
            connections: Figures::default(),
            hosts: Hosts::new(bound, hosts),
            cors_origins,
            metrics: Metrics::default(),
            probed: Probed::default(),
            min_free_bytes,
        }
    }
}
