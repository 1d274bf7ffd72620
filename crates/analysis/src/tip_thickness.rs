//! How thick a blade is at its tip: from side to side of the mesh, across the contact line.

use nalgebra::Vector3;

use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::skin::skin;
use rubmap_wheel::dynamics::sector::ContactNode;

/// How far below the tip it is measured, in distances of neighbouring contact nodes: the edge itself may be round.
const BELOW: f64 = 0.25;

/// The smallest over all contact nodes of the way through the blade along the line across the contact line and the normal; none with a
/// single contact node, or where no such line leaves the mesh.
pub(super) fn tip_thickness(mesh: &SectorMesh, contact: &[ContactNode]) -> Option<f64> {
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1)?;
    let position = |node: &ContactNode| {
        let place = mesh.node_ids.iter().position(|&id| id == node.id)?;
        Some(Vector3::from(mesh.nodes[place]))
    };
    let line: Vec<Vector3<f64>> = contact.iter().map(position).collect::<Option<_>>()?;
    let at = |node: u32| Vector3::from(mesh.nodes[node as usize]);
    let skin = skin(mesh);
    let triangles: Vec<[Vector3<f64>; 3]> = (skin.faces.iter())
        .flat_map(|face| {
            let corners = &face.nodes[..face.corners];
            (2..corners.len()).map(|k| [at(corners[0]), at(corners[k - 1]), at(corners[k])])
        })
        .collect();
    let thickness = |(k, node): (usize, &ContactNode)| {
        let (before, after) = (line[k.saturating_sub(1)], line[(k + 1).min(line.len() - 1)]);
        let spacing = (after - before).norm() / if k == 0 || k + 1 == line.len() { 1.0 } else { 2.0 };
        let [_, theta, _] = frame.coordinates(line[k].into());
        let normal = frame.cylindrical(theta).transpose() * Vector3::from(node.normal);
        let across = normal.cross(&(after - before)).try_normalize(0.0)?;
        let from = line[k] - normal * (BELOW * spacing);
        let leaves = |way: Vector3<f64>| {
            triangles.iter().filter_map(|triangle| hit(from, way, triangle)).reduce(f64::min)
        };
        match (leaves(across), leaves(-across)) {
            (None, None) => None,
            // A node on one side of the blade.
            (there, back) => Some(there.unwrap_or(0.0) + back.unwrap_or(0.0)),
        }
    };
    line.len().checked_sub(2)?;
    contact.iter().enumerate().filter_map(thickness).reduce(f64::min)
}

/// How far along the unit vector `way` a triangle lies (Möller and Trumbore 1997); its edges belong to it.
fn hit(from: Vector3<f64>, way: Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> Option<f64> {
    const EDGE: f64 = 1e-9;
    let (ab, ac) = (b - a, c - a);
    let normal = way.cross(&ac);
    let volume = ab.dot(&normal);
    if volume.abs() <= f64::EPSILON * ab.norm() * ac.norm() {
        return None;
    }
    let to = from - a;
    let u = to.dot(&normal) / volume;
    let across = to.cross(&ab);
    let v = way.dot(&across) / volume;
    let distance = ac.dot(&across) / volume;
    let size = ab.norm() + ac.norm();
    (u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE && distance > -EDGE * size).then(|| distance.max(0.0))
}
