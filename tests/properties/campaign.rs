//! Campaigns of properties drawn anew at every call, for as long as one likes: they find what tests of fixed cases have not thought of.
//!
//! `RUBMAP_CAMPAIGN_SECONDS` bounds the time (60 unless given), `RUBMAP_CAMPAIGN_SEED` repeats cases from a seed that was printed.

use std::collections::hash_map::RandomState;
use std::fmt::Debug;
use std::hash::BuildHasher;
use std::time::{Duration, Instant};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngSeed, TestCaseResult, TestRunner};

/// Time between two lines about a campaign that goes on.
const TOLD_EVERY: Duration = Duration::from_secs(60);

/// Time in milliseconds after which minimising a failure ends.
const SHRINKING_MS: u32 = 60_000;

/// Tests `property` on cases of `strategy` until the time is over; panics at its end if any case failed.
pub(crate) fn campaign<S>(name: &str, strategy: S, property: impl Fn(S::Value) -> TestCaseResult)
where
    S: Strategy,
    S::Value: Debug,
{
    let given = |variable: &str| {
        let value = std::env::var(variable).ok()?;
        Some(value.parse::<u64>().unwrap_or_else(|_| panic!("{variable}={value} is no whole number")))
    };
    let seconds = given("RUBMAP_CAMPAIGN_SECONDS").unwrap_or(60);
    // Hashing is keyed by chance, so that the seed is random.
    let first = given("RUBMAP_CAMPAIGN_SEED").unwrap_or_else(|| RandomState::new().hash_one(name) >> 16);
    println!("{name}: {seconds} s from RUBMAP_CAMPAIGN_SEED={first}");
    let start = Instant::now();
    let (mut cases, mut failures, mut told) = (0, 0, start);
    while cases == 0 || start.elapsed() < Duration::from_secs(seconds) {
        // Every case has a seed of its own, so that a failure is repeated at once.
        let seed = first.wrapping_add(cases);
        let config = Config {
            cases: 1,
            rng_seed: RngSeed::Fixed(seed),
            failure_persistence: None,
            max_shrink_iters: 100_000,
            max_shrink_time: SHRINKING_MS,
            ..Config::default()
        };
        if let Err(failure) = TestRunner::new(config).run(&strategy, &property) {
            failures += 1;
            println!("{name}: RUBMAP_CAMPAIGN_SEED={seed} RUBMAP_CAMPAIGN_SECONDS=0 repeats\n{failure}");
        }
        cases += 1;
        if told.elapsed() > TOLD_EVERY {
            told = Instant::now();
            println!("{name}: {cases} cases, {failures} failures so far");
        }
    }
    println!(
        "{name}: {cases} cases from seed {first}, {failures} failures, {:.0} s",
        start.elapsed().as_secs_f64()
    );
    assert_eq!(failures, 0, "{name}: failures are printed above");
}
