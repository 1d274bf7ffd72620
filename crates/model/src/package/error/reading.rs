//! Ways to read the rows of a package, other than it states.

use std::fmt;

/// Reading of the rows of the matrices other than the stated one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowReading {
    /// Components of all nodes in the other frame.
    OtherFrame {
        /// Name of the other frame.
        meant: &'static str,
    },
    /// Components of face nodes in the other frame.
    FacesInOtherFrame {
        /// Name of the other frame.
        meant: &'static str,
    },
    /// Components of high face nodes along axes that are turned with the sector.
    HighFaceTurned,
    /// Nodes in the order of the DOF table, the components of each together.
    ByNode,
    /// Nodes in another order.
    NodesInOtherOrder {
        /// Order of the nodes.
        order: &'static str,
    },
    /// Components in turn: first all components 1, then all 2, then all 3.
    ByComponent {
        /// Order of the nodes.
        order: &'static str,
    },
}

/// Way to read the rows of the high face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceReading {
    /// The low face has the part of the high one already.
    Twice,
    /// Components in the other frame.
    OtherFrame {
        /// Name of that frame.
        meant: &'static str,
    },
    /// All components with the other sign.
    OtherSign,
    /// One component with the other sign.
    OtherSignOf {
        /// Component, from 1.
        component: usize,
    },
    /// Components along axes turned with the sector.
    Turned,
    /// Nodes in another order.
    OtherOrder {
        /// The order.
        order: &'static str,
    },
}

impl fmt::Display for FaceReading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Twice => f.write_str(
                "the block of the high face against itself is left out, whose part is in that of the low face already: export the sector \
                 alone, not cut out of the matrices of the wheel",
            ),
            Self::OtherFrame { meant } => write!(
                f,
                "the components of the nodes on the high face alone are {meant}: export all nodes in one frame"
            ),
            Self::OtherSign => f.write_str("the rows of the high face have the other sign: export them as those of all nodes"),
            Self::OtherSignOf { component } => {
                write!(f, "component {component} of the nodes on the high face has the other sign: export all nodes in one frame")
            }
            Self::Turned => f.write_str(
                "the components of the nodes on the high face are along axes turned by a sector: export all nodes in one frame",
            ),
            Self::OtherOrder { order } => write!(
                f,
                "the nodes of the high face are in the order {order}: list the rows of the DOF table as the matrices have them"
            ),
        }
    }
}

impl fmt::Display for RowReading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherFrame { meant } => write!(f, "their components are {meant}: say \"frame\": \"{meant}\""),
            Self::FacesInOtherFrame { meant } => write!(
                f,
                "the components of the nodes on the cyclic faces alone are {meant}: export all nodes in one frame"
            ),
            Self::HighFaceTurned => f.write_str(
                "the components of the nodes on the high face are along axes turned with the sector: export all nodes in one frame",
            ),
            Self::ByNode => f.write_str(
                "the matrices have the components of each node together: list the rows of the DOF table in that order",
            ),
            Self::NodesInOtherOrder { order } => write!(
                f,
                "the matrices have the nodes in the order of {order}: list the rows of the DOF table as the matrices have them"
            ),
            Self::ByComponent { order } => write!(
                f,
                "the matrices have all components 1 first, then all 2, then all 3, nodes in the order of {order}: list the rows of the \
                 DOF table as the matrices have them"
            ),
        }
    }
}
