//! `rubmap serve`: runs the HTTP service until a signal ends it.

use std::io;
use std::pin::pin;

use clap::Args;

use crate::app::{App, Role};
use crate::config::Config;
use tokio_util::sync::CancellationToken;

use super::signals::stop_signal;

/// Settings of a service, and when it stops.
#[derive(Debug, Args)]
pub(super) struct ServeArgs {
    #[command(flatten)]
    config: Config,
    /// Stop, too, when standard input ends: for a program that starts a service of its own, which then does not outlive it
    #[arg(long)]
    until_eof: bool,
}

/// Runs the service until SIGTERM or SIGINT.
pub(super) fn run(args: ServeArgs) -> anyhow::Result<()> {
    until_told(args.config, Role::Service, args.until_eof)
}

/// Runs a process of this role until a signal or, with `until_eof`, the end of standard input.
pub(super) fn until_told(config: Config, role: Role, until_eof: bool) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let stop_signal = stop_signal()?;
        let mut end = pin!(async {
            tokio::select! {
                () = stop_signal => {}
                () = input_ended(), if until_eof => {}
            }
        });
        let app = tokio::select! {
            app = App::build_as(role, config) => app?,
            () = &mut end => return Ok(()),
        };
        let stop = CancellationToken::new();
        tracing::info!("listening on http://{}", app.addr());
        let told = async {
            end.await;
            stop.cancel();
        };
        tokio::join!(app.run_until_stopped(stop.clone()), told);
        Ok(())
    });
    // Threads that still read or write a file are not waited for: all that is to be stored is stored.
    runtime.shutdown_background();
    served
}

/// Completes when standard input has ended, or cannot be read.
async fn input_ended() {
    let _ = tokio::task::spawn_blocking(|| io::copy(&mut io::stdin().lock(), &mut io::sink())).await;
}
