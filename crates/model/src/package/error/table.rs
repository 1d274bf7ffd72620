//! Problems of the node, DOF and element tables.

use rubmap_solid::defect::Likely;
use rubmap_solid::element::ElementKind;

/// What is wrong with a line of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableProblem {
    /// Number of fields.
    #[error("{found} comma-separated values where {expected} are expected ({columns})")]
    FieldCount {
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
        /// Their names.
        columns: &'static str,
    },
    /// A header whose columns are in another order.
    #[error("the header names its columns in another order than {columns}; reorder them")]
    HeaderOrder {
        /// Expected columns.
        columns: &'static str,
    },
    /// Text that is not a node id.
    #[error("\"{text}\" is not a node id (an integer from 0)")]
    BadId {
        /// The text.
        text: String,
    },
    /// Text that is not a coordinate.
    #[error("{column} is \"{text}\", not a finite number")]
    BadNumber {
        /// Column name.
        column: &'static str,
        /// The text.
        text: String,
    },
    /// Component out of range.
    #[error("component \"{text}\" is not 1, 2 or 3")]
    BadComponent {
        /// The text.
        text: String,
    },
    /// Node id used before.
    #[error("node {node} is already defined on line {first_line}")]
    NodeRepeated {
        /// Its id.
        node: u64,
        /// Line of the first definition.
        first_line: u64,
    },
    /// A DOF of a node that does not exist.
    #[error("node {node} is not in the node table")]
    UnknownNode {
        /// Its id.
        node: u64,
    },
    /// The same DOF on two lines.
    #[error("component {component} of node {node} is already row {first_row} (line {first_line})")]
    DofRepeated {
        /// Node id.
        node: u64,
        /// Component.
        component: u8,
        /// Row of the first mention, from 1.
        first_row: usize,
        /// Its line.
        first_line: u64,
    },
    /// Text that is not an element number.
    #[error("\"{text}\" is not an element number (an integer from 0)")]
    BadElementId {
        /// The text.
        text: String,
    },
    /// An element of a type that is not known.
    #[error(
        "element {element} is of type \"{text}\"; known are {}. Without its mesh the package is valid, and has no stress",
        known_types()
    )]
    UnknownElementType {
        /// Its number.
        element: u64,
        /// The type.
        text: String,
    },
    /// Too few or too many nodes.
    #[error("element {element} has {found} nodes; a {kind} has {expected}")]
    ElementNodeCount {
        /// Its number.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// Nodes given.
        found: usize,
        /// Nodes of the type.
        expected: usize,
    },
    /// An element of a set without material.
    #[error(
        "element {element} is of set \"{set}\", which has no material; give it one at /mesh/sets of sector.json"
    )]
    ElementWithoutMaterial {
        /// Its number.
        element: u64,
        /// The set.
        set: String,
    },
    /// A node that does not exist.
    #[error("element {element} has node {node}, which is not in the node table")]
    ElementNodeUnknown {
        /// Its number.
        element: u64,
        /// The node.
        node: u64,
    },
    /// One node twice in an element.
    #[error(
        "element {element} has node {node} twice; a collapsed element is another type (a wedge C3D6 or C3D15, a tetrahedron \
         C3D4 or C3D10)"
    )]
    ElementNodeRepeated {
        /// Its number.
        element: u64,
        /// The node.
        node: u64,
    },
    /// Element number used before.
    #[error("element {element} is already defined on line {first_line}")]
    ElementRepeated {
        /// Its number.
        element: u64,
        /// Line of the first definition.
        first_line: u64,
    },
    /// An element under two numbers.
    #[error("element {element} has the nodes of element {other} on line {line}; list it once")]
    ElementTwice {
        /// Its second number.
        element: u64,
        /// Its first number.
        other: u64,
        /// Line of the first.
        line: u64,
    },
    /// A face of three elements.
    #[error(
        "element {element} has a face that lies between elements {} and {} already; remove what fills the same space twice",
        .others[0], .others[1]
    )]
    FaceOfThree {
        /// The third.
        element: u64,
        /// The others.
        others: [u64; 2],
    },
    /// Two elements on the same side of a face.
    #[error(
        "elements {other} and {element} lie on the same side of a face; remove what fills the same space twice"
    )]
    OnOneSide {
        /// The second.
        element: u64,
        /// The first.
        other: u64,
    },
    /// A Jacobian determinant that is not positive.
    #[error(
        "element {element} ({kind}) is flipped or degenerate: its Jacobian determinant {} is {determinant:.3e}, not positive; {}",
        match .corner {
            Some(node) => format!("at node {node}"),
            None => "at an integration point".to_owned(),
        },
        match .likely {
            Likely::Mirrored => "all of it is inside out: list the corners of each of its faces the other way round",
            Likely::MiddleNodes => "its corners are in order: move the nodes on its edges nearer to the middle",
            Likely::Other => "list its nodes in CalculiX's order, and look at their positions",
        }
    )]
    ElementFlipped {
        /// Its number.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// The corner where it is so, by its node; otherwise at an integration point.
        corner: Option<u64>,
        /// The determinant.
        determinant: f64,
        /// What it looks like.
        likely: Likely,
    },
    /// A node on an edge that is not near its middle.
    #[error(
        "element {element} ({kind}) lists node {node} for the middle of the edge from node {from} to node {to}, which is far from \
         there; list the nodes on its edges in CalculiX's order"
    )]
    ElementMiddleNode {
        /// Its number.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// The node.
        node: u64,
        /// One end of the edge.
        from: u64,
        /// The other end.
        to: u64,
    },
    /// Elements that share no node with the others.
    #[error(
        "element {element}{} shares no node with the rest of the mesh; merge nodes that lie in one place, or leave out what does \
         not belong to the wheel",
        match .others {
            0 => String::new(),
            1 => " with one more".to_owned(),
            others => format!(" with {others} more"),
        }
    )]
    ElementsApart {
        /// The first of them, by its number.
        element: u64,
        /// How many more belong to it.
        others: usize,
    },
    /// A node that can move and belongs to no element.
    #[error(
        "node {node} has degrees of freedom but belongs to no element of {elements}; add its elements, or leave the mesh out \
         of sector.json"
    )]
    NoElement {
        /// The node.
        node: u64,
        /// File name of the element table.
        elements: String,
    },
    /// A face of an element on the low cut that the high cut has not, or the other way round.
    #[error(
        "element {element} has a face on the {side} cyclic face that no element repeats on the other; mesh both faces alike"
    )]
    FaceNotRepeated {
        /// Its number.
        element: u64,
        /// `low` or `high`.
        side: &'static str,
    },
    /// Nothing in the table.
    #[error("the table has no rows")]
    Empty,
    /// More rows than the limit.
    #[error("the table has more than the {limit} rows this server accepts")]
    TooManyRows {
        /// Configured limit.
        limit: usize,
    },
    /// No newline for very long.
    #[error("the line is longer than {limit} bytes; is this a text file?")]
    LineTooLong {
        /// The longest line accepted.
        limit: usize,
    },
}

/// `C3D4, C3D6, …`.
fn known_types() -> String {
    ElementKind::ALL.map(ElementKind::name).join(", ")
}
