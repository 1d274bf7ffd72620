//! Refusals of mesh files, each with its place.

/// Refusal of a mesh file: where, and what is wrong there.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{problem}", place(*.line, .card))]
pub struct MeshFileError {
    /// Number of the line, from 1; 0 where the format has no lines or the whole file is at fault.
    pub line: u64,
    /// Card or section, such as `*ELEMENT`, `CTETRA`, `EBLOCK`, `$Elements`; empty where none is at fault.
    pub card: String,
    /// Problem there.
    pub problem: MeshProblem,
}

/// Problem of a mesh file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// File of no known format.
    #[error(
        "this is no mesh file of a known format; known are CalculiX and Abaqus decks (.inp), Gmsh (.msh 2.2 and 4.1, ASCII or binary), \
         Nastran bulk data, Ansys archives (.cdb) and VTK XML files (.vtu)"
    )]
    Unknown,
    /// File of a known kind that holds no mesh.
    #[error("this is {found}, not a mesh; {advice}")]
    NotAMesh {
        /// Kind of the file, such as `a Matrix Market file`.
        found: &'static str,
        /// Advice on the way to go.
        advice: &'static str,
    },
    /// Text that is not of the kind expected.
    #[error("\"{text}\" is not {expected}")]
    NotA {
        /// Text found, shortened.
        text: String,
        /// Kind of text expected, with its article: `a node number`.
        expected: &'static str,
    },
    /// Line without the expected entries.
    #[error("expected {expected}")]
    Expected {
        /// Entries expected there.
        expected: String,
    },
    /// File that ends too early.
    #[error("the file ends here, before {expected}: is it cut short?")]
    CutShort {
        /// Content that should follow.
        expected: String,
    },
    /// Number given to two nodes or to two elements.
    #[error("{what} {id} is there twice")]
    Twice {
        /// `node` or `element`.
        what: &'static str,
        /// Number of the node or element.
        id: u64,
    },
    /// Element with a node that the file does not have.
    #[error("element {element} has node {node}, which the file does not have")]
    NoSuchNode {
        /// Number of the element.
        element: u64,
        /// Number of the node.
        node: u64,
    },
    /// Set or material that the file names but does not have.
    #[error("there is no {what} \"{name}\" in the file")]
    NoSuch {
        /// Kind of the thing, such as `element set`.
        what: &'static str,
        /// Name of the thing, shortened.
        name: String,
    },
    /// Content that a model cannot carry over.
    #[error("{what} cannot be carried over: {advice}")]
    NotCarried {
        /// Content, such as `a multi-point constraint`.
        what: String,
        /// Reason, and advice on what to do.
        advice: &'static str,
    },
    /// Hexahedron with repeated nodes that is no wedge, pyramid or tetrahedron.
    #[error(
        "element {element} repeats nodes in a way that makes no wedge, pyramid or tetrahedron of a hexahedron"
    )]
    Collapsed {
        /// Number of the element.
        element: u64,
    },
    /// File that another one includes and that cannot be read.
    #[error("the included file \"{name}\" cannot be read: {reason}")]
    Include {
        /// Name of the file, as written.
        name: String,
        /// Reason.
        reason: String,
    },
    /// Files that include each other without end.
    #[error("files include each other more than {limit} deep")]
    TooDeep {
        /// Largest depth.
        limit: usize,
    },
    /// File without a solid element.
    #[error("the file has no solid element{left_out}")]
    NoSolids {
        /// Elements that were left out, as ` (left out: 38 of type S4)`, or nothing.
        left_out: String,
    },
}

impl MeshProblem {
    /// Error with its place.
    pub fn at(self, line: u64, card: &str) -> MeshFileError {
        MeshFileError { line, card: card.to_owned(), problem: self }
    }
}

/// Beginning of a message, such as `line 7 (*ELEMENT): `.
fn place(line: u64, card: &str) -> String {
    match (line, card) {
        (0, "") => String::new(),
        (0, card) => format!("{card}: "),
        (line, "") => format!("line {line}: "),
        (line, card) => format!("line {line} ({card}): "),
    }
}
