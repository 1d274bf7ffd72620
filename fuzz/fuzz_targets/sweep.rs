//! Fuzzes sweeps: any bytes as the body of a request, then a short simulation; `cargo test` runs the same on the stored corpus.

#![no_main]

#[path = "../../tests/physics/fixtures.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod fixtures;
#[path = "../../tests/fuzz_corpus/sweep.rs"]
mod sweep;

libfuzzer_sys::fuzz_target!(|body: &[u8]| {
    sweep::run(body);
});
