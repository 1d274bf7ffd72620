//! Rows of [`NodalStress`](super::NodalStress), element by element.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::extrapolation::extrapolation;
use crate::gradients::{Gradients, Recovery};
use crate::material::Lame;
use crate::mesh::SectorMesh;

/// Row of the operator: the displacement gradient in x, y, z at a node, summed over the elements of one material around it.
#[derive(Debug)]
pub(super) struct Row {
    /// Node of the gradient.
    pub(super) node: u32,
    /// Lamé's constants of the material.
    pub(super) constants: Lame,
    /// Range of the row's entries in [`Rows::columns`].
    pub(super) entries: std::ops::Range<usize>,
}

/// Incompatible modes of one element.
#[derive(Debug)]
pub(super) struct Bubbles {
    /// Corners of the element.
    pub(super) nodes: [u32; 8],
    /// Recovery of the modes' amplitudes.
    pub(super) recovery: Box<Recovery>,
}

/// All rows, those of a node side by side.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) rows: Vec<Row>,
    /// Columns: nodes; behind the last, three for each of `bubbles`.
    pub(super) columns: Vec<u32>,
    /// Weights of a column's vector in the derivatives in x, y, z.
    pub(super) weights: Vec<[f64; 3]>,
    pub(super) bubbles: Vec<Bubbles>,
    /// Number of elements around each node.
    pub(super) elements: Vec<u32>,
}

impl Rows {
    pub(super) fn of(mesh: &SectorMesh) -> Self {
        let nodes = mesh.nodes.len();
        let mut rows = Self { elements: vec![0; nodes], ..Self::default() };
        // Per node, its place in each element.
        let mut around: Vec<Vec<(u32, u8)>> = vec![Vec::new(); nodes];
        let mut tables = Vec::with_capacity(mesh.elements.len());
        for (e, element) in mesh.elements.iter().enumerate() {
            for (local, &node) in element.nodes.iter().enumerate() {
                rows.elements[node as usize] += 1;
                around[node as usize].push((e as u32, local as u8));
            }
            let gradients = Gradients::of(element.kind, &mesh.positions(element));
            let mut columns = element.nodes.clone();
            if let Ok(corners) = <[u32; 8]>::try_from(&element.nodes[..])
                && element.kind.has_bubbles()
            {
                let first = (nodes + 3 * rows.bubbles.len()) as u32;
                columns.extend(first..first + 3);
                let material = &mesh.sets[element.set as usize].material;
                let recovery = Gradients::recovery(&gradients.elastic(material.lame_constants()));
                rows.bubbles.push(Bubbles { nodes: corners, recovery: Box::new(recovery) });
            }
            let extrapolation = extrapolation(element.kind);
            // At every node, the gradient of every function.
            let table: Vec<Vec<Vector3<f64>>> = (0..element.nodes.len())
                .map(|node| {
                    let mut at_node = vec![Vector3::zeros(); columns.len()];
                    for (point, gradients) in gradients.at_points.iter().enumerate() {
                        let share = extrapolation[(node, point)];
                        for (sum, gradient) in at_node.iter_mut().zip(gradients) {
                            *sum += gradient * share;
                        }
                    }
                    at_node
                })
                .collect();
            tables.push((columns, table));
        }
        let mut slots: HashMap<u32, usize> = HashMap::new();
        for (node, around) in around.iter_mut().enumerate() {
            around.sort_by_key(|&(e, _)| (mesh.elements[e as usize].set, e));
            for same in
                around.chunk_by(|a, b| mesh.elements[a.0 as usize].set == mesh.elements[b.0 as usize].set)
            {
                let first = rows.columns.len();
                slots.clear();
                for &(e, local) in same {
                    let (columns, table) = &tables[e as usize];
                    for (&column, gradient) in columns.iter().zip(&table[usize::from(local)]) {
                        let slot = *slots.entry(column).or_insert_with(|| {
                            rows.columns.push(column);
                            rows.weights.push([0.0; 3]);
                            rows.columns.len() - 1
                        });
                        for (sum, part) in rows.weights[slot].iter_mut().zip(gradient.iter()) {
                            *sum += part;
                        }
                    }
                }
                let set = mesh.elements[same[0].0 as usize].set;
                let constants = mesh.sets[set as usize].material.lame_constants();
                rows.rows.push(Row { node: node as u32, constants, entries: first..rows.columns.len() });
            }
        }
        rows
    }
}
