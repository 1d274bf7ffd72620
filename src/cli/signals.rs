//! Signals that ask the program to stop.

use tokio::signal::unix::{SignalKind, signal};

/// Future that completes at the first SIGTERM or SIGINT from now on.
pub(super) fn stop_signal() -> std::io::Result<impl Future<Output = ()>> {
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
    })
}
