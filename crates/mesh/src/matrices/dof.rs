//! Degrees of freedom as files name them.

use std::fmt;

use crate::error::MeshProblem;
use crate::fields;

use super::file_matrix::MatrixRow;

/// First label that no user of Abaqus may give to a node: labels from here on are of nodes that the program made itself.
const INTERNAL: i64 = 1_000_000_000;

/// Degree of freedom. Negative nodes are internal ones of Abaqus, component 0 is that of a scalar point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Dof {
    pub(super) node: i64,
    pub(super) component: u8,
}

/// Kind of a degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DofKind {
    /// Displacement of a node.
    Translation(MatrixRow),
    /// Rotation of a node.
    Rotation,
    /// Degree of freedom without a place in space: of an internal node, of a scalar point, a temperature.
    Abstract,
}

impl Dof {
    /// Parses the label of a node and the number of a component; an empty component is 0.
    pub(super) fn parsed(node: &str, component: &str) -> Result<Self, MeshProblem> {
        let node = whole(node, "a node number")?;
        let component = component.trim();
        let refused = || MeshProblem::NotA { text: fields::quoted(component), expected: "a component" };
        let component = if component.is_empty() { 0 } else { component.parse().map_err(|_| refused())? };
        Ok(Self { node, component })
    }

    /// Kind.
    pub(super) fn kind(self) -> DofKind {
        match (u64::try_from(self.node), self.component) {
            (Ok(node @ 1..), component @ 1..=3) if self.node < INTERNAL => {
                DofKind::Translation(MatrixRow { node, component })
            }
            (Ok(1..), 4..=6) if self.node < INTERNAL => DofKind::Rotation,
            _ => DofKind::Abstract,
        }
    }
}

/// Parses a whole number of either sign.
pub(super) fn whole(word: &str, expected: &'static str) -> Result<i64, MeshProblem> {
    let word = word.trim();
    word.parse().map_err(|_| MeshProblem::NotA { text: fields::quoted(word), expected })
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { node, component } = self;
        let internal = *node <= 0 || *node >= INTERNAL;
        match (internal, component) {
            (true, 0) => write!(f, "internal node {node}"),
            (true, _) => write!(f, "internal node {node} component {component}"),
            (false, 0) => write!(f, "scalar point {node}"),
            (false, _) => write!(f, "node {node} component {component}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Dof, DofKind};

    #[test]
    fn kinds_and_names() {
        for (node, component, kind, name) in [
            ("7", "4", DofKind::Rotation, "node 7 component 4"),
            ("7", "", DofKind::Abstract, "scalar point 7"),
            ("7", "11", DofKind::Abstract, "node 7 component 11"),
            ("-3", "1", DofKind::Abstract, "internal node -3 component 1"),
            ("1000000000", "1", DofKind::Abstract, "internal node 1000000000 component 1"),
        ] {
            let dof = Dof::parsed(node, component).unwrap();
            assert_eq!((dof.kind(), dof.to_string().as_str()), (kind, name));
        }
        let last = Dof::parsed("999999999", "3").unwrap();
        assert!(matches!(last.kind(), DofKind::Translation(_)));
        assert!(Dof::parsed("1", "256").is_err());
        assert!(Dof::parsed("x", "1").is_err());
    }
}
