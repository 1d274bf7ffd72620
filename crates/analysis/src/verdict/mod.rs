//! Verdict on a sweep by the operating ranges and limits of its request: pure functions over what is stored. The rule is in `rule`, and in
//! docs/reading-results.md.

mod judge;
mod level;
mod limit;
mod open;
mod points;
mod range;
mod rule;
pub(crate) mod sentence;
#[cfg(test)]
mod tests;

pub use judge::judge;
pub use level::level;
pub(crate) use range::Span;
