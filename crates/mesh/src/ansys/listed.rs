//! Names in a row, for notes.

use crate::fields::quoted;

/// Most names that a note lists.
const LISTED: usize = 10;

/// Names in a row, the first of many.
pub(super) fn listed(names: &[String]) -> String {
    let first: Vec<String> = names.iter().take(LISTED).map(|name| quoted(name)).collect();
    let others = names.len() - first.len();
    let others = if others == 0 { String::new() } else { format!(" and {others} others") };
    format!("{}{others}", first.join(", "))
}
