//! Coverage of ranges by the speeds of a sweep, known before anything is computed.

use super::sentence::rpm;
use crate::resolved::ResolvedSweep;
use crate::span::Span;

/// Largest step between neighbouring speeds, as a share of the higher one, by which a range counts as covered: a mode's critical speeds at engine
/// orders 20 and 21 are as far apart, so a wider step passes over whole critical speeds.
const WIDEST_STEP: f64 = 0.05;

/// Lack of speeds in a range.
pub(super) struct NotCovered {
    /// Finding in words.
    pub(super) finding: String,
    /// Way to a decision in words.
    pub(super) remedy: &'static str,
}

impl NotCovered {
    /// Stretches of a range and its separation, or of a sweep without ranges, that no speed of the request covers.
    pub(super) fn of(request: &ResolvedSweep, span: &Span) -> Option<Self> {
        let ascending = request.speeds.ascending();
        let (lowest, highest) = (span.lowest(), span.highest());
        let (first, last) = (ascending.first().copied()?, ascending.last().copied()?);
        if span.name.is_none() && is_same(first, last) {
            let finding = format!("one speed, {}, shows no critical speed", rpm(first));
            return Some(Self { finding, remedy: "ask for a range of `speeds`, in steps of at most 5 %" });
        }
        let mut bare: Vec<(f64, f64)> = Vec::new();
        bare.push((lowest, first.min(highest)));
        let wide = |pair: &&[f64]| pair[1] - pair[0] > WIDEST_STEP * pair[1];
        let within = |pair: &[f64]| (pair[0].max(lowest), pair[1].min(highest));
        bare.extend(ascending.windows(2).filter(wide).map(within));
        bare.push((last.max(lowest), highest));
        bare.retain(|&(from, to)| from < to && !is_same(from, to));
        if bare.is_empty() && !ascending.iter().any(|&speed| span.contains(speed)) {
            bare.push((span.from, span.to));
        }
        let &(from, to) = bare.first()?;
        let more = match bare.len() {
            1 => String::new(),
            2 => ", and one more stretch".to_owned(),
            several => format!(", and {} more stretches", several - 1),
        };
        let finding = format!("no speeds were asked for from {} to {}{more}", rpm(from), rpm(to));
        let remedy = "ask for `speeds` over the whole range and its separation, in steps of at most 5 %";
        Some(Self { finding, remedy })
    }
}

/// Warnings about ranges that the speeds of a request do not cover; none for a request without ranges and limits, which asks for no verdict.
pub(crate) fn coverage_warnings(request: &ResolvedSweep) -> Vec<String> {
    let (ranges_given, spans) = Span::all(request);
    if !ranges_given && !request.is_limited() {
        return Vec::new();
    }
    let warning = |span: &Span| {
        let NotCovered { finding, remedy } = NotCovered::of(request, span)?;
        let on = span.name.as_ref().map_or_else(String::new, |name| format!(" on range \"{name}\""));
        Some(format!("the verdict{on} will be undecided: {finding}; {remedy}"))
    };
    spans.iter().filter_map(warning).collect()
}

/// Whether two speeds are one, up to the conversion of units and the tolerance of a range's ends.
fn is_same(speed: f64, other: f64) -> bool {
    (speed - other).abs() <= 1e-8 * other.abs()
}
