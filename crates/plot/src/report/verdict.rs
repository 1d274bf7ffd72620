//! Verdict of a report: the first thing that it says.

use maud::{Markup, html};
use rubmap_analysis::result::SweepVerdict;

/// Renders the sentence of a verdict with its word and its colour.
pub(super) fn sentence(verdict: &SweepVerdict) -> Markup {
    let (word, rest) =
        verdict.sentence.split_once(':').unwrap_or((verdict.verdict.as_str(), &verdict.sentence));
    html! {
        p class={ "verdict " (verdict.verdict) } { strong { (word) ":" } (rest) }
    }
}
