//! Forces on a sector's nodes under uniform strain, and their mass: the same for all formulations that pass a patch test, and so a check of
//! matrices of unknown origin.

use nalgebra::{Matrix3, Vector3};

use crate::frame::AxisFrame;
use crate::gradients::Gradients;
use crate::material::{stress, tensor};
use crate::mesh::SectorMesh;
use crate::rule::fine_points;
use crate::shape::functions;

/// Forces on each node of a sector under uniform strain, in (r, θ, z) components, and its mass. Values of a high node are added to its low
/// node; its own are zero.
#[derive(Debug, Clone)]
pub struct UniformStrain {
    /// Forces under the displacement `u = (r, 0, −2z)`, a strain of shape without volume: in proportion to E/(1 + ν).
    pub of_shape: Vec<Vector3<f64>>,
    /// Forces under `u = (r, 0, z)`, a strain of volume without shape: in proportion to E/(1 − 2ν).
    pub of_volume: Vec<Vector3<f64>>,
    /// Magnitudes of the forces of single elements on each node, added without their directions: the size against which `of_shape` and
    /// `of_volume` are small where forces of neighbours are in balance.
    pub unbalanced: [Vec<f64>; 2],
    /// Row sums of the consistent mass.
    pub mass: Vec<f64>,
}

/// Displacement in (r, θ, z) components under both strains, in the order of [`UniformStrain`].
pub fn displacements([r, _, z]: [f64; 3]) -> [[f64; 3]; 2] {
    [[r, 0.0, -2.0 * z], [r, 0.0, z]]
}

/// Computes the forces under uniform strain and the mass in one pass over the elements; none if the axis has no direction.
pub fn uniform_strain(mesh: &SectorMesh) -> Option<UniformStrain> {
    let axis = AxisFrame::new(mesh.axis.0, mesh.axis.1)?;
    let direction = axis.direction();
    let gradients = [Matrix3::identity() - direction * direction.transpose() * 3.0, Matrix3::identity()];
    let nodes = mesh.nodes.len();
    let mut forces = [(); 2].map(|()| vec![Vector3::zeros(); nodes]);
    let mut unbalanced = [(); 2].map(|()| vec![0.0; nodes]);
    let mut mass = vec![0.0; nodes];
    for element in &mesh.elements {
        let material = &mesh.sets[element.set as usize].material;
        let stresses = gradients.map(|gradient| tensor(&stress(material.lame_constants(), &gradient)));
        let positions = mesh.positions(element);
        let of_element = Gradients::of(element.kind, &positions);
        for (local, &node) in element.nodes.iter().enumerate() {
            let node = node as usize;
            let area = of_element.integral(local);
            for ((stress, forces), unbalanced) in stresses.iter().zip(&mut forces).zip(&mut unbalanced) {
                let force = stress * area;
                forces[node] += force;
                unbalanced[node] += force.norm();
            }
        }
        for point in fine_points(element.kind) {
            let determinant = crate::gradients::jacobian(element.kind, &positions, point.xi).determinant();
            let share = material.density * determinant * point.weight;
            for (&node, value) in element.nodes.iter().zip(functions(element.kind, point.xi)) {
                mass[node as usize] += share * value;
            }
        }
    }
    for forces in &mut forces {
        for (force, &position) in forces.iter_mut().zip(&mesh.nodes) {
            let [_, theta, _] = axis.coordinates(position);
            *force = axis.cylindrical(theta) * *force;
        }
        fold(forces, &mesh.cyclic);
    }
    unbalanced.iter_mut().for_each(|unbalanced| fold(unbalanced, &mesh.cyclic));
    fold(&mut mass, &mesh.cyclic);
    let [of_shape, of_volume] = forces;
    Some(UniformStrain { of_shape, of_volume, unbalanced, mass })
}

/// Adds the values of high nodes to those of their low nodes.
fn fold<T: Default + std::ops::AddAssign>(values: &mut [T], cyclic: &[(u32, u32)]) {
    for &(low, high) in cyclic {
        let of_high = std::mem::take(&mut values[high as usize]);
        values[low as usize] += of_high;
    }
}
