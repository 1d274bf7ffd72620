//! Verdict on a sweep by the operating ranges and limits of its request: pure functions over what is stored. The rule is in `rule`, and in
//! docs/reading-results.md.

mod coverage;
mod evidence;
mod hidden;
mod judge;
mod level;
mod limit;
mod open;
mod points;
mod rule;
pub(crate) mod sentence;
#[cfg(test)]
mod tests;

pub(crate) use coverage::coverage_warnings;
pub use evidence::Evidence;
pub(crate) use hidden::wanted;
pub use judge::judge;
pub use level::level;
