//! Assembly of element matrices and loads into those of a mesh, in the cylindrical components of each node.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use super::element::Blocks;
use super::mesh::HexMesh;
use super::pattern::Pattern;

/// Number of elements computed at once before they are summed: enough work for every thread, little memory.
const BATCH: usize = 256;

/// Rotation T at angle θ, with u_(r,θ,z) = T u_(x,y,z).
pub fn cylindrical_frame(theta: f64) -> Matrix3<f64> {
    let (s, c) = theta.sin_cos();
    Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
}

/// Mesh of elements with N nodes whose displacements are numbered.
///
/// Elements are computed in parallel and summed in their order: the result is the same bits for any number of
/// threads.
#[derive(Debug)]
pub(super) struct Assembly<'a, const N: usize> {
    elements: &'a [[usize; N]],
    /// Rows of the r, θ and z displacements of each node, where free; tied nodes share theirs.
    numbering: &'a [[Option<usize>; 3]],
    /// Rotation of each node, its [`cylindrical_frame`].
    frames: Vec<Matrix3<f64>>,
}

impl<'a, const N: usize> Assembly<'a, N> {
    pub(super) fn new(
        mesh: &HexMesh,
        elements: &'a [[usize; N]],
        numbering: &'a [[Option<usize>; 3]],
    ) -> Self {
        let frames = (0..mesh.nodes.len()).map(|node| cylindrical_frame(mesh.angle(node))).collect();
        Self { elements, numbering, frames }
    }

    /// Sums `matrix(e)`, (skew-)symmetric and in x, y, z, over the elements: a value per position of `pattern`, which is the pattern of
    /// these elements under this numbering.
    pub(super) fn matrix(&self, pattern: &Pattern, matrix: impl Fn(usize) -> Blocks<N> + Sync) -> Vec<f64> {
        let mut values = vec![0.0; pattern.len()];
        for (batch, elements) in self.elements.chunks(BATCH).enumerate() {
            let turned = |i: usize| self.turned(&elements[i], matrix(batch * BATCH + i));
            let blocks: Vec<Blocks<N>> = (0..elements.len()).into_par_iter().map(turned).collect();
            for (nodes, blocks) in elements.iter().zip(&blocks) {
                self.add(pattern, nodes, blocks, &mut values);
            }
        }
        values
    }

    /// Sums `load(e)`, nodal forces in x, y, z, over the elements: a value for each of `size` rows.
    pub(super) fn load(&self, size: usize, load: impl Fn(usize) -> [Vector3<f64>; N] + Sync) -> Vec<f64> {
        let loads: Vec<[Vector3<f64>; N]> = (0..self.elements.len()).into_par_iter().map(&load).collect();
        let mut sum = vec![0.0; size];
        for (nodes, load) in self.elements.iter().zip(&loads) {
            for (&node, force) in nodes.iter().zip(load) {
                let force = self.frames[node] * force;
                for (row, force) in self.numbering[node].iter().zip(force.iter()) {
                    if let Some(row) = *row {
                        sum[row] += force;
                    }
                }
            }
        }
        sum
    }

    /// Displacements of an element's nodes in x, y, z from nodal cylindrical ones.
    pub(super) fn displacements(&self, element: usize, nodal: &[[f64; 3]]) -> [Vector3<f64>; N] {
        self.elements[element].map(|node| self.frames[node].transpose() * Vector3::from(nodal[node]))
    }

    /// Turns the blocks of an element to the cylindrical components of its nodes.
    fn turned(&self, nodes: &[usize; N], mut blocks: Blocks<N>) -> Blocks<N> {
        for (a, row) in blocks.iter_mut().enumerate() {
            for (b, block) in row.iter_mut().enumerate() {
                *block = self.frames[nodes[a]] * *block * self.frames[nodes[b]].transpose();
            }
        }
        blocks
    }

    /// Adds the lower triangle of an element's matrix.
    fn add(&self, pattern: &Pattern, nodes: &[usize; N], blocks: &Blocks<N>, values: &mut [f64]) {
        for (b, &column_node) in nodes.iter().enumerate() {
            for (cb, column) in self.numbering[column_node].iter().enumerate() {
                let Some(column) = *column else { continue };
                let (rows, start) = pattern.column(column);
                for (a, &row_node) in nodes.iter().enumerate() {
                    let mut place = None;
                    for (ca, row) in self.numbering[row_node].iter().enumerate() {
                        let Some(row) = row.filter(|&row| row >= column) else { continue };
                        // The rows of a node lie side by side.
                        let at = place
                            .unwrap_or_else(|| start + rows.partition_point(|&other| (other as usize) < row));
                        values[at] += blocks[a][b][(ca, cb)];
                        place = Some(at + 1);
                    }
                }
            }
        }
    }
}
