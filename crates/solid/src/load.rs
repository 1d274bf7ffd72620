//! Loads of a sector's own mass, in (r, θ, z) components of every node of the sector. The load of a high node is added to its low node,
//! whose components it has; its own entry is zero.
//!
//! Loads are `M b` of the consistent mass: the force b on a unit of mass is interpolated like displacement, which is exact where b is
//! linear in the place.

use nalgebra::Vector3;

use crate::frame::AxisFrame;
use crate::gradients::jacobian;
use crate::mesh::SectorMesh;
use crate::rule::fine_points;
use crate::shape::functions;

/// Centrifugal load per unit Ω²: `∫ ρ N_a r e_r dV`.
pub fn centrifugal(mesh: &SectorMesh) -> Vec<[f64; 3]> {
    inertial(mesh, |axis, from_axis| from_axis - axis * from_axis.dot(&axis))
}

/// Euler load per unit Ω̇: `−∫ ρ N_a r e_θ dV`.
pub fn euler(mesh: &SectorMesh) -> Vec<[f64; 3]> {
    inertial(mesh, |axis, from_axis| from_axis.cross(&axis))
}

/// Load `∫ ρ N_a b dV`: `felt` gives the force b on a unit of mass from the direction of the axis and the place seen from a point on it.
fn inertial(mesh: &SectorMesh, felt: impl Fn(Vector3<f64>, Vector3<f64>) -> Vector3<f64>) -> Vec<[f64; 3]> {
    let Some(axis) = AxisFrame::new(mesh.axis.0, mesh.axis.1) else {
        return vec![[0.0; 3]; mesh.nodes.len()];
    };
    let direction = axis.direction();
    let origin = Vector3::from(mesh.axis.0);
    let mut forces = vec![Vector3::zeros(); mesh.nodes.len()];
    for element in &mesh.elements {
        let density = mesh.sets[element.set as usize].material.density;
        let positions = mesh.positions(element);
        for point in fine_points(element.kind) {
            let shares = functions(element.kind, point.xi);
            let at: Vector3<f64> =
                positions.iter().zip(&shares).map(|(&x, share)| Vector3::from(x) * *share).sum();
            let felt = felt(direction, at - origin);
            let mass = density * jacobian(element.kind, &positions, point.xi).determinant() * point.weight;
            for (&node, share) in element.nodes.iter().zip(&shares) {
                forces[node as usize] += felt * (mass * share);
            }
        }
    }
    let local = |(node, force): (usize, &Vector3<f64>)| {
        let [_, theta, _] = axis.coordinates(mesh.nodes[node]);
        axis.cylindrical(theta) * force
    };
    let mut load: Vec<Vector3<f64>> = forces.iter().enumerate().map(local).collect();
    for &(low, high) in &mesh.cyclic {
        let of_high = std::mem::take(&mut load[high as usize]);
        load[low as usize] += of_high;
    }
    load.into_iter().map(Into::into).collect()
}

/// Volume of every element.
pub fn volumes(mesh: &SectorMesh) -> Vec<f64> {
    let volume = |element: &crate::mesh::Element| {
        let positions = mesh.positions(element);
        let part = |point: &crate::gauss::GaussPoint| {
            jacobian(element.kind, &positions, point.xi).determinant() * point.weight
        };
        fine_points(element.kind).iter().map(part).sum()
    };
    mesh.elements.iter().map(volume).collect()
}
