//! Set whose lines are read at once or, where it names an instance, kept until its part is known.

use super::scope::Scope;
use super::work::Work;
use crate::error::MeshProblem;

/// Set that is asked for, whose lines state what is in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Request {
    /// Whether it is a set of nodes; else of elements.
    pub(super) nodes: bool,
    /// Name of the set.
    pub(super) name: String,
    /// Whether its lines are ranges.
    pub(super) generate: bool,
}

impl Request {
    /// Adds what a line states to the set.
    pub(super) fn answer(
        &self,
        scope: &mut Scope,
        words: &[&str],
        work: &mut Work,
    ) -> Result<(), MeshProblem> {
        if self.nodes {
            scope.node_set(&self.name, self.generate, words, work)
        } else {
            scope.element_set(&self.name, self.generate, words, work)
        }
    }
}
