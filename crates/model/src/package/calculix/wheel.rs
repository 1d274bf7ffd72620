//! Cut of one sector out of the matrices of a whole wheel.
//!
//! Which nodes belong to which sector is read off geometry and pattern: the turn by 2π/N maps nodes onto nodes, and
//! without the N copies of the low face the pattern of the stiffness falls apart into the insides of the N sectors. The
//! sector is the inside coupled to the low face L and to its copy L⁺ one sector further, which is its high face:
//!
//! ```text
//! [ Y(o,o)   Y(o,L⁺) ]      o = L and the inside; the neighbour's part of Y(L,L) is assembled already,
//! [ Y(L⁺,o)     0    ]      so the block of the high face stays empty
//! ```

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::Vector3;

use super::error::{ModelProblem, NoCopy};
use super::matrices::DofList;
use super::no_mesh::NoMesh;
use crate::package::by_place::NodeGrid;
use crate::package::raw::{RawDof, RawMatrix};
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::place::on_axis;

/// Largest difference of the sectors, relative to the largest force: meshes copied with six digits stay well below.
const CYCLIC_TOLERANCE: f64 = 1e-3;

/// Nodes and DOF of the sector in a wheel.
pub(super) struct Cut<'a> {
    wheel: &'a DofList,
    sectors: usize,
    frame: &'a AxisFrame,
    /// Pairs of low node and high node.
    pub(super) pairs: Vec<[u64; 2]>,
    /// Nodes of the low and of the high face.
    faces: [HashSet<u64>; 2],
    /// Nodes of the sector, without those of the high face.
    pub(super) own: HashSet<u64>,
    /// DOF of the sector: own ones in the order of the wheel, then those of the high face.
    pub(super) dofs: Vec<RawDof>,
    /// Row in the sector of each row of the wheel.
    row_of: Vec<Option<u32>>,
    /// First row of the high face.
    high_from: u32,
    /// Copy of each node one sector further.
    next: HashMap<u64, u64>,
}

/// Finds the sector that follows the low face in the sense of the rotation.
pub(super) fn cut<'a>(
    dofs: &'a DofList,
    stiffness: &RawMatrix,
    positions: &HashMap<u64, [f64; 3]>,
    low: &[u64],
    sectors: usize,
    frame: &'a AxisFrame,
    tolerance: f64,
) -> Result<Cut<'a>, ModelProblem> {
    if sectors < 3 {
        return Err(ModelProblem::WheelTooSmall { sectors });
    }
    let mut nodes: Vec<u64> = dofs.dofs.iter().map(|dof| dof.node).collect();
    let mut seen = HashSet::new();
    nodes.retain(|node| seen.insert(*node));
    if let Some(&node) = nodes.iter().find(|node| on_axis(positions[node], frame, sectors, tolerance)) {
        return Err(ModelProblem::FreeOnAxis { node });
    }
    let places = NodeGrid::new(nodes.iter().map(|node| (*node, positions[node])).collect(), tolerance);
    let alpha = TAU / sectors as f64;
    let mut next = HashMap::new();
    for &node in &nodes {
        let copy = places.at(frame.turn_point(positions[&node], alpha)).map_err(|near| {
            let (nearest, distance) = (near.node, near.distance);
            ModelProblem::WheelMesh(NoCopy { node, sectors, tolerance, nearest, distance })
        })?;
        next.insert(node, copy);
    }
    let low: Vec<u64> = low.iter().copied().filter(|node| next.contains_key(node)).collect();
    let high: Vec<u64> = low.iter().map(|node| next[node]).collect();
    let mut faces = HashSet::new();
    let mut copy = low.clone();
    for _ in 0..sectors {
        faces.extend(copy.iter().copied());
        copy.iter_mut().for_each(|node| *node = next[node]);
    }
    let mut parts = Parts::new(&nodes);
    for (a, b) in node_pairs(dofs, stiffness).filter(|(a, b)| !faces.contains(a) && !faces.contains(b)) {
        parts.join(a, b);
    }
    let [low_set, high_set] = [&low, &high].map(|face| face.iter().copied().collect::<HashSet<u64>>());
    let mut touching: [HashSet<u64>; 2] = Default::default();
    for (a, b) in node_pairs(dofs, stiffness) {
        for (face, inside) in [(a, b), (b, a)] {
            if !faces.contains(&inside) {
                let part = parts.of(inside);
                if low_set.contains(&face) {
                    touching[0].insert(part);
                }
                if high_set.contains(&face) {
                    touching[1].insert(part);
                }
            }
        }
    }
    let all: HashSet<u64> =
        nodes.iter().filter(|node| !faces.contains(node)).map(|node| parts.of(*node)).collect();
    let between: Vec<u64> = touching[0].intersection(&touching[1]).copied().collect();
    let [part] = between[..] else {
        return Err(ModelProblem::WheelParts { parts: all.len(), sectors });
    };
    if all.len() != sectors || faces.len() != sectors * low.len() {
        return Err(ModelProblem::WheelParts { parts: all.len(), sectors });
    }
    let own: HashSet<u64> = (nodes.iter().copied())
        .filter(|node| low_set.contains(node) || (!faces.contains(node) && parts.of(*node) == part))
        .collect();
    let mut row_of = vec![None; dofs.dofs.len()];
    let mut of_sector = Vec::new();
    let mut high_from = 0;
    for wanted in [&own, &high_set] {
        high_from = of_sector.len() as u32;
        for (row, dof) in dofs.dofs.iter().enumerate().filter(|(_, dof)| wanted.contains(&dof.node)) {
            row_of[row] = Some(of_sector.len() as u32);
            of_sector.push(*dof);
        }
    }
    let pairs = low.iter().zip(&high).map(|(low, high)| [*low, *high]).collect();
    let faces = [low_set, high_set];
    Ok(Cut { wheel: dofs, sectors, frame, pairs, faces, own, dofs: of_sector, row_of, high_from, next })
}

impl Cut<'_> {
    /// Whether an element can move: some of its nodes are free.
    pub(super) fn moves(&self, nodes: &[u64]) -> bool {
        nodes.iter().any(|node| self.next.contains_key(node))
    }

    /// Whether an element that can move belongs to the sector: it has a free node inside.
    pub(super) fn has(&self, element: u64, nodes: &[u64]) -> Result<bool, NoMesh> {
        let [low, high] = self.faces.each_ref().map(|face| |node: &u64| face.contains(node));
        let mut free = nodes.iter().filter(|node| self.next.contains_key(node)).peekable();
        if free.peek().is_none() {
            return Ok(false);
        }
        if free.clone().any(|node| self.own.contains(node) && !low(node)) {
            return Ok(true);
        }
        // Between two faces, or at one of them and held elsewhere, it may be on either side.
        if free.all(|node| low(node) || high(node)) {
            Err(NoMesh::WhichSector { element })
        } else {
            Ok(false)
        }
    }

    /// Sector's part of a matrix of the wheel, and the difference of the sectors.
    pub(super) fn sector(&self, file: &Path, matrix: &RawMatrix) -> Result<(RawMatrix, f64), ModelProblem> {
        let difference = self.check_cyclic(file, matrix)?;
        let mut entries = Vec::new();
        for &(row, column, value) in &matrix.entries {
            if let (Some(row), Some(column)) = (self.row_of[row as usize], self.row_of[column as usize])
                && row.min(column) < self.high_from
            {
                entries.push((row.max(column), row.min(column), value));
            }
        }
        entries.sort_unstable_by_key(|entry| (entry.1, entry.0));
        Ok((RawMatrix { size: self.dofs.len(), entries }, difference))
    }

    /// Difference of Y T x and T Y x, with T the turn of the wheel by one sector and x any displacement without symmetry.
    fn check_cyclic(&self, file: &Path, matrix: &RawMatrix) -> Result<f64, ModelProblem> {
        let dofs = self.wheel;
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let x: Vec<f64> = dofs.dofs.iter().map(|_| number()).collect();
        let turned = |x: &[f64]| -> HashMap<u64, Vector3<f64>> {
            let basis = self.frame.turned_global(TAU / self.sectors as f64);
            // Rows of the basis are the turned unit vectors: their combination is the turned vector.
            by_node(dofs, x).into_iter().map(|(node, v)| (self.next[&node], basis.tr_mul(&v))).collect()
        };
        let of_turned = turned(&x);
        let tx: Vec<f64> =
            dofs.dofs.iter().map(|dof| of_turned[&dof.node][usize::from(dof.component) - 1]).collect();
        let y_tx = by_node(dofs, &times(matrix, &tx));
        let t_yx = turned(&times(matrix, &x));
        let largest = y_tx.values().map(Vector3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let mut worst = (0.0, 0, 0);
        for dof in &dofs.dofs {
            let copy = self.next[&dof.node];
            let off = (y_tx[&copy] - t_yx[&copy]).norm() / largest;
            if off > worst.0 {
                worst = (off, dof.node, copy);
            }
        }
        let (difference, node, copy) = worst;
        if difference <= CYCLIC_TOLERANCE {
            return Ok(difference);
        }
        let (file, tolerance) = (file.to_owned(), CYCLIC_TOLERANCE);
        Err(ModelProblem::WheelMatrix { file, node, copy, difference, tolerance })
    }
}

/// Product A · x.
pub(super) fn times(matrix: &RawMatrix, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; matrix.size];
    for &(row, column, value) in &matrix.entries {
        y[row as usize] += value * x[column as usize];
        if row != column {
            y[column as usize] += value * x[row as usize];
        }
    }
    y
}

/// Vector at each node, with zeros for clamped components.
fn by_node(dofs: &DofList, x: &[f64]) -> HashMap<u64, Vector3<f64>> {
    let mut vectors = HashMap::new();
    for (dof, value) in dofs.dofs.iter().zip(x) {
        vectors.entry(dof.node).or_insert_with(Vector3::zeros)[usize::from(dof.component) - 1] = *value;
    }
    vectors
}

/// Pairs of different nodes that an entry couples.
fn node_pairs<'a>(dofs: &'a DofList, matrix: &'a RawMatrix) -> impl Iterator<Item = (u64, u64)> + 'a {
    let node = |row: u32| dofs.dofs[row as usize].node;
    matrix.entries.iter().map(move |&(row, column, _)| (node(row), node(column))).filter(|(a, b)| a != b)
}

/// Connected parts of a graph of nodes (union–find).
struct Parts {
    parent: HashMap<u64, u64>,
}

impl Parts {
    fn new(nodes: &[u64]) -> Self {
        Self { parent: nodes.iter().map(|node| (*node, *node)).collect() }
    }

    fn of(&mut self, node: u64) -> u64 {
        let mut at = node;
        while self.parent[&at] != at {
            let above = self.parent[&self.parent[&at]];
            self.parent.insert(at, above);
            at = above;
        }
        at
    }

    fn join(&mut self, a: u64, b: u64) {
        let (a, b) = (self.of(a), self.of(b));
        // The smaller number stands for the part, in whatever order pairs come.
        self.parent.insert(a.max(b), a.min(b));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_node_on_the_axis_is_told_as_such() {
        let alpha = TAU / 5.0;
        let ring = (0..5).map(|k| (k + 1, [(k as f64 * alpha).cos(), (k as f64 * alpha).sin(), 0.0]));
        let positions: HashMap<u64, [f64; 3]> = ring.chain([(9, [0.0, 0.0, 0.2])]).collect();
        let dofs = [1, 2, 3, 4, 5, 9].map(|node| RawDof { node, component: 1 }).to_vec();
        let stiffness = RawMatrix { size: 6, entries: (0..6).map(|row| (5, row, 1.0)).collect() };
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        let wheel = DofList { path: "rest.dof".into(), dofs };
        let refused = cut(&wheel, &stiffness, &positions, &[1], 5, &frame, 1e-5).map(drop).unwrap_err();
        assert!(matches!(refused, ModelProblem::FreeOnAxis { node: 9 }), "{refused}");
    }
}
