//! Hosts for which the service answers.

use std::net::IpAddr;

/// Hosts for which the service answers: this machine, and names that were given.
#[derive(Debug)]
pub(super) struct Hosts {
    bound: IpAddr,
    names: Vec<String>,
}

impl Hosts {
    pub(super) fn new(bound: IpAddr, names: Vec<String>) -> Self {
        Self { bound, names }
    }

    /// Whether requests for `host` are answered: for all hosts if the service can be reached from other machines and was given no names.
    pub(super) fn include(&self, host: &str) -> bool {
        if self.names.is_empty() && !self.bound.is_loopback() {
            return true;
        }
        let address = host.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        address.is_ok_and(|address| address.is_loopback() || address == self.bound)
            || host.eq_ignore_ascii_case("localhost")
            || self.names.iter().any(|name| name.eq_ignore_ascii_case(host))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hosts(bound: &str, names: &[&str]) -> Hosts {
        Hosts::new(bound.parse().unwrap(), names.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn a_loopback_service_answers_for_this_machine_only() {
        let local = hosts("127.0.0.1", &[]);
        for host in ["localhost", "LocalHost", "127.0.0.1", "127.1.2.3", "[::1]"] {
            assert!(local.include(host), "{host}");
        }
        for host in ["evil.example", "localhost.evil.example", "10.0.0.5", "127.0.0.1.evil.example", ""] {
            assert!(!local.include(host), "{host}");
        }
    }

    #[test]
    fn names_are_added_to_this_machine_s() {
        let named = hosts("127.0.0.1", &["Rubmap.example"]);
        assert!(named.include("rubmap.example") && named.include("localhost"));
        assert!(!named.include("evil.example"));
    }

    #[test]
    fn a_service_for_others_answers_for_any_host_unless_told() {
        assert!(hosts("0.0.0.0", &[]).include("anything.example"));
        let told = hosts("10.0.0.5", &["rubmap.example"]);
        assert!(told.include("rubmap.example") && told.include("10.0.0.5") && told.include("127.0.0.1"));
        assert!(!told.include("anything.example") && !told.include("10.0.0.6"));
    }
}
