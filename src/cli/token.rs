//! `rubmap token`: makes bearer tokens for a service that is not for everybody.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::cli::stdout::print;
use crate::tokens::{Scope, new_token};

/// Command about tokens.
#[derive(Debug, Subcommand)]
pub(super) enum TokenCommand {
    /// Make a token: print it, this once, and append its hash to the file. To withdraw one, delete its line
    New(NewToken),
}

/// Owner and scope of a new token.
#[derive(Debug, Args)]
pub(super) struct NewToken {
    /// File of tokens, made if missing; a service notices within a second
    #[arg(long, env = "RUBMAP_TOKENS")]
    tokens: PathBuf,
    /// Owner of the token: models, jobs and idempotency keys belong to an owner, who may have several tokens
    #[arg(long)]
    owner: String,
    /// Scope of the token: what it allows
    #[arg(long, value_enum, default_value_t = Scope::Write)]
    scope: Scope,
}

/// Runs a command about tokens.
pub(super) fn token(
    TokenCommand::New(NewToken { tokens, owner, scope }): TokenCommand,
) -> anyhow::Result<()> {
    print(&new_token(&tokens, &owner, scope)?)?;
    Ok(())
}
