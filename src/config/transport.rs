//! Settings of the connections: how many there may be, how long they may rest, and from where they may come.

use axum::http::uri::Authority;
use axum::http::{HeaderValue, Uri};
use clap::Args;

/// Settings of the connections.
#[derive(Debug, Clone, Args)]
pub struct TransportConfig {
    /// Connections kept open at once; fewer where the system allows too few open files.
    #[arg(long, env = "RUBMAP_CONNECTIONS", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub connections: u32,

    /// Seconds that the head of a request may take, from its first byte or from the connection.
    #[arg(long, env = "RUBMAP_HEAD_SECONDS", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub head_seconds: u64,

    /// Seconds that a connection may rest between two requests.
    #[arg(long, env = "RUBMAP_IDLE_SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub idle_seconds: u64,

    /// Seconds that the service waits for 64 KiB of a request's body, or for a client that does not take its answer.
    #[arg(long, env = "RUBMAP_STALL_SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub stall_seconds: u64,

    /// Name under which clients reach the service; may be repeated. Requests for other names are refused, those for localhost
    /// and the address listened on are not [default: any name, unless that address is a loopback one].
    #[arg(long = "host", env = "RUBMAP_HOSTS", value_name = "NAME", value_delimiter = ',', value_parser = host_name)]
    pub hosts: Vec<String>,

    /// Origin (scheme and host) of web pages that may use the service; may be repeated [default: none].
    #[arg(long = "cors-origin", env = "RUBMAP_CORS_ORIGINS", value_name = "ORIGIN", value_delimiter = ',', value_parser = origin)]
    pub cors_origins: Vec<HeaderValue>,

    /// Bytes free on the disk of the data folder below which the service says that it is not ready.
    #[arg(long, env = "RUBMAP_MIN_FREE_BYTES", default_value_t = 64 << 20)]
    pub min_free_bytes: u64,
}

impl Default for TransportConfig {
    /// Settings that the command line gives without any of these arguments.
    fn default() -> Self {
        Self {
            connections: 1024,
            head_seconds: 10,
            idle_seconds: 30,
            stall_seconds: 30,
            hosts: Vec::new(),
            cors_origins: Vec::new(),
            min_free_bytes: 64 << 20,
        }
    }
}

/// Reads a name or address as clients write it into their URLs, without a port.
fn host_name(text: &str) -> Result<String, String> {
    match text.parse::<Authority>() {
        Ok(authority) if authority.host() == text => Ok(text.to_owned()),
        _ => Err("expected a name such as rubmap.example, without scheme and port".to_owned()),
    }
}

/// Reads an origin: scheme, name and perhaps port, exactly as browsers say it.
fn origin(text: &str) -> Result<HeaderValue, String> {
    let expected = || "expected an origin such as https://tools.example, without a path".to_owned();
    let uri: Uri = text.parse().map_err(|_| expected())?;
    let (Some("http" | "https"), Some(authority)) = (uri.scheme_str(), uri.authority()) else {
        return Err(expected());
    };
    let origin = format!("{}://{authority}", uri.scheme_str().unwrap_or_default());
    if origin != text || authority.as_str().contains('@') {
        return Err(expected());
    }
    HeaderValue::from_str(text).map_err(|_| expected())
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Command {
        #[command(flatten)]
        transport: TransportConfig,
    }

    #[test]
    fn the_default_is_that_of_the_command_line() {
        let parsed = Command::parse_from(["rubmap"]).transport;
        assert_eq!(format!("{parsed:?}"), format!("{:?}", TransportConfig::default()));
    }

    #[test]
    fn names_and_origins_are_checked() {
        for fine in ["rubmap.example", "localhost", "10.0.0.5", "[::1]"] {
            assert_eq!(host_name(fine).unwrap(), fine);
        }
        for wrong in ["", "http://rubmap.example", "rubmap.example:8080", "a b", "user@host", "::1"] {
            assert!(host_name(wrong).is_err(), "{wrong:?}");
        }
        for fine in ["https://tools.example", "http://localhost:3000"] {
            assert_eq!(origin(fine).unwrap(), fine);
        }
        for wrong in
            ["*", "null", "tools.example", "https://tools.example/", "ftp://tools.example", "https://a@b"]
        {
            assert!(origin(wrong).is_err(), "{wrong:?}");
        }
    }
}
