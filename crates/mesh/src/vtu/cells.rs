//! Cells of VTK and the elements that they are.

use rubmap_solid::element::ElementKind;

use crate::collapse::collapsed;
use crate::error::MeshProblem;
use crate::mesh_file::MeshFile;

/// Fate of the cells of a type.
enum Fate {
    /// Solid element.
    Solid(ElementKind),
    /// Point, line or surface.
    LeftOut(&'static str),
    /// Solid that rubmap lacks.
    Refused,
}

/// Name of the array, for errors.
pub(super) const CARD: &str = "Cells";
/// Places of VTK's nodes in the order of CalculiX for a voxel, whose nodes are numbered along x, then y, then z.
const VOXEL: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];
/// Places of VTK's nodes for a wedge: VTK sees its first triangle from outside, CalculiX from inside.
const WEDGE: [usize; 15] = [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13];
/// Number of a voxel.
const VOXEL_TYPE: i64 = 11;

/// Fate of a cell by VTK's number of its type.
fn fate(number: i64) -> Fate {
    use ElementKind::{C3D4, C3D5, C3D6, C3D8I, C3D10, C3D13, C3D15, C3D20};
    Fate::Solid(match number {
        10 => C3D4,
        VOXEL_TYPE | 12 => C3D8I,
        13 => C3D6,
        14 => C3D5,
        24 => C3D10,
        25 => C3D20,
        26 => C3D15,
        27 => C3D13,
        1 => return Fate::LeftOut("vertex"),
        2 => return Fate::LeftOut("vertices"),
        3 => return Fate::LeftOut("line"),
        4 => return Fate::LeftOut("polyline"),
        5 => return Fate::LeftOut("triangle"),
        6 => return Fate::LeftOut("triangle strip"),
        7 => return Fate::LeftOut("polygon"),
        8 => return Fate::LeftOut("pixel"),
        9 => return Fate::LeftOut("quadrilateral"),
        21 | 35 => return Fate::LeftOut("curved line"),
        22 | 34 => return Fate::LeftOut("quadratic triangle"),
        23 | 28 | 30 => return Fate::LeftOut("quadratic quadrilateral"),
        36 => return Fate::LeftOut("quadratic polygon"),
        _ => return Fate::Refused,
    })
}

/// Name of a type of cells without a counterpart.
fn name(number: i64) -> String {
    let name = match number {
        29 => "hexahedra of 27 nodes",
        31 => "wedges of 12 nodes",
        32 => "wedges of 18 nodes",
        33 => "hexahedra of 24 nodes",
        37 => "pyramids of 19 nodes",
        41 | 42 => "polyhedra",
        69..=81 => "elements of higher order",
        _ => return format!("cells of type {number}"),
    };
    format!("{name} (cell type {number})")
}

/// Kind of a cell and its points in CalculiX's order; none if it is left out.
pub(super) fn solid(
    (id, number): (u64, i64),
    cell: &[i64],
    positions: &[[f64; 3]],
    mesh: &mut MeshFile,
) -> Result<Option<(ElementKind, Vec<u64>)>, MeshProblem> {
    let kind = match fate(number) {
        Fate::Solid(kind) => kind,
        Fate::LeftOut(name) => {
            mesh.leave_out(name);
            return Ok(None);
        }
        Fate::Refused => {
            let advice = "mesh with tetrahedra, pyramids, wedges or hexahedra that are linear or have mid-edge nodes only";
            return Err(MeshProblem::NotCarried { what: name(number), advice });
        }
    };
    if cell.len() != kind.nodes() {
        let expected = format!("{} points of cell {id} ({})", kind.nodes(), kind.name());
        return Err(MeshProblem::Expected { expected });
    }
    let mut points = Vec::with_capacity(cell.len());
    for &point in cell {
        let there = u64::try_from(point).ok().filter(|&point| point < positions.len() as u64);
        points.push(there.ok_or_else(|| MeshProblem::Expected {
            expected: format!(
                "a point from 0 to {} in cell {id}, and not {point}",
                positions.len().saturating_sub(1)
            ),
        })?);
    }
    if number == VOXEL_TYPE {
        points = ordered(&points, &VOXEL);
    }
    match kind.corners() {
        6 => Ok(Some((kind, wedge(points, positions)))),
        8 => {
            let (kind, points) = collapsed(kind, &points).ok_or(MeshProblem::Collapsed { element: id })?;
            if kind == ElementKind::C3D8I {
                mesh.note("hexahedra of 8 nodes are read as C3D8I: with incompatible modes".to_owned());
            }
            Ok(Some((kind, points)))
        }
        _ => Ok(Some((kind, points))),
    }
}

/// Points in another order.
fn ordered(points: &[u64], places: &[usize]) -> Vec<u64> {
    places.iter().filter_map(|&place| points.get(place).copied()).collect()
}

/// Points of a wedge in CalculiX's order. Some programs write that order into their files, others VTK's: the volume shows which.
fn wedge(points: Vec<u64>, positions: &[[f64; 3]]) -> Vec<u64> {
    let turned = ordered(&points, &WEDGE);
    let corners: Vec<[f64; 3]> = turned
        .iter()
        .take(6)
        .filter_map(|&point| positions.get(usize::try_from(point).ok()?).copied())
        .collect();
    if volume(&corners) < 0.0 { points } else { turned }
}

/// Sign of a wedge's volume: the sum of its triangles' area vectors, times the way between their centres.
fn volume(corners: &[[f64; 3]]) -> f64 {
    let &[a, b, c, d, e, f] = corners else { return 0.0 };
    let minus = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| p[k] - q[k]) };
    let cross = |[x, y, z]: [f64; 3], [u, v, w]: [f64; 3]| [y * w - z * v, z * u - x * w, x * v - y * u];
    let (first, second) = (cross(minus(b, a), minus(c, a)), cross(minus(e, d), minus(f, d)));
    (0..3).map(|k| (first[k] + second[k]) * (d[k] + e[k] + f[k] - a[k] - b[k] - c[k])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_wedges_is_that_of_our_own_files() {
        let places: Vec<u64> = (0..15).collect();
        let vtk = ordered(&places, &WEDGE);
        assert_eq!(ordered(&vtk, &WEDGE), places);
    }
}
