//! Problems of `sector.json`, alone and against the rest of the package.

use std::fmt;

use super::reading::{FaceReading, RowReading};

/// Problem of a field of `sector.json`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ManifestProblem {
    /// File that is named, or `sector.json` itself, and is missing in the archive.
    #[error("the archive holds no file {file}{}", match .found_in {
        Some(folder) => format!("; there is one in the folder \"{folder}\": zip the files, not their folder"),
        None => "; add it under exactly this name".to_owned(),
    })]
    FileMissing {
        /// Name of the missing file.
        file: String,
        /// Folder in which a file of this name does exist.
        found_in: Option<String>,
    },
    /// Text that is not JSON, or a value of the wrong type.
    #[error("{message} (line {line}, column {column})")]
    Syntax {
        /// Message of the JSON reader.
        message: String,
        /// Number of the line, from 1.
        line: usize,
        /// Number of the column, from 1.
        column: usize,
    },
    /// Manifest that is too large.
    #[error("the file is larger than {limit_bytes} bytes")]
    TooLarge {
        /// Largest number of bytes, as configured.
        limit_bytes: u64,
    },
    /// Number of sectors N = 0.
    #[error("a wheel has at least one sector")]
    NoSectors,
    /// Count above what the service can take.
    #[error("at most {limit} {what} are supported")]
    TooMany {
        /// Kind of things that are too many.
        what: &'static str,
        /// Largest number of them.
        limit: usize,
    },
    /// Text that is too long for a name.
    #[error("the text has more than {limit} characters")]
    TextTooLong {
        /// Largest number of characters.
        limit: usize,
    },
    /// Unit with an empty name.
    #[error("the unit has no name")]
    UnitUnnamed,
    /// Unit of time without a known length in seconds.
    #[error(
        "the unit of time \"{unit}\" is not known, so speeds in rad/s cannot be compared with the matrices: use s, ms or us"
    )]
    TimeUnknown {
        /// Name of the unit, as given.
        unit: String,
    },
    /// Known unit of another quantity.
    #[error("\"{unit}\" is not a unit of {quantity}")]
    UnitOfOtherQuantity {
        /// Name of the unit, as given.
        unit: String,
        /// Quantity that it should measure.
        quantity: &'static str,
    },
    /// Inconsistent units: force ≠ mass·length/time².
    #[error(
        "the units are not consistent: force must be mass·length/time², but 1 {mass}·{length}/{time}² is {factor} \
         {force}; {}",
        mass_hint(*.fitting, .length, .force, .time)
    )]
    UnitsInconsistent {
        /// Name of the mass unit.
        mass: String,
        /// Name of the length unit.
        length: String,
        /// Name of the time unit.
        time: String,
        /// Name of the force unit.
        force: String,
        /// Size of the derived force in the force unit given.
        factor: f64,
        /// Mass unit that would fit, if one has a name.
        fitting: Option<&'static str>,
    },
    /// Number that is not finite.
    #[error("the value is not a finite number")]
    NotFinite,
    /// Axis without direction.
    #[error("the axis direction has length zero; give the direction about which rotation is positive")]
    AxisWithoutDirection,
    /// Number of speeds other than one and three.
    #[error("{count} speeds are given; a package has one (0) or three (0, Ω1/2, Ω1)")]
    SpeedCount {
        /// Number of speeds given.
        count: usize,
    },
    /// First speed that is not zero.
    #[error("the first speed is {value} rad/s; the first stiffness matrix must be the one at rest (0)")]
    SpeedsNotFromZero {
        /// Speed given, rad/s.
        value: f64,
    },
    /// Speeds that are not ascending.
    #[error("the speeds are not ascending: {value} rad/s follows {previous} rad/s")]
    SpeedsNotAscending {
        /// Speed before, rad/s.
        previous: f64,
        /// Speed that is not larger, rad/s.
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
        /// Number of matrices named.
        matrices: usize,
        /// Number of speeds given.
        speeds: usize,
    },
    /// File name that leaves the archive.
    #[error("\"{name}\" is not a file name inside the package")]
    BadFileName {
        /// Name of the file.
        name: String,
    },
    /// File in two roles.
    #[error("the file \"{file}\" is already named as {role}")]
    FileInTwoRoles {
        /// Name of the file.
        file: String,
        /// First role of the file.
        role: &'static str,
    },
    /// Node of `cyclic` or `contact` that `nodes.csv` does not list.
    #[error("node {node} is not in the node table")]
    UnknownNode {
        /// Id of the node.
        node: u64,
    },
    /// Node in two pairs, or on both faces.
    #[error("node {node} is already {role}; every face node belongs to exactly one pair")]
    FaceNodeRepeated {
        /// Id of the node.
        node: u64,
        /// Role that the node already has.
        role: &'static str,
    },
    /// Node paired with itself.
    #[error(
        "node {node} is paired with itself; the high node is another node, the low one turned by +2π/N; a node on the axis \
         is in no pair"
    )]
    PairedWithItself {
        /// Id of the node.
        node: u64,
    },
    /// Pair whose nodes are not one turn apart.
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
        /// Id of the low node.
        low: u64,
        /// Id of the high node.
        high: u64,
        /// Distance in the package's length unit.
        distance: f64,
        /// Largest distance that is accepted.
        tolerance: f64,
        /// Number of sectors N.
        sectors: usize,
        /// Turn that the pairs fit.
        fit: TurnFit,
    },
    /// Pair whose nodes have different components in the DOF table.
    #[error(
        "low node {low} has the components {low_components} and high node {high} has {high_components} in the DOF \
         table; clamp the same components on both faces"
    )]
    PairDofsDiffer {
        /// Id of the low node.
        low: u64,
        /// Id of the high node.
        high: u64,
        /// Components of the low node.
        low_components: Components,
        /// Components of the high node.
        high_components: Components,
    },
    /// Partly clamped pair whose free directions do not map onto each other.
    #[error(
        "nodes {low} and {high} are partly clamped along Cartesian directions that the turn by 2π/{sectors} does not map \
         onto each other; clamp face nodes fully, along the axis, or export the package in the cylindrical frame"
    )]
    PairClampNotCyclic {
        /// Id of the low node.
        low: u64,
        /// Id of the high node.
        high: u64,
        /// Number of sectors N.
        sectors: usize,
    },
    /// Face node with DOF on the axis.
    #[error(
        "nodes {low} and {high} are free but lie on the axis, a point that all sectors share: make them one node, in no pair"
    )]
    PairOnAxis {
        /// Id of the low node.
        low: u64,
        /// Id of the high node.
        high: u64,
    },
    /// Node on the axis whose free components the turn by one sector does not map onto each other.
    #[error(
        "node {node} lies on the axis and has the components {components} in the DOF table, which the turn by one sector does \
         not map onto each other; clamp it along the axis, in both directions across it, or wholly"
    )]
    AxisClampNotCyclic {
        /// Id of the node.
        node: u64,
        /// Components of the node.
        components: Components,
    },
    /// Contact node on the axis of several sectors.
    #[error(
        "node {node} lies on the axis, a point that all sectors share, and cannot touch the casing; leave it out"
    )]
    ContactOnAxis {
        /// Id of the node.
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
        /// Number of sectors N.
        sectors: usize,
    },
    /// Rows that are in balance only in another reading than the stated one.
    #[error(
        "a rigid motion of the sector makes forces where nothing holds it: {stated} of {inner} inner nodes are in balance as the rows are \
         stated, {found} if {reading}"
    )]
    RowsOtherwise {
        /// Reading that puts more nodes in balance.
        reading: RowReading,
        /// Number of nodes in balance as stated.
        stated: usize,
        /// Number of nodes in balance in the other reading.
        found: usize,
        /// Number of nodes inside the sector with three components.
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
        /// Smallest value that is accepted, in SI units.
        least: f64,
        /// Largest value that is accepted, in SI units.
        most: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// Constant or strength that is not positive.
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
    /// Ultimate strength below the yield strength.
    #[error(
        "the ultimate strength {ultimate:?} is below the yield strength {yields:?}; the first is the larger one"
    )]
    BreaksBeforeYielding {
        /// Ultimate strength.
        ultimate: f64,
        /// Yield strength.
        yields: f64,
    },
    /// Fatigue strength above the ultimate strength.
    #[error(
        "the fatigue strength {amplitude:?} is above the ultimate strength {ultimate:?}; it is an amplitude, half of the range"
    )]
    FatigueAboveUltimate {
        /// Fatigue strength, an amplitude.
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
        /// Young's modulus that the matrix has.
        youngs_modulus: f64,
        /// Poisson's ratio that the matrix has.
        poissons_ratio: f64,
        /// Young's modulus and Poisson's ratio as stated.
        stated: [f64; 2],
    },
    /// Density that the mass matrix contradicts.
    #[error(
        "the elements have density {stated:?}, but {file} is the mass of a material with {density:.3e}; give the density that it \
         was made with, in the package's units (mass/length³)"
    )]
    MassDisagrees {
        /// File name of the mass matrix.
        file: String,
        /// Density that the matrix has.
        density: f64,
        /// Density as stated.
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
        /// Ratio of the matrix to the value from the elements.
        factor: f64,
    },
    /// Fatigue strength without a source.
    #[error(
        "say where the fatigue strength comes from: standard or test, number of cycles, surface, temperature"
    )]
    NoSource,
    /// Material that no element has.
    #[error("no element of {elements} is of this set; remove it, or look at the sets of the elements")]
    SetUnused {
        /// File name of the element table.
        elements: String,
    },
    /// Node table with more nodes outside elements than in elements.
    #[error(
        "{spare} nodes belong to no element, more than the {used} that do: leave them out of the node table"
    )]
    SpareNodes {
        /// Number of nodes without element.
        spare: usize,
        /// Number of nodes with an element.
        used: usize,
    },
    /// Contact node that belongs to no element.
    #[error("contact node {node} belongs to no element of {elements}")]
    ContactWithoutElement {
        /// Id of the node.
        node: u64,
        /// File name of the element table.
        elements: String,
    },
    /// Package without contact nodes.
    #[error("no contact node is named; nothing could ever touch the casing")]
    NoContact,
    /// Contact node that is listed twice.
    #[error("contact node {node} is already named at /contact/{first}")]
    ContactRepeated {
        /// Id of the node.
        node: u64,
        /// Index of the first mention in `contact`.
        first: usize,
    },
    /// Contact node without all three DOF.
    #[error(
        "contact node {node} is clamped: the DOF table has its components {components}, contact needs 1, 2, 3"
    )]
    ContactClamped {
        /// Id of the node.
        node: u64,
        /// Components that the node has.
        components: Components,
    },
    /// Contact node on a cyclic face.
    #[error("contact node {node} lies on the {face} cyclic face; contact nodes must be inside the sector")]
    ContactOnFace {
        /// Id of the node.
        node: u64,
        /// Face of the node: `low` or `high`.
        face: &'static str,
    },
    /// Normal that is not a unit vector.
    #[error("the normal has length {length}, not 1 (within {tolerance})")]
    NormalNotUnit {
        /// Length of the normal.
        length: f64,
        /// Largest difference from 1 that is accepted.
        tolerance: f64,
    },
}

/// Turn about the axis that takes low nodes to high nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurnFit {
    /// Turn by +2π/N, or no fitting turn at all.
    Forward,
    /// Turn by −2π/N, within the tolerance.
    Reversed,
    /// Turn by −2π/N more nearly than by +2π/N, but not within the tolerance.
    NearerReversed,
}

fn mass_hint(fitting: Option<&str>, length: &str, force: &str, time: &str) -> String {
    match fitting {
        Some(mass) => format!("with {length}, {force} and {time} the mass is in {mass}"),
        None => "choose a mass unit that makes it 1".to_owned(),
    }
}

/// Components 1, 2, 3 of a node that are in the DOF table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components(pub [bool; 3]);

impl fmt::Display for Components {
    /// Writes the components, such as `1, 3`, or `none`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let present: Vec<_> = (1..=3).filter(|k| self.0[k - 1]).map(|k: usize| k.to_string()).collect();
        if present.is_empty() { f.write_str("none") } else { f.write_str(&present.join(", ")) }
    }
}
