//! Rebuilds the program when a migration or a file of the page comes or goes, which it embeds, and tells it what it is built from.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=migrations");
    println!("cargo:rerun-if-changed=web");
    println!("cargo:rerun-if-env-changed=RUBMAP_COMMIT");
    let commit = commit().or_else(|| std::env::var("RUBMAP_COMMIT").ok().filter(|commit| !commit.is_empty()));
    tell("COMMIT", &commit.unwrap_or_else(|| "unknown".to_owned()));
    tell("PROFILE", &std::env::var("PROFILE").unwrap_or_default());
    tell("TARGET", &std::env::var("TARGET").unwrap_or_default());
    tell("TARGET_FEATURES", &std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default());
}

fn tell(name: &str, value: &str) {
    println!("cargo:rustc-env=RUBMAP_BUILT_{name}={value}");
}

/// Commit of the repository whose root this package is, if there is one and `git` to read it. Looked at again when it moves.
fn commit() -> Option<String> {
    // Sources without a history, unpacked somewhere inside another repository, are none of its commits.
    if !Path::new(".git").exists() {
        return None;
    }
    let commit = git(&["rev-parse", "HEAD"])?;
    // The log of HEAD grows with every commit and checkout; where none is kept, HEAD itself changes with checkouts at least.
    let watched =
        ["logs/HEAD", "HEAD"].into_iter().filter_map(|name| git(&["rev-parse", "--git-path", name]));
    if let Some(file) = watched.into_iter().find(|file| Path::new(file).exists()) {
        println!("cargo:rerun-if-changed={file}");
    }
    Some(commit)
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}
