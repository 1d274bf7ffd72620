//! Conversion of a checked package to the sector model: cylindrical components, high face eliminated (docs/method.md, Conventions and From
//! a sector to harmonic matrices).
//!
//! A sector matrix A couples own rows (o) and rows of the high face (c). The high face of sector s is the low face of
//! sector s + 1, whose displacement has the same *cylindrical* components there, so with P the map from high rows to
//! their low counterparts among the own rows
//!
//! ```text
//! Y0 = A_oo + P A_cc Pᵀ        Y1 = A_oc Pᵀ        Ŷ(i) = Y0 + Y1 e^{jiα} + Y1ᵀ e^{−jiα}
//! ```
//!
//! for assembled (A_cc = 0) and unassembled packages alike, and any N, 1 and 2 included; the gyroscopic matrix likewise, with
//! −Y1ᵀ in the place of Y1ᵀ.

use std::collections::HashMap;
use std::f64::consts::TAU;

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use nalgebra::{Matrix3, Vector3};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::check::layout::{Layout, NONE};
use super::raw::{Frame, RawMatrix, RawPackage};
use super::symmetric::Mirror;
use rubmap_solid::frame::Basis;
use rubmap_wheel::dynamics::sector::{AxisNode, ContactNode, CyclicMatrix, SectorParts};

/// Builds the parts of the sector; matrices in parallel, each the same bits for any number of threads.
pub(super) fn build(package: RawPackage, layout: &Layout) -> SectorParts {
    let bases = match package.manifest.frame {
        Frame::Cartesian => Some(local_bases(&package, layout)),
        Frame::Cylindrical => None,
    };
    let components: Vec<u8> = package.dofs.iter().map(|dof| dof.component - 1).collect();
    let folding = Folding { layout, components: &components, bases: bases.as_deref() };
    let contact = contact_nodes(&package, layout, bases.as_deref());
    let axis = axis_nodes(layout, bases.as_deref());
    let speeds = package.stiffness.len();
    let mass_first: Vec<(RawMatrix, Mirror)> = std::iter::once(package.mass)
        .chain(package.stiffness)
        .map(|matrix| (matrix, Mirror::Symmetric))
        .chain(package.gyroscopic.map(|matrix| (matrix, Mirror::Skew)))
        .collect();
    let mut matrices: Vec<CyclicMatrix> =
        mass_first.into_par_iter().map(|(matrix, mirror)| folding.fold(matrix, mirror)).collect();
    let gyroscopic = matrices.split_off(1 + speeds).pop();
    let stiffness = matrices.split_off(1);
    let Some(mass) = matrices.pop() else {
        unreachable!("one matrix is folded per matrix, and the mass is the first")
    };
    SectorParts {
        name: package.manifest.name,
        sectors: package.manifest.sectors,
        units: package.manifest.units,
        mass,
        stiffness,
        gyroscopic,
        speeds_rad_s: package.manifest.speeds_rad_s,
        contact,
        axis,
        node_of_dof: node_of_dof(layout),
    }
}

/// Node of each own DOF, nodes numbered by their first own row.
fn node_of_dof(layout: &Layout) -> Vec<usize> {
    let mut numbers = HashMap::new();
    let node_of = |&row: &u32| {
        let next = numbers.len();
        *numbers.entry(layout.node_of_row[row as usize]).or_insert(next)
    };
    layout.own_rows.iter().map(node_of).collect()
}

fn contact_nodes(package: &RawPackage, layout: &Layout, bases: Option<&[Basis]>) -> Vec<ContactNode> {
    let nodes = layout.contact.iter().zip(&layout.normals);
    nodes
        .map(|(&node, &normal)| {
            let node = node as usize;
            ContactNode {
                id: package.nodes[node].id,
                position: layout.frame.coordinates(package.nodes[node].position),
                normal: bases.map_or(normal, |bases| (bases[node] * Vector3::from(normal)).into()),
                dofs: layout.rows_of_node[node].map(|row| layout.own_of_row[row as usize] as usize),
            }
        })
        .collect()
}

/// Nodes on the axis with the directions of their DOF, which the check has found along and across it.
fn axis_nodes(layout: &Layout, bases: Option<&[Basis]>) -> Vec<AxisNode> {
    let direction = layout.frame.direction();
    let node = |&node: &u32| {
        let rows = layout.rows_of_node[node as usize];
        let dof = |component: usize| match rows[component] {
            NONE => None,
            row => Some(layout.own_of_row[row as usize] as usize),
        };
        // A node that is clamped in part keeps its Cartesian components.
        let (axial, sense) = match bases {
            Some(_) if rows.contains(&NONE) => (direction.iamax(), direction[direction.iamax()]),
            _ => (2, 1.0),
        };
        let across = [(axial + 1) % 3, (axial + 2) % 3];
        let [first, second] = if sense < 0.0 { [across[1], across[0]] } else { across };
        AxisNode { axial: dof(axial), lateral: [dof(first), dof(second)] }
    };
    layout.on_axis.iter().map(node).collect()
}

/// Local basis of each node of a Cartesian package, with zero rows and columns for clamped components.
///
/// A node with all three DOF takes (r, θ, z); a high node those of its low node turned by α, rather than of its own
/// position, so that the cyclic condition holds to round-off however roughly coordinates were printed.
///
/// A node clamped in part cannot be rotated in general, and need not be: the matrices of internal DOF are equally good in any local basis,
/// nothing asks for their (r, θ, z), and contact nodes are complete. So it keeps its Cartesian components, and a high node takes those of
/// its low node turned by α. The only condition is that the turn maps the free directions of the low node onto those of the high node,
/// which the check of the faces has verified.
fn local_bases(package: &RawPackage, layout: &Layout) -> Vec<Basis> {
    let alpha = TAU / package.manifest.sectors as f64;
    let basis = |node: usize| -> Basis {
        let (reference, turn) = match layout.low_of[node] {
            NONE => (node, 0.0),
            low => (low as usize, alpha),
        };
        let present = layout.rows_of_node[node].map(|row| row != NONE);
        if present == [true; 3] {
            let [_, theta, _] = layout.frame.coordinates(package.nodes[reference].position);
            return layout.frame.cylindrical(theta + turn);
        }
        let full = if turn == 0.0 { Basis::identity() } else { layout.frame.turned_global(turn) };
        Basis::from_fn(|i, j| if present[i] && present[j] { full[(i, j)] } else { 0.0 })
    };
    (0..package.nodes.len()).map(basis).collect()
}

/// Data with which every matrix of a package is folded.
struct Folding<'a> {
    layout: &'a Layout,
    /// Component 0, 1 or 2 of each row.
    components: &'a [u8],
    /// Local basis of each node; absent if the package is in cylindrical components already.
    bases: Option<&'a [Basis]>,
}

type Block = Matrix3<f64>;

impl Folding<'_> {
    fn fold(&self, matrix: RawMatrix, mirror: Mirror) -> CyclicMatrix {
        let full = Columns::from_lower(matrix, mirror);
        let nodes = self.layout.rows_of_node.len();
        let mut own = Builder::new(self.layout.own_rows.len());
        let mut next = Builder::new(self.layout.own_rows.len());
        let mut blocks = NodeBlocks::new(nodes);
        let mut of_high = NodeBlocks::new(nodes);
        let is_high = |node: u32| self.layout.low_of[node as usize] != NONE;
        for node in (0..nodes as u32).filter(|&node| !is_high(node)) {
            let high = self.layout.high_of[node as usize];
            self.gather(&full, node, |row_node| !is_high(row_node), &mut blocks);
            for (row_node, block) in blocks.iter_mut() {
                *block = self.rotated(*block, row_node, node, row_node < node);
                if row_node == node {
                    make_exact(mirror, block);
                }
            }
            if high != NONE {
                self.gather(&full, high, is_high, &mut of_high);
                for (row_high, block) in of_high.iter_mut() {
                    let row_node = self.layout.low_of[row_high as usize];
                    let mut block = self.rotated(*block, row_high, high, row_node < node);
                    if row_node == node {
                        make_exact(mirror, &mut block);
                    }
                    *blocks.at(row_node) += block;
                }
                of_high.clear();
            }
            self.emit(&mut blocks, node, &mut own);
            if high != NONE {
                self.gather(&full, high, |row_node| !is_high(row_node), &mut blocks);
                for (row_node, block) in blocks.iter_mut() {
                    *block = self.rotated(*block, row_node, high, false);
                }
                self.emit(&mut blocks, node, &mut next);
            }
        }
        CyclicMatrix { own: own.finish(), next: next.finish() }
    }

    /// Gathers the columns of `node` as 3 × 3 blocks, one for each wanted node of their rows.
    fn gather(&self, full: &Columns, node: u32, wanted: impl Fn(u32) -> bool, blocks: &mut NodeBlocks) {
        for (k, &column) in
            self.layout.rows_of_node[node as usize].iter().enumerate().filter(|(_, c)| **c != NONE)
        {
            for (row, value) in full.column(column as usize) {
                let row_node = self.layout.node_of_row[row as usize];
                if wanted(row_node) {
                    blocks.at(row_node)[(usize::from(self.components[row as usize]), k)] = value;
                }
            }
        }
    }

    /// Product B_row · block · B_columnᵀ, computed from the transposed block if asked to: mirrored blocks then have mirrored bits, and Y0
    /// is exactly (skew-)symmetric.
    fn rotated(&self, block: Block, row_node: u32, column_node: u32, by_transpose: bool) -> Block {
        let Some(bases) = self.bases else { return block };
        let (row, column) = (&bases[row_node as usize], &bases[column_node as usize]);
        if by_transpose {
            (column * block.transpose() * row.transpose()).transpose()
        } else {
            row * block * column.transpose()
        }
    }

    /// Appends the columns of `node` to `out` and empties `blocks`.
    fn emit(&self, blocks: &mut NodeBlocks, node: u32, out: &mut Builder) {
        for (k, &column) in
            self.layout.rows_of_node[node as usize].iter().enumerate().filter(|(_, c)| **c != NONE)
        {
            out.start_column(self.layout.own_of_row[column as usize] as usize);
            for (row_node, block) in blocks.iter() {
                for (&row, &value) in self.layout.rows_of_node[row_node as usize].iter().zip(&block.column(k))
                {
                    // Exact zeros are not stored, whether written by the user or left by cancellation.
                    if row != NONE && value != 0.0 {
                        out.push(self.layout.own_of_row[row as usize] as usize, value);
                    }
                }
            }
            out.finish_column();
        }
        blocks.clear();
    }
}

/// Makes a diagonal block exactly (skew-)symmetric, which it is but for the rounding of its rotation.
fn make_exact(mirror: Mirror, block: &mut Block) {
    for (i, j) in [(1, 0), (2, 0), (2, 1)] {
        block[(j, i)] = mirror.image(block[(i, j)]);
    }
    if mirror == Mirror::Skew {
        block.fill_diagonal(0.0);
    }
}

/// Matrix with both triangles in compressed columns; 12 bytes per stored entry.
struct Columns {
    starts: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Columns {
    fn from_lower(matrix: RawMatrix, mirror: Mirror) -> Self {
        let mut starts = vec![0; matrix.size + 1];
        for &(row, column, _) in &matrix.entries {
            starts[column as usize + 1] += 1;
            if row != column {
                starts[row as usize + 1] += 1;
            }
        }
        for k in 0..matrix.size {
            starts[k + 1] += starts[k];
        }
        let mut free = starts.clone();
        let mut rows = vec![0; starts[matrix.size]];
        let mut values = vec![0.0; starts[matrix.size]];
        let mut put = |row: u32, column: u32, value: f64| {
            let at = free[column as usize];
            (rows[at], values[at]) = (row, value);
            free[column as usize] += 1;
        };
        for (row, column, value) in matrix.entries {
            put(row, column, value);
            if row != column {
                put(column, row, mirror.image(value));
            }
        }
        Self { starts, rows, values }
    }

    fn column(&self, column: usize) -> impl Iterator<Item = (u32, f64)> {
        let range = self.starts[column]..self.starts[column + 1];
        self.rows[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }
}

/// Blocks of one node's columns, found by the node of their rows.
struct NodeBlocks {
    nodes: Vec<u32>,
    blocks: Vec<Block>,
    place: Vec<u32>,
}

impl NodeBlocks {
    fn new(nodes: usize) -> Self {
        Self { nodes: Vec::new(), blocks: Vec::new(), place: vec![NONE; nodes] }
    }

    fn at(&mut self, node: u32) -> &mut Block {
        let place = &mut self.place[node as usize];
        if *place == NONE {
            *place = self.nodes.len() as u32;
            self.nodes.push(node);
            self.blocks.push(Block::zeros());
        }
        &mut self.blocks[*place as usize]
    }

    fn iter(&self) -> impl Iterator<Item = (u32, &Block)> {
        self.nodes.iter().copied().zip(&self.blocks)
    }

    fn iter_mut(&mut self) -> impl Iterator<Item = (u32, &mut Block)> {
        self.nodes.iter().copied().zip(&mut self.blocks)
    }

    fn clear(&mut self) {
        for node in self.nodes.drain(..) {
            self.place[node as usize] = NONE;
        }
        self.blocks.clear();
    }
}

/// Square sparse matrix written column by column, in any order of columns.
struct Builder {
    size: usize,
    rows: Vec<usize>,
    values: Vec<f64>,
    /// Columns in the order written, as `(column, first entry)`.
    written: Vec<(usize, usize)>,
    column: Vec<(usize, f64)>,
}

impl Builder {
    fn new(size: usize) -> Self {
        Self { size, rows: Vec::new(), values: Vec::new(), written: Vec::new(), column: Vec::new() }
    }

    fn start_column(&mut self, column: usize) {
        self.written.push((column, self.rows.len()));
    }

    fn push(&mut self, row: usize, value: f64) {
        self.column.push((row, value));
    }

    fn finish_column(&mut self) {
        self.column.sort_unstable_by_key(|(row, _)| *row);
        self.rows.extend(self.column.iter().map(|(row, _)| *row));
        self.values.extend(self.column.drain(..).map(|(_, value)| value));
    }

    fn finish(mut self) -> SparseColMat<usize, f64> {
        let total = self.rows.len();
        let mut ranges = vec![0..0; self.size];
        for (k, &(column, start)) in self.written.iter().enumerate() {
            ranges[column] = start..self.written.get(k + 1).map_or(total, |(_, end)| *end);
        }
        let mut starts = Vec::with_capacity(self.size + 1);
        starts.push(0);
        for range in &ranges {
            starts.push(starts[starts.len() - 1] + range.len());
        }
        // Packages usually list DOF node by node; only others need their columns put in order.
        if !self.written.is_sorted() {
            self.rows = ranges.iter().flat_map(|range| &self.rows[range.clone()]).copied().collect();
            self.values = ranges.iter().flat_map(|range| &self.values[range.clone()]).copied().collect();
        }
        let symbolic = SymbolicSparseColMat::new_checked(self.size, self.size, starts, None, self.rows);
        SparseColMat::new(symbolic, self.values)
    }
}
