//! Fuzz target `sweep` (see `fuzz/`) without a fuzzer: over its stored corpus, and over requests drawn from a grammar.

#[path = "../properties/campaign.rs"]
mod campaign;
#[path = "../properties/fixed.rs"]
mod fixed;
#[path = "../physics/fixtures.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod fixtures;
mod grammar;
mod sweep;

use std::path::Path;

use proptest::prelude::*;

use campaign::campaign;
use fixed::fixed;
use sweep::{End, run};

fn corpus() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/sweep");
    let mut bodies: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap()))
        .collect();
    bodies.sort();
    bodies
}

/// Corpus of the fuzzer: it reaches every end, so that what is mutated from it starts everywhere; a file's name says which.
#[test]
fn the_corpus_ends_as_its_names_say() {
    let corpus = corpus();
    for (name, body) in &corpus {
        let end = run(body);
        let (said, _) = name.split_once('-').unwrap();
        let expected = match end {
            End::NotParsed => "unparsed",
            End::Refused => "refused",
            End::TooLong => "long",
            End::Ran { completed: 0 } => "failed",
            End::Ran { .. } => "ran",
        };
        assert_eq!(said, expected, "{name}");
    }
    for said in ["unparsed", "refused", "long", "failed", "ran"] {
        assert!(corpus.iter().any(|(name, _)| name.starts_with(said)), "{said}");
    }
}

/// Body of a request: bytes that are mostly text, and shown as such.
struct Body(Vec<u8>);

impl std::fmt::Debug for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.0.escape_ascii())
    }
}

/// Stored bodies of the corpus with a few bytes changed.
fn damaged() -> impl Strategy<Value = Body> {
    let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4);
    (prop::sample::select(corpus()), changes).prop_map(|((_, mut body), changes)| {
        for (place, byte) in changes {
            if !body.is_empty() {
                let place = place.index(body.len());
                body[place] = byte;
            }
        }
        Body(body)
    })
}

proptest! {
    #![proptest_config(fixed(3000))]

    /// Requests of valid, extreme and wrong parts.
    #[test]
    fn requests_from_the_grammar(body in grammar::request()) {
        run(body.as_bytes());
    }

    #[test]
    fn damaged_bodies(Body(body) in damaged()) {
        run(&body);
    }
}

/// Campaign of both properties without an end: `cargo test --release campaign -- --ignored --nocapture`.
#[test]
#[ignore = "a campaign: runs for as long as one likes"]
fn campaign_of_requests() {
    campaign("requests from the grammar", grammar::request(), |body| {
        run(body.as_bytes());
        Ok(())
    });
}

#[test]
#[ignore = "a campaign: runs for as long as one likes"]
fn campaign_of_damaged_bodies() {
    campaign("damaged bodies", damaged(), |Body(body)| {
        run(&body);
        Ok(())
    });
}
