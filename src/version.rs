//! Sources and settings that this program was built from.

/// Version of the package.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Commit of the sources; `unknown` if they came without their history.
pub const COMMIT: &str = env!("RUBMAP_BUILT_COMMIT");

/// Profile of the build: `release` or `debug`.
pub const PROFILE: &str = env!("RUBMAP_BUILT_PROFILE");

/// Target triple of the build.
pub const TARGET: &str = env!("RUBMAP_BUILT_TARGET");

/// Features of the processor that every part of the program may use; the inner loops choose more of them as they run.
pub const TARGET_FEATURES: &str = env!("RUBMAP_BUILT_TARGET_FEATURES");

/// Version, commit and build settings in one line for people.
pub const LINE: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (commit ",
    env!("RUBMAP_BUILT_COMMIT"),
    ", ",
    env!("RUBMAP_BUILT_PROFILE"),
    " build for ",
    env!("RUBMAP_BUILT_TARGET"),
    " with ",
    env!("RUBMAP_BUILT_TARGET_FEATURES"),
    ")"
);
