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
    /// File of no known format of matrices.
    #[error(
        "this is no matrix file of a known format; known are Abaqus (*MATRIX OUTPUT, FORMAT=MATRIX INPUT or LABELS), Nastran (DMIG on \
         punch or bulk data, OUTPUT4 in text or binary form) and Ansys (*EXPORT in format MMF, HBMAT in text form, each with its mapping file)"
    )]
    UnknownMatrix,
    /// File of a known kind that is not the kind asked for.
    #[error("this is {found}; {advice}")]
    NotAMesh {
        /// Kind of the file, such as `a Matrix Market file`.
        found: &'static str,
        /// Advice on the way to go.
        advice: &'static str,
    },
    /// File packed by gzip that is damaged or too large.
    #[error("the packed file {problem}")]
    Packed {
        /// Problem with the file, and what to do.
        problem: String,
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
    /// Number given to two nodes, to two elements, or to two rows of a matrix.
    #[error("{what} {id} is there twice")]
    Twice {
        /// `node`, `element` or `row`.
        what: &'static str,
        /// Number of the node, element or row.
        id: u64,
    },
    /// Position of a matrix for which the file has two entries.
    #[error("the entry of row {row} and column {column} is there twice")]
    EntryTwice {
        /// Row, such as `node 12 component 1`.
        row: String,
        /// Column, such as `node 12 component 2`.
        column: String,
    },
    /// Matrix that differs from its transpose.
    #[error(
        "the matrix is not symmetric: row {row}, column {column} has {value:e}, but row {column}, column {row} has {mirrored:e}"
    )]
    NotSymmetric {
        /// Row, such as `node 12 component 1`.
        row: String,
        /// Column, such as `node 12 component 2`.
        column: String,
        /// Entry there.
        value: f64,
        /// Entry at the mirrored position.
        mirrored: f64,
    },
    /// Degree of freedom to which a mapping gives two rows.
    #[error("{dof} has two rows")]
    TwoRows {
        /// Degree of freedom, such as `node 12 component 1`.
        dof: String,
    },
    /// File of several matrices, none of which was chosen.
    #[error("the file has several matrices: {names}; name the one to read")]
    WhichMatrix {
        /// Names of the matrices.
        names: String,
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
