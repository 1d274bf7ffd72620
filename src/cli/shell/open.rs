//! `rubmap open`: opens the service's page in a browser.

use clap::Args;

use super::find;
use crate::cli::client::{Client, ServerArgs};
use crate::cli::stdout::print;
use crate::cli::verb::Verb;

/// Variables that the environment has where there is a display; on a Mac there always is one.
const DISPLAYS: [&str; 2] = ["DISPLAY", "WAYLAND_DISPLAY"];

/// View to open.
#[derive(Debug, Args)]
pub(in crate::cli) struct OpenArgs {
    /// Job to open: its id, the beginning of it, or its name [default: the page as it begins]
    job: Option<String>,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for OpenArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let address = match &self.job {
            Some(called) => {
                // Whether the job exists is better known before a browser opens.
                let id = find::job(client, called).await?;
                format!("{}/#/jobs/{}", client.server, client.job(&id).await?.id)
            }
            None => format!("{}/", client.server),
        };
        print(&address)?;
        let shown = |display: &str| std::env::var_os(display).is_some_and(|value| !value.is_empty());
        let has_display = cfg!(target_os = "macos") || DISPLAYS.into_iter().any(shown);
        if has_display && let Err(error) = opener::open_browser(&address) {
            client.terminal.say(&format!("no browser could be opened: {error}"));
        }
        Ok(())
    }
}
