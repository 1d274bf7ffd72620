//! Thickness of a blade at its tip: from side to side of the mesh, across the contact line.

use nalgebra::Vector3;

use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::skin::skin;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Depth below the tip at which the thickness is measured, in distances of neighbouring contact nodes: not on the edge, and not so deep
/// that a leaning blade is off the normal.
const BELOW: f64 = 0.02;

/// Distance of the blade from the point below a contact node, in distances of neighbouring contact nodes, up to which the node belongs to
/// that blade: a line on an edge of the tip may lie outside a flank that leans or bends.
const BESIDE: f64 = 0.1;

/// Shortest length through material that is not the round-off of a ray that grazes an edge, in distances of neighbouring contact nodes.
const GRAZE: f64 = 1e-6;

/// Smallest thickness over the contact nodes, without the first and the last, which stand on the ends of the blade: the length through the
/// material along the line across the contact line and the normal, wherever on the tip the contact line runs, its edges included. `None`
/// with fewer than three contact nodes, or where no such line passes through the mesh.
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
    let thickness = |k: usize, node: &ContactNode| {
        let (before, after) = (line[k - 1], line[k + 1]);
        let spacing = 0.5 * (after - before).norm();
        let [_, theta, _] = frame.coordinates(line[k].into());
        let normal = frame.cylindrical(theta).transpose() * Vector3::from(node.normal);
        let across = normal.cross(&(after - before)).try_normalize(0.0)?;
        let from = line[k] - normal * (BELOW * spacing);
        through(from, across, &triangles, spacing)
    };
    let inner = 1..line.len().saturating_sub(1);
    inner.filter_map(|k| thickness(k, &contact[k])).reduce(f64::min)
}

/// Length through material along the line through `from` in the direction of the unit vector `across`, at `from` or nearest to it; `None`
/// if no material is within [`BESIDE`] of it. `triangles` are the skin, counter-clockwise seen from outside.
fn through(
    from: Vector3<f64>,
    across: Vector3<f64>,
    triangles: &[[Vector3<f64>; 3]],
    spacing: f64,
) -> Option<f64> {
    let mut crossings: Vec<Crossing> =
        triangles.iter().filter_map(|triangle| crossing(from, across, triangle)).collect();
    crossings.sort_by(|a, b| a.at.total_cmp(&b.at));
    // A face that is cut along an edge of two triangles is crossed twice at one place.
    let inside = crossings.windows(2).filter(|pair| pair[0].enters && !pair[1].enters);
    let inside =
        inside.map(|pair| (pair[0].at, pair[1].at)).filter(|(enter, leave)| leave - enter > GRAZE * spacing);
    let away = |(enter, leave): (f64, f64)| enter.max(-leave).max(0.0);
    let (enter, leave) = inside.min_by(|a, b| away(*a).total_cmp(&away(*b)))?;
    (away((enter, leave)) <= BESIDE * spacing).then_some(leave - enter)
}

/// Point where a line passes through the skin.
struct Crossing {
    /// Distance from the line's origin, negative behind it.
    at: f64,
    /// Whether the line enters the material there.
    enters: bool,
}

/// Crossing of a triangle by the line through `from` along the unit vector `way` (Möller and Trumbore 1997); its edges belong to it.
fn crossing(from: Vector3<f64>, way: Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> Option<Crossing> {
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
    // The volume is −way·(ab × ac): positive where the line comes from outside.
    let crossing = Crossing { at: ac.dot(&across) / volume, enters: volume > 0.0 };
    (u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE).then_some(crossing)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Skin of a plate between x = 0 and x = `thickness`, wide in y and z.
    fn plate(thickness: f64) -> Vec<[Vector3<f64>; 3]> {
        let corner = |x, y, z| Vector3::new(x, y, z);
        let side =
            |x| [corner(x, -9.0, -9.0), corner(x, 9.0, -9.0), corner(x, 9.0, 9.0), corner(x, -9.0, 9.0)];
        let (near, far) = (side(0.0), side(thickness));
        vec![
            [near[0], near[2], near[1]],
            [near[0], near[3], near[2]],
            [far[0], far[1], far[2]],
            [far[0], far[2], far[3]],
        ]
    }

    #[test]
    fn a_plate_is_as_thick_from_inside_from_its_flanks_and_from_just_beside() {
        let skin = plate(0.7);
        for x in [0.35, 0.1, 0.0, 0.7, -0.05, 0.75] {
            for way in [Vector3::x(), -Vector3::x()] {
                // On the diagonal that both triangles of a side share, and off it.
                for y in [0.0, 0.3] {
                    let found = through(Vector3::new(x, y, 0.0), way, &skin, 1.0).unwrap();
                    assert!((found - 0.7).abs() < 1e-15, "{x} {y}: {found}");
                }
            }
        }
        assert_eq!(through(Vector3::new(-0.2, 0.0, 0.0), Vector3::x(), &skin, 1.0), None);
        assert_eq!(through(Vector3::zeros(), Vector3::y(), &skin, 1.0), None);
    }
}
