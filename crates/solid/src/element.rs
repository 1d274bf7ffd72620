//! Kinds of elements that a mesh may have.

use serde::{Deserialize, Serialize};

/// Shape and displacement functions of an element, by the name that CalculiX has for it, or Abaqus for the pyramids, which CalculiX lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ElementKind {
    /// 4-node tetrahedron.
    C3D4,
    /// 5-node pyramid.
    C3D5,
    /// 6-node wedge.
    C3D6,
    /// 8-node hexahedron, 2 × 2 × 2 integration points.
    C3D8,
    /// 8-node hexahedron with incompatible modes, as CalculiX takes their gradients.
    C3D8I,
    /// 10-node tetrahedron.
    C3D10,
    /// 13-node pyramid.
    C3D13,
    /// 15-node wedge.
    C3D15,
    /// 20-node hexahedron, 3 × 3 × 3 integration points.
    C3D20,
    /// 20-node hexahedron, 2 × 2 × 2 integration points.
    C3D20R,
    /// 8-node hexahedron with the incompatible modes of Taylor, Beresford and Wilson, which pass the patch test on crooked elements: the
    /// element of the generator. CalculiX has none such.
    QM6,
}

impl ElementKind {
    /// Every kind of element.
    pub const ALL: [Self; 11] = [
        Self::C3D4,
        Self::C3D5,
        Self::C3D6,
        Self::C3D8,
        Self::C3D8I,
        Self::C3D10,
        Self::C3D13,
        Self::C3D15,
        Self::C3D20,
        Self::C3D20R,
        Self::QM6,
    ];

    /// Name of the element: that of CalculiX or Abaqus, where they have one.
    pub fn name(self) -> &'static str {
        match self {
            Self::C3D4 => "C3D4",
            Self::C3D5 => "C3D5",
            Self::C3D6 => "C3D6",
            Self::C3D8 => "C3D8",
            Self::C3D8I => "C3D8I",
            Self::C3D10 => "C3D10",
            Self::C3D13 => "C3D13",
            Self::C3D15 => "C3D15",
            Self::C3D20 => "C3D20",
            Self::C3D20R => "C3D20R",
            Self::QM6 => "QM6",
        }
    }

    /// Element of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether the element has incompatible modes.
    pub fn has_bubbles(self) -> bool {
        matches!(self, Self::C3D8I | Self::QM6)
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::C3D4 => 4,
            Self::C3D5 => 5,
            Self::C3D6 => 6,
            Self::C3D8 | Self::C3D8I | Self::QM6 => 8,
            Self::C3D10 => 10,
            Self::C3D13 => 13,
            Self::C3D15 => 15,
            Self::C3D20 | Self::C3D20R => 20,
        }
    }

    /// Number of nodes that are corners; they come first.
    pub fn corners(self) -> usize {
        match self {
            Self::C3D4 | Self::C3D10 => 4,
            Self::C3D5 | Self::C3D13 => 5,
            Self::C3D6 | Self::C3D15 => 6,
            Self::C3D8 | Self::C3D8I | Self::QM6 | Self::C3D20 | Self::C3D20R => 8,
        }
    }
}
