//! Assembly of element matrices and loads into those of a mesh, in the cylindrical components of each node.

use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;
use rubmap_solid::blocks::Blocks;
use rubmap_solid::element::ElementKind;
use rubmap_solid::frame::Basis;
use rubmap_solid::integrals;
use rubmap_solid::material::Material;
use rubmap_solid::mesh::{Element, SectorMesh};
use rubmap_solid::rule::MassRule;

use super::pattern::Pattern;
use super::sector::MeshedSector;

/// Number of elements computed at once before they are summed: enough work for every thread, little memory.
const BATCH: usize = 256;

/// Element with its place in space and its material.
pub(super) struct Placed<'a> {
    pub(super) kind: ElementKind,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) material: &'a Material,
    rule: MassRule,
}

impl Placed<'_> {
    /// Mass of the element over its nodes, the same in every direction.
    pub(super) fn mass(&self) -> DMatrix<f64> {
        integrals::mass(self.kind, &self.positions, self.material.density, self.rule)
    }

    /// Elastic stiffness of the element in x, y, z.
    pub(super) fn stiffness(&self) -> Blocks {
        integrals::stiffness(self.kind, &self.positions, self.material.lame_constants())
    }
}

/// Mesh of elements whose displacements are numbered.
///
/// Elements are computed in parallel and summed in their order: the result is the same bits for any number of
/// threads.
#[derive(Debug)]
pub(super) struct Assembly<'a> {
    mesh: &'a SectorMesh,
    rule: MassRule,
    /// Rows of the r, θ and z displacements of each node, where free; tied nodes share theirs.
    numbering: &'a [[Option<usize>; 3]],
    /// Unit vectors r, θ, z at each node.
    frames: Vec<Basis>,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(sector: &'a MeshedSector, numbering: &'a [[Option<usize>; 3]]) -> Self {
        Self { mesh: &sector.mesh, rule: sector.mass, numbering, frames: sector.frames() }
    }

    fn placed(&self, element: &Element) -> Placed<'a> {
        let material = &self.mesh.sets[element.set as usize].material;
        Placed { kind: element.kind, positions: self.mesh.positions(element), material, rule: self.rule }
    }

    /// Sums `matrix(element, e)`, (skew-)symmetric and in x, y, z, over the elements, e being their index: a value per position of
    /// `pattern`, which is the pattern of these elements under this numbering.
    pub(super) fn matrix(
        &self,
        pattern: &Pattern,
        matrix: impl Fn(&Placed<'_>, usize) -> Blocks + Sync,
    ) -> Vec<f64> {
        let mut values = vec![0.0; pattern.len()];
        for (batch, elements) in self.mesh.elements.chunks(BATCH).enumerate() {
            let turned = |i: usize| {
                let element = &elements[i];
                self.turned(&element.nodes, matrix(&self.placed(element), batch * BATCH + i))
            };
            let blocks: Vec<Blocks> = (0..elements.len()).into_par_iter().map(turned).collect();
            for (element, blocks) in elements.iter().zip(&blocks) {
                self.add(pattern, &element.nodes, blocks, &mut values);
            }
        }
        values
    }

    /// Sums `load(element)`, nodal forces in x, y, z, over the elements: a value for each of `size` rows.
    pub(super) fn load(
        &self,
        size: usize,
        load: impl Fn(&Placed<'_>) -> Vec<Vector3<f64>> + Sync,
    ) -> Vec<f64> {
        let elements = &self.mesh.elements;
        let loads: Vec<_> = elements.par_iter().map(|element| load(&self.placed(element))).collect();
        let mut sum = vec![0.0; size];
        for (element, load) in elements.iter().zip(&loads) {
            for (&node, force) in element.nodes.iter().zip(load) {
                let force = self.frames[node as usize] * force;
                for (row, force) in self.numbering[node as usize].iter().zip(force.iter()) {
                    if let Some(row) = *row {
                        sum[row] += force;
                    }
                }
            }
        }
        sum
    }

    /// Displacements of an element's nodes in x, y, z from nodal cylindrical ones.
    pub(super) fn displacements(&self, element: &Element, nodal: &[[f64; 3]]) -> Vec<Vector3<f64>> {
        let turned =
            |&node: &u32| self.frames[node as usize].transpose() * Vector3::from(nodal[node as usize]);
        element.nodes.iter().map(turned).collect()
    }

    /// Turns the blocks of an element to the cylindrical components of its nodes.
    fn turned(&self, nodes: &[u32], mut blocks: Blocks) -> Blocks {
        for (a, &row) in nodes.iter().enumerate() {
            for (b, &column) in nodes.iter().enumerate() {
                let block = &mut blocks[(a, b)];
                *block = self.frames[row as usize] * *block * self.frames[column as usize].transpose();
            }
        }
        blocks
    }

    /// Adds the lower triangle of an element's matrix.
    fn add(&self, pattern: &Pattern, nodes: &[u32], blocks: &Blocks, values: &mut [f64]) {
        for (b, &column_node) in nodes.iter().enumerate() {
            for (cb, column) in self.numbering[column_node as usize].iter().enumerate() {
                let Some(column) = *column else { continue };
                let (rows, start) = pattern.column(column);
                for (a, &row_node) in nodes.iter().enumerate() {
                    let mut place = None;
                    for (ca, row) in self.numbering[row_node as usize].iter().enumerate() {
                        let Some(row) = row.filter(|&row| row >= column) else { continue };
                        // The rows of a node lie side by side.
                        let at = place
                            .unwrap_or_else(|| start + rows.partition_point(|&other| (other as usize) < row));
                        values[at] += blocks[(a, b)][(ca, cb)];
                        place = Some(at + 1);
                    }
                }
            }
        }
    }
}
