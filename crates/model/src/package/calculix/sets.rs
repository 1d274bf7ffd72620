//! Node sets by name.

use super::deck::Deck;
use super::error::ModelProblem;
use super::text::normal;
use crate::package::quote::quoted;

/// Largest number of node sets that an error lists.
const MOST_NAMED: usize = 20;

/// Nodes of the set `name`, at least one.
pub(super) fn set<'a>(deck: &'a Deck, name: &str) -> Result<&'a [u64], ModelProblem> {
    match deck.sets.get(&normal(name)) {
        None => {
            let known: Vec<String> = deck.sets.keys().take(MOST_NAMED).map(|name| quoted(name)).collect();
            let more = deck.sets.len() - known.len();
            Err(ModelProblem::NoSuchSet { set: name.to_owned(), known, more })
        }
        Some(nodes) if nodes.is_empty() => Err(ModelProblem::EmptySet { set: name.to_owned() }),
        Some(nodes) => Ok(nodes),
    }
}
