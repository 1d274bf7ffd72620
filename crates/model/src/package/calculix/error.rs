//! Problems of CalculiX files, each with the place and what to do.

use std::path::PathBuf;

use crate::package::error::PackageError;

/// Error of files that cannot become a package.
#[derive(Debug, thiserror::Error)]
pub enum CalculixError {
    /// Error of the operating system, which could not read a file.
    #[error("{}: {source}", .path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error reported by the system.
        source: std::io::Error,
    },
    /// Line of a file with a problem.
    #[error("{}, line {line}: {problem}", .path.display())]
    Line {
        /// Path of the file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: u64,
        /// Problem of the line.
        problem: LineProblem,
    },
    /// Contradiction between the files.
    #[error(transparent)]
    Model(#[from] ModelProblem),
    /// Problem found by the checks of every package.
    #[error(transparent)]
    Package(#[from] PackageError),
}

/// Problem of a line.
#[derive(Debug, thiserror::Error)]
pub enum LineProblem {
    /// Word that is not the number expected in its place.
    #[error("\"{text}\" is not {expected}")]
    NotA {
        /// Word found.
        text: String,
        /// Expected kind of number, such as `a node number`.
        expected: &'static str,
    },
    /// Line with too few or too many words.
    #[error("expected {expected}")]
    Words {
        /// Expected form of the line.
        expected: &'static str,
    },
    /// Node with two positions.
    #[error("node {node} was at another place before; keep one of the two definitions")]
    NodeMoved {
        /// Number of the node.
        node: u64,
    },
    /// Set used before it is defined.
    #[error("the set {set} is not defined before this line")]
    UnknownSet {
        /// Name of the set.
        set: String,
    },
    /// Card whose effect on the matrices cannot be undone here.
    #[error(
        "{card} is not supported: DOF of transformed nodes are not in global directions; export the matrices without it"
    )]
    Card {
        /// Keyword of the card.
        card: String,
    },
    /// Includes nested too deeply, such as files that include themselves.
    #[error("*INCLUDE goes deeper than {limit} files; does a file include itself?")]
    TooDeep {
        /// Deepest nesting allowed.
        limit: usize,
    },
    /// Row or column of a matrix that the DOF list does not have.
    #[error("entry ({row}, {column}) is outside the {size} rows that {} lists", .dof_file.display())]
    OutOfRange {
        /// Row of the entry, from 1.
        row: u64,
        /// Column of the entry, from 1.
        column: u64,
        /// Number of lines of the DOF list.
        size: usize,
        /// Path of the `.dof` file.
        dof_file: PathBuf,
    },
    /// Value that is not a finite number.
    #[error("entry ({row}, {column}) is not a finite number")]
    NotFinite {
        /// Row of the entry, from 1.
        row: u64,
        /// Column of the entry, from 1.
        column: u64,
    },
    /// Position of a matrix that is given twice.
    #[error(
        "entry ({row}, {column}) is given twice; *FREQUENCY, SOLVER=MATRIXSTORAGE writes it once: export again"
    )]
    Repeated {
        /// Row of the entry, from 1.
        row: u64,
        /// Column of the entry, from 1.
        column: u64,
    },
    /// DOF that is listed on two lines.
    #[error("DOF {node}.{component} is listed twice")]
    DofRepeated {
        /// Number of the node.
        node: u64,
        /// Component of the node.
        component: u8,
    },
}

/// Problem of the files taken together.
#[derive(Debug, thiserror::Error)]
pub enum ModelProblem {
    /// File of strengths that cannot be read as such.
    #[error("{}: {message}; strengths are {{\"name of a material or element set\": {{\"yield_strength\": …, \"ultimate_strength\": …, \
             \"fatigue_strength\": {{\"amplitude\": …, \"source\": \"…\"}}}}}}", .file.display())]
    Strengths {
        /// Path of the file of strengths.
        file: PathBuf,
        /// Message of the JSON reader.
        message: String,
    },
    /// Strength of a material or set that the mesh does not have.
    #[error("strengths are given of {name}, which is no material or element set of a *SOLID SECTION; there are: {}", .known.join(", "))]
    StrengthOfNothing {
        /// Name in the file of strengths.
        name: String,
        /// Names that the mesh has.
        known: Vec<String>,
    },
    /// Number of sectors that is given nowhere.
    #[error("the deck has no *CYCLIC SYMMETRY MODEL card: give the number of sectors with --sectors")]
    SectorsUnknown,
    /// Axis of length zero.
    #[error(
        "the axis has no direction: its two points in *CYCLIC SYMMETRY MODEL are the same, or --axis ends in zeros"
    )]
    AxisWithoutDirection,
    /// Cyclic face whose nodes are given nowhere.
    #[error(
        "which nodes are the {face} cyclic face? The deck has no cyclic *TIE of node surfaces: name a node set with {option}"
    )]
    FaceUnknown {
        /// Name of the face: `low` or `high`.
        face: &'static str,
        /// Option that names the nodes of the face.
        option: &'static str,
    },
    /// Node set that does not exist.
    #[error("the deck defines no node set {set}; it has {}", listed(.known, *.more))]
    NoSuchSet {
        /// Name asked for.
        set: String,
        /// Names of existing sets, shortened.
        known: Vec<String>,
        /// Number of further existing sets.
        more: usize,
    },
    /// Set without nodes.
    #[error("the node set {set} is empty")]
    EmptySet {
        /// Name of the set.
        set: String,
    },
    /// Node of a set or a file that has no coordinates.
    #[error(
        "node {node} of {place} has no coordinates in the deck; is this the deck the matrices were exported from?"
    )]
    NoCoordinates {
        /// Number of the node.
        node: u64,
        /// Set or file that names the node.
        place: String,
    },
    /// Faces with different numbers of nodes.
    #[error("the low face has {low} nodes and the high face {high}; mesh the two faces alike (periodic)")]
    FaceSizes {
        /// Number of nodes of the low face.
        low: usize,
        /// Number of nodes of the high face.
        high: usize,
    },
    /// Low node without partner.
    #[error(
        "low {copy}; {}mesh the two faces alike (periodic), and check --sectors and --axis",
        if *.swapped { "the face named high was taken as the low one, which fits better; " } else { "" }
    )]
    NoPartner {
        /// Low node, with the nearest node to where its partner should be.
        copy: NoCopy,
        /// Whether the node is one of the face that was named high.
        swapped: bool,
    },
    /// Free node on the axis of a whole wheel, whose rows hold the shares of all sectors.
    #[error(
        "node {node} is free but lies on the axis, and the matrices of a whole wheel do not tell the sectors' shares of it apart; \
         export one sector, or import the mesh itself (rubmap import mesh)"
    )]
    FreeOnAxis {
        /// Number of the node.
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
        /// Number of sectors N.
        sectors: usize,
    },
    /// Face node that was eliminated by a tie.
    #[error(
        "node {node} of the {face} face has no DOF in {}, its partner {partner} has: the cyclic tie was active when the \
         matrices were exported. Remove *TIE and *CYCLIC SYMMETRY MODEL from the exporting deck",
        .dof_file.display()
    )]
    TieActive {
        /// Node without DOF.
        node: u64,
        /// Face of the node: `low` or `high`.
        face: &'static str,
        /// Partner of the node.
        partner: u64,
        /// Path of the `.dof` file.
        dof_file: PathBuf,
    },
    /// Matrix files with different numbers of entries.
    #[error(
        "{} holds {entries} entries and {} {more}, but CalculiX writes the same ones to every matrix of a mesh: the \
         shorter file is cut off, or the two come from different decks; export again",
        .file.display(), .other.display()
    )]
    CutShort {
        /// File with the fewest entries.
        file: PathBuf,
        /// Number of entries of `file`.
        entries: u64,
        /// File with the most entries.
        other: PathBuf,
        /// Number of entries of `other`.
        more: u64,
    },
    /// Matrices at speed over other DOF than those at rest.
    #[error(
        "{} lists other DOF than {} (for example {node}.{component}); export both with the same boundary conditions",
        .file.display(), .rest.display()
    )]
    OtherDofs {
        /// Path of the `.dof` file at speed.
        file: PathBuf,
        /// Path of the `.dof` file at rest.
        rest: PathBuf,
        /// Node of a DOF that one of the two files lacks.
        node: u64,
        /// Component of that DOF.
        component: u8,
    },
    /// Contact nodes that do not form a line from one edge to the other.
    #[error("contact nodes cannot be put in order from leading to trailing edge: {reason}")]
    ContactOrder {
        /// Reason why they have no order, and what to do.
        reason: NoOrder,
    },
    /// Contact node without a normal.
    #[error("{}: node {node} of the contact set has no normal there", .file.display())]
    NoNormal {
        /// Number of the node.
        node: u64,
        /// Path of the table of normals.
        file: PathBuf,
    },
    /// Contact node far from the meridional curve.
    #[error(
        "contact node {node} is {distance:.3e} away from the meridional curve (r, z), more than a tenth of the tip's length; is \
         the curve given in the unit and the axis of the deck?"
    )]
    OffCurve {
        /// Number of the node.
        node: u64,
        /// Distance of the node from the curve.
        distance: f64,
    },
    /// Whole wheel of one or two sectors, which cannot be cut.
    #[error(
        "a wheel of {sectors} sectors cannot be cut (a sector would be its neighbour's neighbour on both sides); export one sector with its ties \
         inactive, or import a wheel of one sector without --wheel"
    )]
    WheelTooSmall {
        /// Number of sectors N.
        sectors: usize,
    },
    /// Node of the wheel that has no copy one sector further.
    #[error(
        "the wheel is not cyclic: {0}; make the wheel by copying one meshed sector, and check --sectors and --axis"
    )]
    WheelMesh(NoCopy),
    /// Low face that does not separate the sectors.
    #[error(
        "the low face does not cut the wheel into sectors: without its copies {parts} parts remain instead of {sectors}; the low set must hold all nodes between two sectors"
    )]
    WheelParts {
        /// Number of connected parts found.
        parts: usize,
        /// Number of sectors N.
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
        /// Path of the matrix file.
        file: PathBuf,
        /// Number of the node.
        node: u64,
        /// Copy of the node one sector further.
        copy: u64,
        /// Difference over the largest force.
        difference: f64,
        /// Largest difference that is accepted.
        tolerance: f64,
    },
    /// Sector cut out without any contact node inside.
    #[error(
        "no node of the contact set {set} is inside the sector that follows the low face; choose both of one sector"
    )]
    ContactElsewhere {
        /// Name of the contact set.
        set: String,
    },
}

/// List of names, or `none`.
fn listed(known: &[String], more: usize) -> String {
    match (known, more) {
        ([], _) => "none".to_owned(),
        (_, 0) => known.join(", "),
        _ => format!("{}, {more} more", known.join(", ")),
    }
}

/// Reason why contact nodes have no order, or no curve for their normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoOrder {
    /// Ends that do not tell which is the leading edge.
    #[error(
        "both ends of the set are at the same radius; write the set in order and say --contact-order set"
    )]
    SameRadius,
    /// Nodes whose chain of nearest neighbours does not lead from one end to the other.
    #[error(
        "its nodes are no single line along the tip; choose one line of nodes (mid-thickness or one side of the blade), \
         or write the set in order and say --contact-order set"
    )]
    NoLine,
    /// Meridional curve of one or two points.
    #[error("the meridional curve has fewer than three points")]
    ShortCurve,
    /// One or two contact nodes, too few for a curve.
    #[error("fewer than three nodes have no curve to take normals from; give --normals or --meridian")]
    FewNodes,
}

/// Node without a node where the turn by one sector takes it.
#[derive(Debug, thiserror::Error)]
#[error(
    "node {node} turned by 2π/{sectors} has no node within {tolerance:.2e} (the nearest is {nearest}, {distance:.2e} away)"
)]
pub struct NoCopy {
    /// Number of the node.
    pub node: u64,
    /// Number of sectors N.
    pub sectors: usize,
    /// Largest distance that is accepted.
    pub tolerance: f64,
    /// Nearest candidate.
    pub nearest: u64,
    /// Distance of the nearest candidate.
    pub distance: f64,
}
