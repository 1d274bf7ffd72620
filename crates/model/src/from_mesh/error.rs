//! Refusals of a mesh that makes no model, each with what to do.

use std::fmt;

use crate::assembly::CanMove;

/// Largest number of names that an error lists.
const MOST_NAMED: usize = 20;

/// Refusal of a mesh that makes no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FromMeshError {
    /// Element that is not whole.
    #[error("element {element} ({kind}{}): {problem}", if *.line > 0 { format!(", line {line}") } else { String::new() })]
    Element {
        /// Number of the element.
        element: u64,
        /// Kind of the element.
        kind: &'static str,
        /// Line of the file, 0 where it has none.
        line: u64,
        /// Problem of the element.
        problem: String,
    },
    /// Nodes at one place that are not merged.
    #[error(
        "nodes {} and {} are both at ({:.6}, {:.6}, {:.6}){}: the mesh is slit there; merge nodes at the same place",
        .0.nodes[0], .0.nodes[1], .0.at[0], .0.at[1], .0.at[2],
        if .0.count > 1 { format!(", as are {} other pairs", .0.count - 1) } else { String::new() }
    )]
    Twins(Twin),
    /// Elements with a common face of which one has other nodes on the edges.
    #[error(
        "elements {} and {} share the corners of a face but not the nodes on its edges: a node on an edge hangs there; mesh both in one order",
        .elements[0], .elements[1]
    )]
    EdgesDiffer {
        /// Numbers of the elements.
        elements: [u64; 2],
    },
    /// Faces that lie on each other without being one.
    #[error(
        "a face of element {} lies on one of element {} without sharing its nodes: the mesh is slit there, or finer on one side; merge the nodes, \
         or mesh both sides alike",
        .elements[0], .elements[1]
    )]
    FacesMeet {
        /// Numbers of the elements.
        elements: [u64; 2],
    },
    /// Refusal that follows from the axis and the number of sectors that were found.
    #[error("{error} (with {sectors} sectors about the axis through {origin:?} along {direction:?}, as {source}; give `axis` and `sectors` if that is wrong)",
        source = if *.found { "found" } else { "stated" })]
    With {
        /// Refusal.
        error: Box<FromMeshError>,
        /// Number of sectors.
        sectors: usize,
        /// Point on the axis.
        origin: [f64; 3],
        /// Direction of the axis.
        direction: [f64; 3],
        /// Whether the number of sectors was found.
        found: bool,
    },
    /// Number of contact nodes below three.
    #[error("`contact_nodes` is {0}; at least 3 are needed for normals along the tip")]
    ContactNodes(usize),
    /// Normal of a contact node that the skin contradicts.
    #[error(
        "at node {node} the contact line's normal is {degrees:.0}° off that of the skin: the line is not along a tip that faces the casing; name a node set along \
         it with `contact_set`, or two nodes of an edge with `contact_between`"
    )]
    NormalOff {
        /// Number of the node.
        node: u64,
        /// Angle between both normals.
        degrees: f64,
    },
    /// Mesh of several bodies.
    #[error(
        "the mesh is {bodies} bodies that share no node: one of {} elements, one of {}, to which element {element} belongs. Their nearest nodes, \
         {} and {}, are {distance:.3e} apart; a model is one body, so merge such nodes with a larger tolerance, or leave the others out",
        .sizes[0], .sizes[1], .nearest[0], .nearest[1]
    )]
    Bodies {
        /// Number of bodies.
        bodies: usize,
        /// Numbers of elements of the two largest.
        sizes: [usize; 2],
        /// First element of the second.
        element: u64,
        /// Nearest nodes of these two.
        nearest: [u64; 2],
        /// Distance between these nodes.
        distance: f64,
    },
    /// Element without a material.
    #[error(
        "element {element} has no material; give one under `materials`, by a name of the file{} or by `*` for all elements",
        listed(.known)
    )]
    NoMaterial {
        /// Number of the element.
        element: u64,
        /// Element sets and materials of the file.
        known: Vec<String>,
    },
    /// Name of a setting that is neither an element set nor a material of the file.
    #[error("the file has no element set and no material \"{name}\"{}", listed(.known))]
    NoSuchMaterial {
        /// Name in the settings.
        name: String,
        /// Element sets and materials of the file.
        known: Vec<String>,
    },
    /// Material of the file without some of its constants.
    #[error(
        "the file gives the material \"{material}\" no {what}; give the whole material under `materials`"
    )]
    MaterialLacks {
        /// Name of the material.
        material: String,
        /// Constants that are not there.
        what: &'static str,
    },
    /// Material over temperature without a temperature.
    #[error(
        "the file tabulates the material \"{material}\" at {rows} temperatures; say under `temperatures` at which the wheel runs"
    )]
    Temperature {
        /// Name of the material.
        material: String,
        /// Number of rows.
        rows: usize,
    },
    /// Constant out of its range.
    #[error("{constant} {value} of the material \"{material}\" {rule}")]
    Constant {
        /// Name of the material.
        material: String,
        /// Name of the constant.
        constant: &'static str,
        /// Value of the constant.
        value: f64,
        /// Range of the constant.
        rule: &'static str,
    },
    /// Top speed that is not positive.
    #[error("the top speed {0} rad/s must be positive")]
    TopSpeed(f64),
    /// Number of sectors of 0.
    #[error("a wheel has at least one sector")]
    Sectors,
    /// Axis of rotation without a direction.
    #[error("the axis of rotation has no direction")]
    AxisWithoutDirection,
    /// Half a turn that fits beside a turn about another axis.
    #[error(
        "half a turn about {about:?} lays faces of the skin onto others, and so does the turn by 2π/{sectors} about {other:?}: state the `axis`"
    )]
    HalfTurn {
        /// Direction of the axis of two sectors.
        about: [f64; 3],
        /// Direction of the other axis.
        other: [f64; 3],
        /// Number of sectors about the other axis.
        sectors: usize,
    },
    /// Mesh without cyclic faces.
    #[error("{}", no_faces(*.sectors, .near.as_ref(), *.tolerance, *.axes))]
    NoFaces {
        /// Number of sectors, if it was given.
        sectors: Option<usize>,
        /// Nearest miss, if there is one.
        near: Option<NearMiss>,
        /// Largest distance that is accepted.
        tolerance: f64,
        /// Number of axes that were tried.
        axes: usize,
    },
    /// Several axes by which faces fit equally well.
    #[error(
        "the faces of the skin fit about several axes: {}, and {}; give `axis` and `sectors`",
        .axes[0], .axes[1]
    )]
    AxesAlike {
        /// Two of them.
        axes: [FittingAxis; 2],
    },
    /// Node of a cyclic face without a partner.
    #[error(
        "node {node} of the low face turned by 2π/{sectors} meets no node of the high face within {tolerance:.2e}: the nearest is {nearest}, \
         {distance:.3e} away; mesh both faces alike"
    )]
    NoPartner {
        /// Number of the node.
        node: u64,
        /// Number of sectors N.
        sectors: usize,
        /// Number of the nearest node.
        nearest: u64,
        /// Distance of the nearest node.
        distance: f64,
        /// Largest distance that is accepted.
        tolerance: f64,
    },
    /// Node on low and high face at once.
    #[error(
        "node {node} is on both cyclic faces; a sector is one pitch between two faces that do not meet away from the axis"
    )]
    BothFaces {
        /// Number of the node.
        node: u64,
    },
    /// Node on which two low nodes fall.
    #[error(
        "two nodes of the low face turned by 2π/{sectors} meet the same node {node}; mesh both faces alike"
    )]
    SharedPartner {
        /// Number of the node of the high face.
        node: u64,
        /// Number of sectors N.
        sectors: usize,
    },
    /// Node set that is not in the file.
    #[error("the file has no nodes in a set \"{name}\"{}", listed(.known))]
    NoSuchSet {
        /// Name of the set.
        name: String,
        /// Node sets of the file.
        known: Vec<String>,
    },
    /// Set without a node of the body.
    #[error("no node of the set \"{name}\" belongs to an element")]
    SetElsewhere {
        /// Name of the set.
        name: String,
    },
    /// Clamp without a node.
    #[error("no node of the clamp belongs to an element")]
    NothingClamped,
    /// Clamp that leaves the nodes on the edges of its faces free.
    #[error(
        "the clamp holds the corners of a face of element {element} and none of the nodes on its edges, as a set of corner nodes does; hold all nodes of \
         the face"
    )]
    ClampOfCorners {
        /// Number of the element.
        element: u64,
    },
    /// Wheel without a bore, and without a stated clamp.
    #[error(
        "nothing says where the wheel is held: the file holds no nodes and there is no bore; name a node set with `clamp_set`, or a node of the clamped face with `clamp_at`"
    )]
    NoBore,
    /// Skin without a recognisable tip.
    #[error(
        "no blade tip was found on the skin; name a node set along the tip with \
         `contact_set`, a node of it with `contact_at`, or give the curve of the `shroud`, which also tips with a kink follow"
    )]
    NoTip,
    /// Contact set that is neither a line nor an area.
    #[error(
        "the nodes of the set \"{name}\" are neither one line of at most 5,000 nodes nor do they cover faces of the skin"
    )]
    NoLine {
        /// Name of the set.
        name: String,
    },
    /// End of the contact line that lies on no sharp edge.
    #[error(
        "node {node} lies on no sharp edge of the skin; `contact_between` names two nodes on the edge of a tip"
    )]
    NotOnEdge {
        /// Number of the node.
        node: u64,
    },
    /// Ends of the contact line that no sharp edges join.
    #[error("no sharp edges of the skin lead from node {} to node {}", .ends[0], .ends[1])]
    NoWay {
        /// Numbers of the nodes.
        ends: [u64; 2],
    },
    /// Contact line of too few usable nodes.
    #[error(
        "the contact line has {found} free nodes away from the cyclic faces and the axis; at least 3 are needed for its normals"
    )]
    FewNodes {
        /// Number of usable nodes.
        found: usize,
    },
    /// Contact line around the axis, whose normals no meridional curve gives.
    #[error(
        "at node {node} the contact line runs around the axis, at one radius and axial coordinate; give one that runs along the tip from \
         inlet to outlet"
    )]
    NoMeridian {
        /// Number of the node.
        node: u64,
    },
    /// Contact nodes without a normal.
    #[error("{0}")]
    Normals(String),
    /// Units that are not consistent.
    #[error("{0}")]
    Units(String),
    /// Matrices of different rows.
    #[error(
        "node {node}, component {component} has a row in one matrix and none in another; export all of one model with the same supports"
    )]
    RowsDiffer {
        /// Number of the node.
        node: u64,
        /// Component, 1 to 3.
        component: u8,
    },
    /// Matrices that clamp nothing.
    #[error(
        "every node has rows in the matrices, so that nothing holds the wheel; export them with its supports"
    )]
    NothingHeld,
    /// Clamp of the settings beside matrices, whose rows say what is clamped.
    #[error("matrices clamp the nodes that have no rows; leave `clamp_set` and `clamp_at` out")]
    ClampBesideMatrices,
    /// Pair of nodes of which one has rows.
    #[error(
        "of the nodes {low} and {high} of the cyclic faces only one has rows in the matrices; clamp both alike, and leave cyclic ties out"
    )]
    HalfHeld {
        /// Number of the low node.
        low: u64,
        /// Number of the high node.
        high: u64,
    },
    /// Matrices in coordinate systems of their nodes.
    #[error("{}the rows of its nodes are not in x, y, z but in systems of their own, and so are the rows of the matrices; export without them",
        if *.line > 0 { format!("line {line} ({card}): ") } else { format!("{card}: ") })]
    NodalFrames {
        /// Line of the first such node, 0 where the format has none.
        line: u64,
        /// Card that says so.
        card: String,
    },
    /// Settings that choose one thing in two ways.
    #[error("{} both say where the {of} is; leave one out", .settings.map(|name| format!("`{name}`")).join(" and "))]
    Conflict {
        /// Names of the settings.
        settings: [&'static str; 2],
        /// Part of the model that they choose.
        of: &'static str,
    },
    /// Node of a setting that lies on no free face of the skin.
    #[error(
        "node {node} of `{setting}` lies on no free face of the skin: it is on a cyclic face, inside of the body, or not in the mesh"
    )]
    OffSkin {
        /// Number of the node.
        node: u64,
        /// Name of the setting.
        setting: &'static str,
    },
    /// Node of a setting on an edge of several patches.
    #[error(
        "node {node} of `{setting}` lies on an edge of {patches} patches of the skin; name a node inside of one, or all corners of one of its \
         faces"
    )]
    OnEdge {
        /// Number of the node.
        node: u64,
        /// Name of the setting.
        setting: &'static str,
        /// Number of patches around the node.
        patches: usize,
    },
    /// Nodes of the tip on several patches.
    #[error(
        "the nodes of `contact_at` name {patches} patches of the skin; a tip is one patch: name a single node inside of it"
    )]
    TwoTips {
        /// Number of patches.
        patches: usize,
    },
    /// Invalid shroud curve, or one that no face looks at.
    #[error("the curve `shroud` {problem}")]
    Shroud {
        /// Problem of the curve.
        problem: String,
    },
    /// Shroud curve far away from any tip.
    #[error(
        "the tip that is nearest to the curve `shroud` is {distance:.4} away from it and {length:.4} long; at most {part} of its \
         length is taken for a clearance. Points of the curve are r and z from the axis, in the units of the mesh"
    )]
    ShroudFar {
        /// Mean distance of the tip.
        distance: f64,
        /// Length of the tip.
        length: f64,
        /// Largest distance, in lengths of the tip.
        part: f64,
    },
    /// Row of a node that the mesh does not have.
    #[error("the matrices have a row of node {node}, component {component}, which the mesh does not have")]
    RowWithoutNode {
        /// Number of the node.
        node: u64,
        /// Component, 1 to 3.
        component: u8,
    },
    /// Sector that can move as a rigid body.
    #[error(transparent)]
    CanMove(#[from] CanMove),
}

/// Two nodes at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Twin {
    /// Numbers of the nodes.
    pub nodes: [u64; 2],
    /// Place of the first.
    pub at: [f64; 3],
    /// Number of such pairs.
    pub count: usize,
}

/// Axis about which faces fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FittingAxis {
    /// Point on the axis.
    pub origin: [f64; 3],
    /// Direction of the axis.
    pub direction: [f64; 3],
    /// Number of sectors by which faces fit.
    pub sectors: usize,
}

impl fmt::Display for FittingAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { origin, direction, sectors } = self;
        write!(f, "through {origin:?} along {direction:?} with {sectors} sectors")
    }
}

/// Faces that almost fit each other.
#[derive(Debug, Clone, PartialEq)]
pub struct NearMiss {
    /// Number of sectors by which they almost fit.
    pub sectors: usize,
    /// Number of faces that almost fit.
    pub faces: usize,
    /// Largest distance of their centres after the turn.
    pub farthest: f64,
}

fn listed(known: &[String]) -> String {
    if known.is_empty() {
        return String::new();
    }
    let more = if known.len() > MOST_NAMED { ", …" } else { "" };
    format!(" (it has {}{more})", known.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", "))
}

fn no_faces(sectors: Option<usize>, near: Option<&NearMiss>, tolerance: f64, axes: usize) -> String {
    let by = match sectors {
        Some(sectors) => format!("no face of the skin turned by 2π/{sectors} meets another"),
        None => "no turn by 2π/N carries faces of the skin onto others".to_owned(),
    };
    let axis = if axes > 1 {
        " about x, y or z through the origin, nor about any axis that congruent faces suggest; give `axis` and `sectors`"
    } else {
        " about this axis; check `axis` and `sectors`"
    };
    let near = near.map_or(String::new(), |near| {
        format!(
            ". By 2π/{}, {} faces come within {:.3e} of each other, and {tolerance:.1e} is accepted: mesh both faces alike",
            near.sectors, near.faces, near.farthest
        )
    });
    format!("{by}{axis}{near}. A single blade has `sectors` 1")
}
