//! What can be wrong with CalculiX files, each problem with the place and what to do.

use std::path::PathBuf;

use crate::package::error::PackageError;

/// Files that cannot become a package.
#[derive(Debug, thiserror::Error)]
pub enum CalculixError {
    /// The operating system could not read a file.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A line of a file.
    #[error("{}, line {line}: {problem}", .path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What is wrong there.
        problem: LineProblem,
    },
    /// What the files say together.
    #[error(transparent)]
    Model(#[from] ModelProblem),
    /// What the checks of every package found.
    #[error(transparent)]
    Package(#[from] PackageError),
}

/// What is wrong with a line.
#[derive(Debug, thiserror::Error)]
pub enum LineProblem {
    /// A word that is not the number its place asks for.
    #[error("\"{text}\" is not {expected}")]
    NotA {
        /// The word.
        text: String,
        /// Such as `a node number`.
        expected: &'static str,
    },
    /// Too few or too many words.
    #[error("expected {expected}")]
    Words {
        /// The form of the line.
        expected: &'static str,
    },
    /// A node at two places.
    #[error("node {node} was at another place before; keep one of the two definitions")]
    NodeMoved {
        /// Its number.
        node: u64,
    },
    /// A set used before it is defined.
    #[error("the set {set} is not defined before this line")]
    UnknownSet {
        /// Its name.
        set: String,
    },
    /// A card whose effect on the matrices cannot be undone here.
    #[error(
        "{card} is not supported: DOF of transformed nodes are not in global directions; export the matrices without it"
    )]
    Card {
        /// The keyword.
        card: String,
    },
    /// Includes that include themselves.
    #[error("*INCLUDE goes deeper than {limit} files; does a file include itself?")]
    TooDeep {
        /// The limit.
        limit: usize,
    },
    /// A row of a matrix that the DOF list does not have.
    #[error("entry ({row}, {column}) is outside the {size} rows that {} lists", .dof_file.display())]
    OutOfRange {
        /// Row.
        row: u64,
        /// Column.
        column: u64,
        /// Lines of the DOF list.
        size: usize,
        /// The `.dof` file.
        dof_file: PathBuf,
    },
    /// A value that is no finite number.
    #[error("entry ({row}, {column}) is not a finite number")]
    NotFinite {
        /// Row.
        row: u64,
        /// Column.
        column: u64,
    },
    /// A position given twice.
    #[error(
        "entry ({row}, {column}) is given twice; *FREQUENCY, SOLVER=MATRIXSTORAGE writes it once: export again"
    )]
    Repeated {
        /// Row.
        row: u64,
        /// Column.
        column: u64,
    },
    /// The same DOF on two lines.
    #[error("DOF {node}.{component} is listed twice")]
    DofRepeated {
        /// Node.
        node: u64,
        /// Component.
        component: u8,
    },
}

/// What is wrong with the files taken together.
#[derive(Debug, thiserror::Error)]
pub enum ModelProblem {
    /// A file of strengths that is none.
    #[error("{}: {message}; strengths are {{\"name of a material or element set\": {{\"yield_strength\": …, \"ultimate_strength\": …, \
             \"fatigue_strength\": {{\"amplitude\": …, \"source\": \"…\"}}}}}}", .file.display())]
    Strengths {
        /// The file.
        file: PathBuf,
        /// The JSON reader's words.
        message: String,
    },
    /// Strengths of something that the mesh has not.
    #[error("strengths are given of {name}, which is no material or element set of a *SOLID SECTION; there are: {}", .known.join(", "))]
    StrengthOfNothing {
        /// The name.
        name: String,
        /// Those there are.
        known: Vec<String>,
    },
    /// Nothing says how many sectors there are.
    #[error("the deck has no *CYCLIC SYMMETRY MODEL card: give the number of sectors with --sectors")]
    SectorsUnknown,
    /// Axis of length zero.
    #[error(
        "the axis has no direction: its two points in *CYCLIC SYMMETRY MODEL are the same, or --axis ends in zeros"
    )]
    AxisWithoutDirection,
    /// Nothing says which nodes are a face.
    #[error(
        "which nodes are the {face} cyclic face? The deck has no cyclic *TIE of node surfaces: name a node set with {option}"
    )]
    FaceUnknown {
        /// `low` or `high`.
        face: &'static str,
        /// The option.
        option: &'static str,
    },
    /// No such node set.
    #[error("the deck defines no node set {set}; it has {}", listed(.known, *.more))]
    NoSuchSet {
        /// The name asked for.
        set: String,
        /// Names there are, shortened.
        known: Vec<String>,
        /// How many more there are.
        more: usize,
    },
    /// A set without nodes.
    #[error("the node set {set} is empty")]
    EmptySet {
        /// Its name.
        set: String,
    },
    /// A node of a set that has no coordinates.
    #[error(
        "node {node} of {place} has no coordinates in the deck; is this the deck the matrices were exported from?"
    )]
    NoCoordinates {
        /// Its number.
        node: u64,
        /// Set or file.
        place: String,
    },
    /// Faces of different size.
    #[error("the low face has {low} nodes and the high face {high}; mesh the two faces alike (periodic)")]
    FaceSizes {
        /// Nodes of the low face.
        low: usize,
        /// Nodes of the high face.
        high: usize,
    },
    /// A low node without partner.
    #[error(
        "low {copy}; {}mesh the two faces alike (periodic), and check --sectors and --axis",
        if *.swapped { "the face named high was taken as the low one, which fits better; " } else { "" }
    )]
    NoPartner {
        /// Node, and what is nearest to where it should be.
        copy: NoCopy,
        /// Whether the node is one of the face that was named high.
        swapped: bool,
    },
    /// Free node on the axis of several sectors.
    #[error(
        "node {node} is free but lies on the axis, a point that all sectors share; clamp it with *BOUNDARY or give the hub a bore"
    )]
    FreeOnAxis {
        /// Node.
        node: u64,
    },
    /// Two free nodes one sector apart that the faces do not pair.
    #[error(
        "node {low} turned by 2π/{sectors} is node {high}, both are free, but they are not among the nodes of the two faces: the \
         wheel would have a slit there. Give node sets with all nodes of the faces, those at the middle of edges too"
    )]
    PairMissing {
        /// Node on the low side.
        low: u64,
        /// Node on the high side.
        high: u64,
        /// N.
        sectors: usize,
    },
    /// Face nodes that were eliminated by a tie.
    #[error(
        "node {node} of the {face} face has no DOF in {}, its partner {partner} has: the cyclic tie was active when the \
         matrices were exported. Remove *TIE and *CYCLIC SYMMETRY MODEL from the exporting deck",
        .dof_file.display()
    )]
    TieActive {
        /// The node without DOF.
        node: u64,
        /// `low` or `high`.
        face: &'static str,
        /// Its partner.
        partner: u64,
        /// The `.dof` file.
        dof_file: PathBuf,
    },
    /// Matrix files with different numbers of entries.
    #[error(
        "{} holds {entries} entries and {} {more}, but CalculiX writes the same ones to every matrix of a mesh: the \
         shorter file is cut off, or the two come from different decks; export again",
        .file.display(), .other.display()
    )]
    CutShort {
        /// The file with the fewest.
        file: PathBuf,
        /// Its entries.
        entries: u64,
        /// The file with the most.
        other: PathBuf,
        /// Its entries.
        more: u64,
    },
    /// Matrices at speed over other DOF than those at rest.
    #[error(
        "{} lists other DOF than {} (for example {node}.{component}); export both with the same boundary conditions",
        .file.display(), .rest.display()
    )]
    OtherDofs {
        /// The `.dof` file at speed.
        file: PathBuf,
        /// The `.dof` file at rest.
        rest: PathBuf,
        /// A node that one of the two lacks.
        node: u64,
        /// Its component.
        component: u8,
    },
    /// Contact nodes that are no line from one edge to the other.
    #[error("contact nodes cannot be put in order from leading to trailing edge: {reason}")]
    ContactOrder {
        /// Why, and what to do.
        reason: NoOrder,
    },
    /// A contact node without a normal.
    #[error("{}: node {node} of the contact set has no normal there", .file.display())]
    NoNormal {
        /// The node.
        node: u64,
        /// The table of normals.
        file: PathBuf,
    },
    /// A contact node far from the curve.
    #[error(
        "contact node {node} is {distance:.3e} away from the meridional curve (r, z), more than a tenth of the tip's length; is \
         the curve given in the unit and the axis of the deck?"
    )]
    OffCurve {
        /// The node.
        node: u64,
        /// Distance.
        distance: f64,
    },
    /// A whole wheel of one or two sectors.
    #[error(
        "a wheel of {sectors} sectors cannot be cut (a sector would be its neighbour's neighbour on both sides); export one sector with its ties \
         inactive, or import a wheel of one sector without --wheel"
    )]
    WheelTooSmall {
        /// N.
        sectors: usize,
    },
    /// A node of the wheel that has no copy one sector further.
    #[error(
        "the wheel is not cyclic: {0}; make the wheel by copying one meshed sector, and check --sectors and --axis"
    )]
    WheelMesh(NoCopy),
    /// The low face does not separate sectors.
    #[error(
        "the low face does not cut the wheel into sectors: without its copies {parts} parts remain instead of {sectors}; the low set must hold all nodes between two sectors"
    )]
    WheelParts {
        /// Connected parts found.
        parts: usize,
        /// N.
        sectors: usize,
    },
    /// Sectors that differ.
    #[error(
        "the wheel is not cyclic: {} acts differently at node {node} and at its copy one sector further, node {copy}, by \
         {difference:.2e} of the largest force (more than {tolerance:.0e}); are material, loads and clamps the same in all \
         sectors?",
        .file.display()
    )]
    WheelMatrix {
        /// The matrix file.
        file: PathBuf,
        /// The node.
        node: u64,
        /// Its copy one sector further.
        copy: u64,
        /// Difference over the largest force.
        difference: f64,
        /// What would have been accepted.
        tolerance: f64,
    },
    /// No contact node in the sector cut out.
    #[error(
        "no node of the contact set {set} is inside the sector that follows the low face; choose both of one sector"
    )]
    ContactElsewhere {
        /// Name of the contact set.
        set: String,
    },
}

/// Names, or `none`.
fn listed(known: &[String], more: usize) -> String {
    match (known, more) {
        ([], _) => "none".to_owned(),
        (_, 0) => known.join(", "),
        _ => format!("{}, {more} more", known.join(", ")),
    }
}

/// Why contact nodes have no order, or no curve for their normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoOrder {
    /// No end is the leading edge.
    #[error(
        "both ends of the set are at the same radius; write the set in order and say --contact-order set"
    )]
    SameRadius,
    /// From one end, the nearest nodes do not lead to the other.
    #[error(
        "its nodes are no single line along the tip; choose one line of nodes (mid-thickness or one side of the blade), \
         or write the set in order and say --contact-order set"
    )]
    NoLine,
    /// A meridional curve of one or two points.
    #[error("the meridional curve has fewer than three points")]
    ShortCurve,
    /// One or two contact nodes.
    #[error("fewer than three nodes have no curve to take normals from; give --normals or --meridian")]
    FewNodes,
}

/// A node that has no node where the turn by one sector takes it.
#[derive(Debug, thiserror::Error)]
#[error(
    "node {node} turned by 2π/{sectors} has no node within {tolerance:.2e} (the nearest is {nearest}, {distance:.2e} away)"
)]
pub struct NoCopy {
    /// The node.
    pub node: u64,
    /// N.
    pub sectors: usize,
    /// What would have been accepted.
    pub tolerance: f64,
    /// The nearest candidate.
    pub nearest: u64,
    /// Its distance.
    pub distance: f64,
}
