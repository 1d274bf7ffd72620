//! `rubmap serve`: the HTTP service until a signal ends it.

use std::pin::pin;

use crate::app::App;
use crate::config::Config;
use tokio_util::sync::CancellationToken;

use super::signals::stop_signal;

/// Runs the service until SIGTERM or SIGINT.
pub(super) fn run(config: Config) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let mut stop_signal = pin!(stop_signal()?);
        let app = tokio::select! {
            app = App::build(config) => app?,
            () = &mut stop_signal => return Ok(()),
        };
        let stop = CancellationToken::new();
        tracing::info!("listening on http://{}", app.addr());
        let told = async {
            stop_signal.await;
            stop.cancel();
        };
        tokio::join!(app.run_until_stopped(stop.clone()), told);
        Ok(())
    });
    // What still reads or writes a file on another thread is not waited for: all that is kept is kept.
    runtime.shutdown_background();
    served
}
