//! Fixed cases of properties in tests: the same tree gives the same verdict.

use proptest::test_runner::{Config, RngSeed};

/// Configuration for `cases` from one seed for good. A failure that was once found becomes a test by name, not a file that only one machine has.
pub(crate) fn fixed(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(0), failure_persistence: None, ..Config::default() }
}
