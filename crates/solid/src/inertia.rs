//! Volume, mass, centre and moment of inertia of the wheel that a sector's elements make.

use nalgebra::Vector3;

use crate::frame::AxisFrame;
use crate::gradients::jacobian;
use crate::mesh::SectorMesh;
use crate::rule::fine_points;
use crate::shape::functions;

/// Body of a whole wheel, clamped elements included, in the mesh's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelBody {
    /// Volume.
    pub volume: f64,
    /// Mass.
    pub mass: f64,
    /// Distance of the centre of mass from the axis's point, along the axis; of a single sector it may lie off the axis, too.
    pub centre: f64,
    /// Moment of inertia about the axis.
    pub polar_inertia: f64,
}

/// Body of the wheel: N times the integrals over one sector. None if the axis has no direction.
pub fn wheel_body(mesh: &SectorMesh) -> Option<WheelBody> {
    let axis = AxisFrame::new(mesh.axis.0, mesh.axis.1)?;
    let sectors = mesh.sectors as f64;
    let mut body = WheelBody { volume: 0.0, mass: 0.0, centre: 0.0, polar_inertia: 0.0 };
    for element in &mesh.elements {
        let density = mesh.sets[element.set as usize].material.density;
        let positions = mesh.positions(element);
        for point in fine_points(element.kind) {
            let shares = functions(element.kind, point.xi);
            let at: Vector3<f64> =
                positions.iter().zip(&shares).map(|(&x, share)| Vector3::from(x) * *share).sum();
            let [r, _, z] = axis.coordinates(at.into());
            let volume = sectors * jacobian(element.kind, &positions, point.xi).determinant() * point.weight;
            body.volume += volume;
            body.mass += density * volume;
            body.centre += density * volume * z;
            body.polar_inertia += density * volume * r * r;
        }
    }
    body.centre /= body.mass;
    Some(body)
}
