//! `rubmap serve`: the HTTP service until a signal ends it.

use crate::app::App;
use crate::config::Config;
use tokio::signal::unix::{SignalKind, signal};
use tokio_util::sync::CancellationToken;

/// Runs the service until SIGTERM or SIGINT.
pub(super) fn run(config: Config) -> anyhow::Result<()> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        let app = App::build(config).await?;
        let stop = CancellationToken::new();
        tokio::spawn(on_signal(stop.clone())?);
        tracing::info!("listening on http://{}", app.addr());
        app.run_until_stopped(stop).await?;
        Ok(())
    })
}

fn on_signal(stop: CancellationToken) -> std::io::Result<impl Future<Output = ()>> {
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
        stop.cancel();
    })
}
