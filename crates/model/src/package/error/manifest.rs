//! Problems of `sector.json` and of what it claims about the rest.

use std::fmt;

/// What is wrong with a field of `sector.json`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ManifestProblem {
    /// A file that is named, or `sector.json` itself, is not in the archive.
    #[error("the archive holds no file {file}{}", match .found_in {
        Some(folder) => format!("; there is one in the folder \"{folder}\": zip the files, not their folder"),
        None => "; add it under exactly this name".to_owned(),
    })]
    FileMissing {
        /// The file that is missing.
        file: String,
        /// A folder in which a file of this name does exist.
        found_in: Option<String>,
    },
    /// Not JSON, or a value of the wrong type.
    #[error("{message} (line {line}, column {column})")]
    Syntax {
        /// The JSON reader's words.
        message: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
    /// Larger than any manifest.
    #[error("the file is larger than {limit_bytes} bytes")]
    TooLarge {
        /// Configured limit.
        limit_bytes: u64,
    },
    /// N = 0.
    #[error("a wheel has at least one sector")]
    NoSectors,
    /// More than the service can take.
    #[error("at most {limit} {what} are supported")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many are allowed.
        limit: usize,
    },
    /// A text longer than any name.
    #[error("the text has more than {limit} characters")]
    TextTooLong {
        /// Characters allowed.
        limit: usize,
    },
    /// Empty unit name.
    #[error("the unit has no name")]
    UnitUnnamed,
    /// A unit of time without a known length in seconds.
    #[error(
        "the unit of time \"{unit}\" is not known, so speeds in rad/s cannot be compared with the matrices: use s, ms or us"
    )]
    TimeUnknown {
        /// The name given.
        unit: String,
    },
    /// A known unit of another quantity.
    #[error("\"{unit}\" is not a unit of {quantity}")]
    UnitOfOtherQuantity {
        /// The name given.
        unit: String,
        /// What it should measure.
        quantity: &'static str,
    },
    /// force ≠ mass·length/time².
    #[error(
        "the units are not consistent: force must be mass·length/time², but 1 {mass}·{length}/{time}² is {factor} \
         {force}; {}",
        mass_hint(*.fitting, .length, .force, .time)
    )]
    UnitsInconsistent {
        /// Mass unit.
        mass: String,
        /// Length unit.
        length: String,
        /// Time unit.
        time: String,
        /// Force unit.
        force: String,
        /// Size of the derived force in the force unit given.
        factor: f64,
        /// The mass unit that would fit, if one has a name.
        fitting: Option<&'static str>,
    },
    /// A number that is not finite.
    #[error("the value is not a finite number")]
    NotFinite,
    /// Axis without direction.
    #[error("the axis direction has length zero; give the direction about which rotation is positive")]
    AxisWithoutDirection,
    /// Neither one nor three speeds.
    #[error("{count} speeds are given; a package has one (0) or three (0, Ω1/2, Ω1)")]
    SpeedCount {
        /// Number given.
        count: usize,
    },
    /// First speed not zero.
    #[error("the first speed is {value} rad/s; the first stiffness matrix must be the one at rest (0)")]
    SpeedsNotFromZero {
        /// Value given.
        value: f64,
    },
    /// Speeds out of order.
    #[error("the speeds are not ascending: {value} rad/s follows {previous} rad/s")]
    SpeedsNotAscending {
        /// The speed before.
        previous: f64,
        /// The speed that is not larger.
        value: f64,
    },
    /// Speeds that no polynomial tells apart.
    #[error(
        "{value:?} rad/s is too near to {previous:?} rad/s, of {highest:?} rad/s in all: K(Ω) is interpolated between three speeds that must \
         differ by a thousandth of the highest at least"
    )]
    SpeedsTooClose {
        /// The speed before.
        previous: f64,
        /// The speed that is not far enough from it.
        value: f64,
        /// The highest speed.
        highest: f64,
    },
    /// Speed that no wheel has.
    #[error("the highest speed is {value:e} rad/s; {least:e} to {most:e} rad/s are accepted")]
    SpeedOutOfRange {
        /// Value given.
        value: f64,
        /// Lowest highest speed that is accepted.
        least: f64,
        /// Highest speed that is accepted.
        most: f64,
    },
    /// Not one stiffness per speed.
    #[error(
        "{matrices} stiffness matrices are named for {speeds} speeds; name one per speed, in the same order"
    )]
    StiffnessCount {
        /// Matrices named.
        matrices: usize,
        /// Speeds given.
        speeds: usize,
    },
    /// A name that leaves the archive.
    #[error("\"{name}\" is not a file name inside the package")]
    BadFileName {
        /// The name.
        name: String,
    },
    /// One file in two roles.
    #[error("the file \"{file}\" is already named as {role}")]
    FileInTwoRoles {
        /// The file.
        file: String,
        /// Its first role.
        role: &'static str,
    },
    /// A node of `cyclic` or `contact` that `nodes.csv` does not list.
    #[error("node {node} is not in the node table")]
    UnknownNode {
        /// Its id.
        node: u64,
    },
    /// A node in two pairs, or on both faces.
    #[error("node {node} is already {role}; every face node belongs to exactly one pair")]
    FaceNodeRepeated {
        /// Its id.
        node: u64,
        /// What it is already.
        role: &'static str,
    },
    /// Node paired with itself.
    #[error(
        "node {node} is paired with itself; the high node is another node, the low one turned by +2π/N; a node on the axis \
         must be clamped"
    )]
    PairedWithItself {
        /// Its id.
        node: u64,
    },
    /// Geometry of a pair.
    #[error(
        "high node {high} is {distance:.3e} away from low node {low} turned by {}2π/{sectors} about the axis (tolerance \
         {tolerance:.3e}; the worst pair); {}",
        if *.fit == TurnFit::NearerReversed { "−" } else { "+" },
        match .fit {
            TurnFit::Forward => "check sectors, axis and the pairing of the nodes",
            TurnFit::Reversed => "every pair fits the turn by −2π/N: swap low and high, or reverse the axis direction",
            TurnFit::NearerReversed =>
                "the pairs fit the turn by −2π/N better than that by +2π/N: swap low and high, or reverse the axis direction, \
                 and check the positions of the nodes",
        }
    )]
    PairNotTurned {
        /// Low node id.
        low: u64,
        /// High node id.
        high: u64,
        /// Distance in the package's length unit.
        distance: f64,
        /// What would have been accepted.
        tolerance: f64,
        /// N.
        sectors: usize,
        /// Turn that the pairs fit.
        fit: TurnFit,
    },
    /// DOF sets of a pair.
    #[error(
        "low node {low} has the components {low_components} and high node {high} has {high_components} in the DOF \
         table; clamp the same components on both faces"
    )]
    PairDofsDiffer {
        /// Low node id.
        low: u64,
        /// High node id.
        high: u64,
        /// Those of the low node.
        low_components: Components,
        /// Those of the high node.
        high_components: Components,
    },
    /// Partly clamped pair whose free directions do not map onto each other.
    #[error(
        "nodes {low} and {high} are partly clamped along Cartesian directions that the turn by 2π/{sectors} does not map \
         onto each other; clamp face nodes fully, along the axis, or export the package in the cylindrical frame"
    )]
    PairClampNotCyclic {
        /// Low node id.
        low: u64,
        /// High node id.
        high: u64,
        /// N.
        sectors: usize,
    },
    /// A face node with DOF on the axis.
    #[error(
        "nodes {low} and {high} are free but lie on the axis, a point that all sectors share and no pair can \
         describe; clamp them or give the hub a bore"
    )]
    PairOnAxis {
        /// Low node id.
        low: u64,
        /// High node id.
        high: u64,
    },
    /// Free node on the axis of several sectors, in no pair.
    #[error(
        "node {node} is free but lies on the axis, a point that all sectors share: without a pair every sector would have an \
         axis of its own; clamp it or give the hub a bore"
    )]
    FreeOnAxis {
        /// Node id.
        node: u64,
    },
    /// Two free nodes one sector apart that are not a pair.
    #[error(
        "node {low} turned by +2π/{sectors} is node {high}, both are free, and they are no pair: the wheel would have a slit \
         there; name every pair of nodes on the two faces, those at the middle of edges too, or clamp both nodes"
    )]
    PairMissing {
        /// Node on the low face.
        low: u64,
        /// Node on the high face.
        high: u64,
        /// N.
        sectors: usize,
    },
    /// Rows that are in balance only if they are read otherwise.
    #[error(
        "a rigid motion of the sector makes forces where nothing holds it: {stated} of {inner} inner nodes are in balance as the rows are \
         stated, {found} if {reading}"
    )]
    RowsOtherwise {
        /// Reading that puts more nodes in balance.
        reading: RowReading,
        /// Nodes in balance as stated.
        stated: usize,
        /// Nodes in balance in the other reading.
        found: usize,
        /// Nodes inside the sector with three components.
        inner: usize,
    },
    /// High face that fits the low one only if its rows are read otherwise.
    #[error(
        "with the sectors joined, rigid motions of the wheel make forces at cyclic faces that nothing holds: {stated} of {pairs} pairs of \
         nodes are in balance as the rows are stated, {found} if {reading}"
    )]
    FacesOtherwise {
        /// Reading that puts more pairs in balance.
        reading: FaceReading,
        /// Pairs in balance as stated.
        stated: usize,
        /// Pairs in balance in the other reading.
        found: usize,
        /// Pairs with three components.
        pairs: usize,
    },
    /// High face without stiffness.
    #[error(
        "the stiffness at rest has no entry in the rows of the high face, so that the sectors are not joined: export the sector with its own \
         nodes on both faces"
    )]
    SectorsApart,
    /// A constant that no solid has by far.
    #[error(
        "the value is {value:e}, in SI units {in_si:.3e} {unit}, and {least:e} to {most:e} {unit} are accepted, wider than any solid: \
         correct the value or the units"
    )]
    NoSolid {
        /// Value given.
        value: f64,
        /// Value in SI units.
        in_si: f64,
        /// Least that is accepted.
        least: f64,
        /// Most that is accepted.
        most: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// A constant or strength that must be positive.
    #[error("the value is {value}; it must be positive")]
    NotPositive {
        /// Value given.
        value: f64,
    },
    /// Poisson's ratio out of range.
    #[error("Poisson's ratio is {value}; it lies between -1 and 0.5, both excluded")]
    PoissonsRatio {
        /// Value given.
        value: f64,
    },
    /// An ultimate strength below the yield strength.
    #[error(
        "the ultimate strength {ultimate:?} is below the yield strength {yields:?}; the first is the larger one"
    )]
    BreaksBeforeYielding {
        /// Ultimate strength.
        ultimate: f64,
        /// Yield strength.
        yields: f64,
    },
    /// A fatigue strength above the ultimate strength.
    #[error(
        "the fatigue strength {amplitude:?} is above the ultimate strength {ultimate:?}; it is an amplitude, half of the range"
    )]
    FatigueAboveUltimate {
        /// Amplitude.
        amplitude: f64,
        /// Ultimate strength.
        ultimate: f64,
    },
    /// Elastic constants that the stiffness matrix contradicts.
    #[error(
        "the elements have Young's modulus {:?} and Poisson's ratio {:?}, but {file} is the stiffness of a material with \
         {youngs_modulus:.3e} and {poissons_ratio:.3}; give the constants that it was made with, in the package's units \
         (force/length²)", .stated[0], .stated[1]
    )]
    StiffnessDisagrees {
        /// File name of the stiffness matrix at rest.
        file: String,
        /// Young's modulus that its matrix has.
        youngs_modulus: f64,
        /// Poisson's ratio that its matrix has.
        poissons_ratio: f64,
        /// Both as stated.
        stated: [f64; 2],
    },
    /// A density that the mass matrix contradicts.
    #[error(
        "the elements have density {stated:?}, but {file} is the mass of a material with {density:.3e}; give the density that it \
         was made with, in the package's units (mass/length³)"
    )]
    MassDisagrees {
        /// File name of the mass matrix.
        file: String,
        /// Density that its matrix has.
        density: f64,
        /// As stated.
        stated: f64,
    },
    /// Materials of thin sets that a matrix contradicts.
    #[error(
        "where element sets meet, {file} is {factor:.3e} times what the elements and their materials give; give the materials that \
         it was made with, in the package's units"
    )]
    MeetingSetsDisagree {
        /// File name of the matrix.
        file: String,
        /// Matrix over elements.
        factor: f64,
    },
    /// A fatigue strength from nowhere.
    #[error(
        "say where the fatigue strength comes from: standard or test, number of cycles, surface, temperature"
    )]
    NoSource,
    /// A material that nothing is made of.
    #[error("no element of {elements} is of this set; remove it, or look at the sets of the elements")]
    SetUnused {
        /// File name of the element table.
        elements: String,
    },
    /// Mostly nodes without element.
    #[error(
        "{spare} nodes belong to no element, more than the {used} that do: leave them out of the node table"
    )]
    SpareNodes {
        /// Nodes without element.
        spare: usize,
        /// Nodes with one.
        used: usize,
    },
    /// A contact node outside the mesh.
    #[error("contact node {node} belongs to no element of {elements}")]
    ContactWithoutElement {
        /// Its id.
        node: u64,
        /// File name of the element table.
        elements: String,
    },
    /// No contact nodes.
    #[error("no contact node is named; nothing could ever touch the casing")]
    NoContact,
    /// The same contact node twice.
    #[error("contact node {node} is already named at /contact/{first}")]
    ContactRepeated {
        /// Its id.
        node: u64,
        /// Index of its first mention.
        first: usize,
    },
    /// A contact node without all three DOF.
    #[error(
        "contact node {node} is clamped: the DOF table has its components {components}, contact needs 1, 2, 3"
    )]
    ContactClamped {
        /// Its id.
        node: u64,
        /// Those it has.
        components: Components,
    },
    /// A contact node on a cyclic face.
    #[error("contact node {node} lies on the {face} cyclic face; contact nodes must be inside the sector")]
    ContactOnFace {
        /// Its id.
        node: u64,
        /// `low` or `high`.
        face: &'static str,
    },
    /// A normal that is not a unit vector.
    #[error("the normal has length {length}, not 1 (within {tolerance})")]
    NormalNotUnit {
        /// Its length.
        length: f64,
        /// What would have been accepted.
        tolerance: f64,
    },
}

/// Reading of the rows of the matrices other than the stated one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowReading {
    /// All components in the other frame.
    OtherFrame {
        /// Name of that frame.
        meant: &'static str,
    },
    /// Components of face nodes in the other frame.
    FacesInOtherFrame {
        /// Name of that frame.
        meant: &'static str,
    },
    /// Components of high face nodes along axes that are turned with the sector.
    HighFaceTurned,
    /// Nodes as the DOF table lists them, the components of each together.
    ByNode,
    /// Nodes in another order.
    NodesInOtherOrder {
        /// The order.
        order: &'static str,
    },
    /// First all components 1, then all 2, then all 3.
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

/// Turn about the axis that takes low nodes to high nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurnFit {
    /// By +2π/N, or no turn at all.
    Forward,
    /// By −2π/N, within the tolerance.
    Reversed,
    /// By −2π/N more nearly than by +2π/N, but not within the tolerance.
    NearerReversed,
}

fn mass_hint(fitting: Option<&str>, length: &str, force: &str, time: &str) -> String {
    match fitting {
        Some(mass) => format!("with {length}, {force} and {time} the mass is in {mass}"),
        None => "choose a mass unit that makes it 1".to_owned(),
    }
}

/// Which of the components 1, 2, 3 a node has in the DOF table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components(pub [bool; 3]);

impl fmt::Display for Components {
    /// `1, 3` or `none`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let present: Vec<_> = (1..=3).filter(|k| self.0[k - 1]).map(|k: usize| k.to_string()).collect();
        if present.is_empty() { f.write_str("none") } else { f.write_str(&present.join(", ")) }
    }
}
