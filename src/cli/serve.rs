//! `rubmap serve`: the HTTP service until a signal ends it.

use crate::app::App;
use crate::config::Config;
use tokio_util::sync::CancellationToken;

use super::signals::stop_signal;

/// Runs the service until SIGTERM or SIGINT.
pub(super) fn run(config: Config) -> anyhow::Result<()> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        let stop_signal = stop_signal()?;
        let app = App::build(config).await?;
        let stop = CancellationToken::new();
        let told = stop.clone();
        tokio::spawn(async move {
            stop_signal.await;
            told.cancel();
        });
        tracing::info!("listening on http://{}", app.addr());
        app.run_until_stopped(stop).await;
        Ok(())
    })
}
