//! Commands of a program without the feature `cluster`: no further ones.

use std::convert::Infallible;

/// Command about what several processes share: none.
pub(super) type Command = Infallible;

/// Runs the command.
pub(super) fn run(command: Command) -> anyhow::Result<()> {
    match command {}
}

/// Whether the command runs until a signal ends it.
pub(super) fn is_service(command: &Command) -> bool {
    match *command {}
}
