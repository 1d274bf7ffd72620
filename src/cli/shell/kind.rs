//! Kinds of jobs as words of the command line.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::kinds::{JobKind, all};

/// Parser of a kind: its name with hyphens.
pub(super) fn kind() -> impl TypedValueParser<Value = JobKind> {
    let word = |kind: JobKind| PossibleValue::new(kind.name.replace('_', "-")).help(kind.about);
    let read = |word: String| JobKind::named(&word.replace('-', "_")).ok_or("there is no such kind");
    PossibleValuesParser::new(all().map(word)).try_map(read)
}
