//! Stress at nodes, averaged over the elements around them.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::{Mat, MatRef, c64};
use nalgebra::Matrix3;

use super::build::{Bubbles, Row, Rows};
use crate::frame::AxisFrame;
use crate::material::Lame;
use crate::mesh::SectorMesh;

/// Columns computed at once, real and imaginary parts beside each other: nine derivatives of this many fit into registers.
const COLUMNS: usize = 2;

/// Real and imaginary parts of a number in each of the columns.
type Lanes = [f64; 2 * COLUMNS];

/// A gradient or a vector of nodal values in each of the columns.
type Vectors = [Lanes; 3];

/// Linear operator from the displacements of a sector's nodes to stress at its nodes.
///
/// Displacement gradients of each element are carried from its integration points to its nodes ([`crate::extrapolation`]), made stress by
/// the element's own material, and averaged over all elements around the node, whatever their material, as CalculiX does; unlike CalculiX,
/// across the cyclic faces and around the axis too. Stress jumps between materials are averaged away.
#[derive(Debug)]
pub struct NodalStress {
    nodes: usize,
    /// Cylindrical unit vectors at each node.
    frames: Vec<Matrix3<f64>>,
    /// Pairs of low and high node.
    cyclic: Vec<(u32, u32)>,
    /// Nodes at which there is stress, as indices in the mesh's nodes.
    places: Vec<u32>,
    /// Indices of the places on the axis, where the elements of all sectors meet.
    on_axis: Vec<usize>,
    sectors: usize,
    /// Rows of each place, those of its high node, and one over the number of elements around both.
    parts: Vec<(Range<usize>, Range<usize>, f64)>,
    rows: Vec<Row>,
    columns: Vec<u32>,
    weights: Vec<[f64; 3]>,
    bubbles: Vec<Bubbles>,
}

impl NodalStress {
    /// The operator of a mesh, about 40 bytes for each pair of a node and another that shares an element with it.
    pub fn new(mesh: &SectorMesh) -> Self {
        let Rows { rows, columns, mut weights, bubbles, elements } = Rows::of(mesh);
        let nodes = mesh.nodes.len();
        let frames: Vec<Matrix3<f64>> = match AxisFrame::new(mesh.axis.0, mesh.axis.1) {
            Some(axis) => mesh.nodes.iter().map(|&at| axis.cylindrical(axis.coordinates(at)[1])).collect(),
            None => vec![Matrix3::identity(); nodes],
        };
        for row in &rows {
            let frame = &frames[row.node as usize];
            for weight in &mut weights[row.entries.clone()] {
                *weight = (frame * nalgebra::Vector3::from(*weight)).into();
            }
        }
        let mut of_node = vec![0..0; nodes];
        let mut first = 0;
        for rows in rows.chunk_by(|a, b| a.node == b.node) {
            of_node[rows[0].node as usize] = first..first + rows.len();
            first += rows.len();
        }
        let mut high_of = vec![None; nodes];
        let mut is_high = vec![false; nodes];
        for &(low, high) in &mesh.cyclic {
            high_of[low as usize] = Some(high as usize);
            is_high[high as usize] = true;
        }
        let (mut places, mut parts) = (Vec::new(), Vec::new());
        for node in (0..nodes).filter(|&node| !is_high[node]) {
            let high = high_of[node];
            let around = elements[node] + high.map_or(0, |high| elements[high]);
            if around > 0 {
                let of_high = high.map_or(0..0, |high| of_node[high].clone());
                places.push(node as u32);
                parts.push((of_node[node].clone(), of_high, 1.0 / f64::from(around)));
            }
        }
        let axis = mesh.on_axis();
        let on_axis = (0..places.len()).filter(|&place| axis[places[place] as usize]).collect();
        let (cyclic, sectors) = (mesh.cyclic.clone(), mesh.sectors);
        Self { nodes, frames, cyclic, places, on_axis, sectors, parts, rows, columns, weights, bubbles }
    }

    /// Nodes at which there is stress: those of elements, but for the high face. Places in [`SectorMesh::nodes`].
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Stress of displacements.
    ///
    /// `u` is `3·nodes × columns`: (r, θ, z) components at every node of the sector. Rows of high nodes are ignored: they are
    /// `phase` times those of their low nodes, `phase` = `e^{jiα}` for nodal diameter i. The result is `6·places × columns`:
    /// σ_rr, σ_θθ, σ_zz, σ_rθ, σ_θz, σ_zr.
    ///
    /// # Panics
    /// If `u` has another number of rows.
    pub fn apply(&self, phase: c64, u: MatRef<'_, c64>) -> Mat<c64> {
        assert_eq!(u.nrows(), 3 * self.nodes, "three rows a node");
        let mut stress = Mat::zeros(6 * self.places.len(), u.ncols());
        let mut values = vec![[[0.0; 2 * COLUMNS]; 3]; self.nodes + 3 * self.bubbles.len()];
        for first in (0..u.ncols()).step_by(COLUMNS) {
            let count = COLUMNS.min(u.ncols() - first);
            self.cartesian(phase, u.subcols(first, count), &mut values);
            for (place, (low, high, share)) in self.parts.iter().enumerate() {
                let of_low = self.sum(&self.rows[low.clone()], &values);
                let of_high = self.sum(&self.rows[high.clone()], &values);
                for component in 0..6 {
                    let (low, high) = (&of_low[component], &of_high[component]);
                    for column in 0..count {
                        let part = |lanes: &Lanes| c64::new(lanes[column], lanes[COLUMNS + column]);
                        // The elements at the high node are those of the sector before, at this node.
                        let sum = part(low) + phase.conj() * part(high);
                        stress[(6 * place + component, first + column)] = sum * *share;
                    }
                }
            }
        }
        for &place in &self.on_axis {
            for column in 0..u.ncols() {
                let own = std::array::from_fn(|component| stress[(6 * place + component, column)]);
                let mean = around_axis(own, phase, self.sectors);
                mean.iter().enumerate().for_each(|(k, mean)| stress[(6 * place + k, column)] = *mean);
            }
        }
        stress
    }

    /// Displacements in x, y, z of all nodes, and the amplitudes of incompatible modes.
    fn cartesian(&self, phase: c64, u: MatRef<'_, c64>, values: &mut [Vectors]) {
        let mut set = |node: usize, from: usize, factor: c64| {
            let frame = &self.frames[node];
            let mut vectors = [[0.0; 2 * COLUMNS]; 3];
            for column in 0..u.ncols() {
                let local: [c64; 3] = std::array::from_fn(|k| factor * u[(3 * from + k, column)]);
                for (d, lanes) in vectors.iter_mut().enumerate() {
                    let value: c64 = (0..3).map(|k| local[k] * frame[(k, d)]).sum();
                    (lanes[column], lanes[COLUMNS + column]) = (value.re, value.im);
                }
            }
            values[node] = vectors;
        };
        (0..self.nodes).for_each(|node| set(node, node, c64::new(1.0, 0.0)));
        for &(low, high) in &self.cyclic {
            set(high as usize, low as usize, phase);
        }
        for (k, element) in self.bubbles.iter().enumerate() {
            for bubble in 0..3 {
                let mut amplitude = [[0.0; 2 * COLUMNS]; 3];
                for (d, lanes) in amplitude.iter_mut().enumerate() {
                    for (a, &node) in element.nodes.iter().enumerate() {
                        for (component, displacement) in values[node as usize].iter().enumerate() {
                            let factor = element.recovery[(3 * bubble + d, 3 * a + component)];
                            add(lanes, factor, displacement);
                        }
                    }
                }
                values[self.nodes + 3 * k + bubble] = amplitude;
            }
        }
    }

    /// Sum of the stresses of some rows of one node, in its (r, θ, z).
    fn sum(&self, rows: &[Row], values: &[Vectors]) -> [Lanes; 6] {
        let mut sum = [[0.0; 2 * COLUMNS]; 6];
        for row in rows {
            // Derivatives in r, θ, z (outer) of displacements in x, y, z.
            let mut gradient = [[[0.0; 2 * COLUMNS]; 3]; 3];
            for (&column, weight) in
                self.columns[row.entries.clone()].iter().zip(&self.weights[row.entries.clone()])
            {
                let value = &values[column as usize];
                for (derivatives, factor) in gradient.iter_mut().zip(weight) {
                    for (lanes, displacement) in derivatives.iter_mut().zip(value) {
                        add(lanes, *factor, displacement);
                    }
                }
            }
            let frame = &self.frames[row.node as usize];
            // h_ij = ∂u_i/∂x_j.
            let h = |i: usize, j: usize| {
                let mut lanes = [0.0; 2 * COLUMNS];
                (0..3).for_each(|k| add(&mut lanes, frame[(i, k)], &gradient[j][k]));
                lanes
            };
            let Lame { lambda, mu } = row.constants;
            let normal: [Lanes; 3] = std::array::from_fn(|i| h(i, i));
            for (i, sum) in sum.iter_mut().take(3).enumerate() {
                normal.iter().for_each(|strain| add(sum, lambda, strain));
                add(sum, 2.0 * mu, &normal[i]);
            }
            for (sum, (i, j)) in sum[3..].iter_mut().zip([(0, 1), (1, 2), (2, 0)]) {
                add(sum, mu, &h(i, j));
                add(sum, mu, &h(j, i));
            }
        }
        sum
    }
}

/// Mean at the axis of the stress of all sectors, in the components of the first one, whose stress is `own`: that of sector s is the same turned
/// by sα about z, times `phase` to the power of s.
fn around_axis(own: [c64; 6], phase: c64, sectors: usize) -> [c64; 6] {
    let [rr, tt, zz, rt, tz, zr] = own;
    // Half the difference and the shear turn by twice the angle.
    let (half_sum, half_difference) = ((rr + tt) * 0.5, (rr - tt) * 0.5);
    let mut mean = [c64::ZERO; 6];
    for s in 0..sectors {
        let angle = TAU * s as f64 / sectors as f64;
        let ((sin, cos), (sin2, cos2)) = (angle.sin_cos(), (2.0 * angle).sin_cos());
        let difference = half_difference * cos2 - rt * sin2;
        let turned = [
            half_sum + difference,
            half_sum - difference,
            zz,
            half_difference * sin2 + rt * cos2,
            zr * sin + tz * cos,
            zr * cos - tz * sin,
        ];
        let factor = phase.powi(s as i32) / sectors as f64;
        mean.iter_mut().zip(turned).for_each(|(mean, turned)| *mean += turned * factor);
    }
    mean
}

/// Adds `factor · value` to `sum`.
#[inline]
fn add(sum: &mut Lanes, factor: f64, value: &Lanes) {
    for (sum, value) in sum.iter_mut().zip(value) {
        *sum += factor * value;
    }
}
