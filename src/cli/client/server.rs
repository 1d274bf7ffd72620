//! Arguments that name a service.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context, bail};
use clap::Args;

use super::http::Client;

/// Address of a service, and the token for it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Service")]
pub(in crate::cli) struct ServerArgs {
    /// Address of the service
    #[arg(long, env = "RUBMAP_SERVER", default_value = "http://127.0.0.1:8080", value_parser = server)]
    server: String,
    /// Token, if the service wants one; better in the environment or a file, as others on this machine can read command lines
    #[arg(long, env = "RUBMAP_TOKEN", hide_env_values = true)]
    token: Option<String>,
    /// File with the token; goes before the environment
    #[arg(long, env = "RUBMAP_TOKEN_FILE", value_name = "FILE")]
    token_file: Option<PathBuf>,
    /// Seconds for which a service that does not answer, or asks for patience, is asked again
    #[arg(long, default_value_t = 20, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(..=86_400))]
    patience: u64,
}

impl ServerArgs {
    /// Makes a client of the service.
    ///
    /// # Errors
    /// A file of a token that cannot be read.
    pub(in crate::cli) fn client(&self) -> anyhow::Result<Client> {
        let token = match &self.token_file {
            Some(file) => {
                let text = std::fs::read_to_string(file);
                Some(text.with_context(|| format!("cannot read the token in {}", file.display()))?)
            }
            None => self.token.clone(),
        };
        let token = token.map(|token| token.trim().to_owned()).filter(|token| !token.is_empty());
        if token.as_ref().is_some_and(|token| !token.bytes().all(|byte| byte.is_ascii_graphic())) {
            bail!("the token is none: it has characters that no token has");
        }
        Client::new(self.server.clone(), token, Duration::from_secs(self.patience))
    }
}

/// Reads an address, with its scheme and without a slash at its end.
fn server(text: &str) -> Result<String, String> {
    let address = if text.contains("://") { text.to_owned() } else { format!("http://{text}") };
    let url: reqwest::Url = address.parse().map_err(|error| format!("it is no address ({error})"))?;
    match url.scheme() {
        "http" if url.query().is_none() && url.fragment().is_none() => {
            Ok(url.as_str().trim_end_matches('/').to_owned())
        }
        "https" => Err("this program has no TLS: go through a tunnel, such as `ssh -L`".to_owned()),
        _ => Err("an address is like http://127.0.0.1:8080".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::server;

    #[test]
    fn addresses_are_completed_or_refused() {
        for (text, address) in [
            ("127.0.0.1:8080", "http://127.0.0.1:8080"),
            ("http://rig.example/", "http://rig.example"),
            ("http://rig.example/rubmap/", "http://rig.example/rubmap"),
        ] {
            assert_eq!(server(text).unwrap(), address);
        }
        for text in ["https://rig.example", "ftp://rig.example", "http://", "http://a?b", "a b"] {
            assert!(server(text).is_err(), "{text}");
        }
    }
}
