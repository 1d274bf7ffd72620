//! Sessions of a service in this process and a user who works with it over HTTP, for the commands that show something.

pub(super) mod impeller;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, bail};
use tokio_util::sync::CancellationToken;

use super::client::{Answer, Client, Model, UploadLabels};
use super::signals::stop_signal;
use crate::app::App;
use crate::cli::stdout::narrate;
use crate::config::Config;

/// Session: the folder to work in and its beginning.
pub(super) struct Session {
    out: PathBuf,
    begin: Instant,
}

/// End of a session without errors.
enum Ending {
    /// Everything was shown.
    Played,
    /// A signal stopped it.
    Stopped,
}

impl Session {
    /// Begins a session in a folder, which is made if it is missing.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub(super) fn begin(out: &Path) -> anyhow::Result<Self> {
        let begin = Instant::now();
        std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
        Ok(Self { out: out.to_owned(), begin })
    }

    /// Runs the service on a free loopback port, with its data in the folder, while `play` is its user; 130, as shells say it, if
    /// a signal stopped it.
    ///
    /// # Errors
    /// A folder that cannot be used, and what `play` returns.
    pub(super) fn run(
        self,
        workers: Option<u16>,
        play: impl AsyncFnOnce(&Client) -> anyhow::Result<()>,
    ) -> anyhow::Result<ExitCode> {
        let config = Config { workers, ..Config::local(&self.out.join("data")) };
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
        match runtime.block_on(with_service(config, play))? {
            Ending::Played => narrate(&format!("\nDone in {:.0} s.", self.begin.elapsed().as_secs_f64()))?,
            Ending::Stopped => {
                eprintln!("\nStopped; its jobs are cancelled. What it left is in {}.", self.out.display());
                return Ok(ExitCode::from(130));
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Starts the service, plays the user, and stops the service whatever came of it.
async fn with_service(
    config: Config,
    play: impl AsyncFnOnce(&Client) -> anyhow::Result<()>,
) -> anyhow::Result<Ending> {
    let stop_signal = stop_signal()?;
    let (data, workers) = (config.data.clone(), config.worker_threads());
    let app = App::build(config).await?;
    let client = Client::of_own_service(format!("http://{}", app.addr()))?;
    narrate(&format!("service   http://{}, {workers} workers, data in {}", app.addr(), data.display()))?;
    let stop = CancellationToken::new();
    let mut service = tokio::spawn(app.run_until_stopped(stop.clone()));
    let played = async {
        // A session that was killed leaves jobs that the service has resumed by now.
        client.cancel_unfinished_jobs().await?;
        play(&client).await
    };
    let outcome = tokio::select! {
        outcome = played => outcome.map(|()| Ending::Played),
        ended = &mut service => {
            ended?;
            bail!("the service ended before its user had everything");
        }
        () = stop_signal => {
            // Without this the jobs would go on at the next start, which is right for a service and wrong here.
            client.cancel_unfinished_jobs().await.map(|()| Ending::Stopped)
        }
    };
    stop.cancel();
    service.await?;
    outcome
}

/// Uploads a package and prints the model's id.
pub(super) async fn upload(client: &Client, package: &Path) -> anyhow::Result<Answer<Model>> {
    let (model, new) = client.upload(package, &UploadLabels::default()).await?;
    narrate(&format!("model     {}{}", model.id, if new { "" } else { " (known from an earlier run)" }))?;
    Ok(model)
}

/// Writes a file.
pub(super) fn save(path: &Path, text: &str) -> anyhow::Result<()> {
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
