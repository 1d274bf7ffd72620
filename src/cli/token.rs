//! `rubmap token`: bearer tokens for a service that is not for everybody.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::tokens::{Scope, new_token};

/// What to do with tokens.
#[derive(Debug, Subcommand)]
pub(super) enum TokenCommand {
    /// Make a token: print it, this once, and append its hash to the file. To withdraw one, delete its line
    New(NewToken),
}

/// Whose token, and what it allows.
#[derive(Debug, Args)]
pub(super) struct NewToken {
    /// File of tokens, made if missing; a service notices within a second
    #[arg(long, env = "RUBMAP_TOKENS")]
    tokens: PathBuf,
    /// Whose it is: models, jobs and idempotency keys belong to an owner, who may have several tokens
    #[arg(long)]
    owner: String,
    /// What it allows
    #[arg(long, value_enum, default_value_t = Scope::Write)]
    scope: Scope,
}

/// Does what the command line says.
pub(super) fn token(
    TokenCommand::New(NewToken { tokens, owner, scope }): TokenCommand,
) -> anyhow::Result<()> {
    println!("{}", new_token(&tokens, &owner, scope)?);
    Ok(())
}
