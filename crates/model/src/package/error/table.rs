//! Problems of the node, DOF and element tables.

use rubmap_solid::defect::Likely;
use rubmap_solid::element::ElementKind;

/// Problem of a line of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableProblem {
    /// Line with the wrong number of fields.
    #[error("{found} comma-separated values where {expected} are expected ({columns})")]
    FieldCount {
        /// Number of fields found.
        found: usize,
        /// Number of fields expected.
        expected: usize,
        /// Names of the columns.
        columns: &'static str,
    },
    /// Header whose columns are in another order.
    #[error("the header names its columns in another order than {columns}; reorder them")]
    HeaderOrder {
        /// Names of the columns in the expected order.
        columns: &'static str,
    },
    /// Header that names cylindrical coordinates.
    #[error("the header names {name:?}, where {columns} are read: write Cartesian coordinates")]
    HeaderCylindrical {
        /// Name that is of other coordinates.
        name: String,
        /// Names of the expected columns.
        columns: &'static str,
    },
    /// Text that is not a node id.
    #[error("\"{text}\" is not a node id (an integer from 0)")]
    BadId {
        /// Text found.
        text: String,
    },
    /// Text that is not a coordinate.
    #[error("{column} is \"{text}\", not a finite number")]
    BadNumber {
        /// Name of the column.
        column: &'static str,
        /// Text found.
        text: String,
    },
    /// Component other than 1, 2 and 3.
    #[error("component \"{text}\" is not 1, 2 or 3")]
    BadComponent {
        /// Text found.
        text: String,
    },
    /// Node id that was used before.
    #[error("node {node} is already defined on line {first_line}")]
    NodeRepeated {
        /// Id of the node.
        node: u64,
        /// Line of the first definition.
        first_line: u64,
    },
    /// DOF of a node that does not exist.
    #[error("node {node} is not in the node table")]
    UnknownNode {
        /// Id of the node.
        node: u64,
    },
    /// DOF that is listed on two lines.
    #[error("component {component} of node {node} is already row {first_row} (line {first_line})")]
    DofRepeated {
        /// Id of the node.
        node: u64,
        /// Component of the node.
        component: u8,
        /// Row of the first mention, from 1.
        first_row: usize,
        /// Line of the first mention.
        first_line: u64,
    },
    /// Text that is not an element number.
    #[error("\"{text}\" is not an element number (an integer from 0)")]
    BadElementId {
        /// Text found.
        text: String,
    },
    /// Element of a type that is not known.
    #[error(
        "element {element} is of type \"{text}\"; known are {}. Without its mesh the package is valid, and has no stress",
        known_types()
    )]
    UnknownElementType {
        /// Number of the element.
        element: u64,
        /// Type found.
        text: String,
    },
    /// Element with too few or too many nodes.
    #[error("element {element} has {found} nodes; a {kind} has {expected}")]
    ElementNodeCount {
        /// Number of the element.
        element: u64,
        /// Type of the element.
        kind: &'static str,
        /// Number of nodes given.
        found: usize,
        /// Number of nodes of the type.
        expected: usize,
    },
    /// Element of a set without material.
    #[error(
        "element {element} is of set \"{set}\", which has no material; give it one at /mesh/sets of sector.json"
    )]
    ElementWithoutMaterial {
        /// Number of the element.
        element: u64,
        /// Name of the set.
        set: String,
    },
    /// Node of an element that does not exist.
    #[error("element {element} has node {node}, which is not in the node table")]
    ElementNodeUnknown {
        /// Number of the element.
        element: u64,
        /// Id of the node.
        node: u64,
    },
    /// Element with one node twice.
    #[error(
        "element {element} has node {node} twice; a collapsed element is another type (a wedge C3D6 or C3D15, a pyramid C3D5 or \
         C3D13, a tetrahedron C3D4 or C3D10)"
    )]
    ElementNodeRepeated {
        /// Number of the element.
        element: u64,
        /// Id of the node.
        node: u64,
    },
    /// Element number that was used before.
    #[error("element {element} is already defined on line {first_line}")]
    ElementRepeated {
        /// Number of the element.
        element: u64,
        /// Line of the first definition.
        first_line: u64,
    },
    /// Element that is listed under two numbers.
    #[error("element {element} has the nodes of element {other} on line {line}; list it once")]
    ElementTwice {
        /// Second number of the element.
        element: u64,
        /// First number of the element.
        other: u64,
        /// Line of the first number.
        line: u64,
    },
    /// Face of three elements.
    #[error(
        "element {element} has a face that lies between elements {} and {} already; remove what fills the same space twice",
        .others[0], .others[1]
    )]
    FaceOfThree {
        /// Number of the third element.
        element: u64,
        /// Numbers of the other two elements.
        others: [u64; 2],
    },
    /// Two elements on the same side of a face.
    #[error(
        "elements {other} and {element} lie on the same side of a face; remove what fills the same space twice"
    )]
    OnOneSide {
        /// Number of the second element.
        element: u64,
        /// Number of the first element.
        other: u64,
    },
    /// Element with a Jacobian determinant that is not positive.
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
        /// Number of the element.
        element: u64,
        /// Type of the element.
        kind: &'static str,
        /// Node of the corner at which the determinant was taken; none at an integration point.
        corner: Option<u64>,
        /// Jacobian determinant.
        determinant: f64,
        /// Likely cause.
        likely: Likely,
    },
    /// Node on an edge that is not near the middle of the edge.
    #[error(
        "element {element} ({kind}) lists node {node} for the middle of the edge from node {from} to node {to}, which is far from \
         there; list the nodes on its edges in CalculiX's order"
    )]
    ElementMiddleNode {
        /// Number of the element.
        element: u64,
        /// Type of the element.
        kind: &'static str,
        /// Id of the node.
        node: u64,
        /// Node at one end of the edge.
        from: u64,
        /// Node at the other end.
        to: u64,
    },
    /// Elements that share no node with the rest.
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
        /// Number of the first of these elements.
        element: u64,
        /// Number of further elements connected to it.
        others: usize,
    },
    /// Node that can move and belongs to no element.
    #[error(
        "node {node} has degrees of freedom but belongs to no element of {elements}; add its elements, or leave the mesh out \
         of sector.json"
    )]
    NoElement {
        /// Id of the node.
        node: u64,
        /// File name of the element table.
        elements: String,
    },
    /// Face of an element on one cyclic face that has no copy on the other.
    #[error(
        "element {element} has a face on the {side} cyclic face that no element repeats on the other; mesh both faces alike"
    )]
    FaceNotRepeated {
        /// Number of the element.
        element: u64,
        /// Cyclic face: `low` or `high`.
        side: &'static str,
    },
    /// Table without rows.
    #[error("the table has no rows")]
    Empty,
    /// Table with more rows than the limit.
    #[error("the table has more than the {limit} rows this server accepts")]
    TooManyRows {
        /// Largest number of rows, as configured.
        limit: usize,
    },
    /// Line that is too long.
    #[error("the line is longer than {limit} bytes; is this a text file?")]
    LineTooLong {
        /// Longest line accepted, in bytes.
        limit: usize,
    },
}

/// List of the known types, `C3D4, C3D6, …`.
fn known_types() -> String {
    ElementKind::ALL.map(ElementKind::name).join(", ")
}
