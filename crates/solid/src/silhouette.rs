//! Silhouette of a sector: the outline of its area in the meridional plane.
//!
//! The skin is turned into one plane and painted on a grid; the border of what is painted is straightened, and its corners are moved to the
//! nearest node, so that straight walls of the mesh are straight and lie where the mesh has them.

use std::collections::BTreeMap;

use crate::frame::AxisFrame;
use crate::mesh::SectorMesh;
use crate::skin::{Cut, SkinFace, skin};

/// Point of the meridional plane: axial coordinate and radius.
pub type Point = [f64; 2];

/// Corner of the grid.
type Corner = (i32, i32);

/// Cells along the longer side of the area.
const CELLS: f64 = 1400.0;

/// Distance from a straight line, in cells, within which a border is straight.
const STRAIGHT: f64 = 1.1;

/// Distance, in cells, within which a corner moves to a node.
const NEAR: f64 = 2.0;

/// Closed lines `[z, r]`, counter-clockwise around areas and clockwise around holes in them.
pub type Outline = Vec<Vec<Point>>;

/// Outlines of a sector that is turned into one plane: of all its elements, and of its low cyclic face, which is the wheel without what stands on
/// it. Both are empty for a mesh without an axis or an extent.
pub fn silhouette(mesh: &SectorMesh) -> [Outline; 2] {
    let Some(frame) = AxisFrame::new(mesh.axis.0, mesh.axis.1) else { return Default::default() };
    let place = |node: u32| {
        let [r, _, z] = frame.coordinates(mesh.nodes[node as usize]);
        [z, r]
    };
    let polygon = |face: &SkinFace| -> Vec<Point> {
        let (corners, middles) = face.nodes.split_at(face.corners);
        let behind = |k: usize| middles.get(k).copied();
        let ring = corners.iter().enumerate().flat_map(|(k, &node)| [Some(node), behind(k)]);
        ring.flatten().map(place).collect()
    };
    // Faces on cuts count: where the wheel is a full ring, nothing else bounds it.
    let faces = skin(mesh).faces;
    let low = faces.iter().filter(|face| face.cut == Some(Cut::Low));
    [outline(&faces.iter().map(polygon).collect::<Vec<_>>()), outline(&low.map(polygon).collect::<Vec<_>>())]
}

/// Closed lines around the union of polygons.
fn outline(faces: &[Vec<Point>]) -> Outline {
    let Some(grid) = Grid::about(faces) else { return Vec::new() };
    let mut nodes: Vec<Point> = faces.iter().flatten().map(|&point| grid.place(point)).collect();
    nodes.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    nodes.dedup();
    let painted = grid.paint(faces);
    let rings = borders(&grid, &painted).into_iter().map(|ring| {
        let corners =
            straightened(&ring.iter().map(|&(x, y)| [f64::from(x), f64::from(y)]).collect::<Vec<_>>());
        let mut ring: Vec<Point> =
            corners.into_iter().map(|corner| grid.point(snapped(corner, &nodes))).collect();
        ring.dedup();
        ring
    });
    rings.filter(|ring| ring.len() > 2).collect()
}

/// Grid of square cells over an area.
struct Grid {
    origin: Point,
    cell: f64,
    wide: usize,
    high: usize,
}

impl Grid {
    /// Grid about all corners of polygons, with a free cell around them.
    fn about(faces: &[Vec<Point>]) -> Option<Self> {
        let [x, y] = [0, 1].map(|axis| {
            let values = faces.iter().flatten().map(|point| point[axis]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)))
        });
        let cell = f64::max(x.1 - x.0, y.1 - y.0) / CELLS;
        if !(cell.is_finite() && cell > 0.0) {
            return None;
        }
        let cells = |(low, high): (f64, f64)| ((high - low) / cell).ceil() as usize + 2;
        Some(Self { origin: [x.0 - cell, y.0 - cell], cell, wide: cells(x), high: cells(y) })
    }

    /// Coordinates in cells.
    fn place(&self, point: Point) -> Point {
        [0, 1].map(|axis| (point[axis] - self.origin[axis]) / self.cell)
    }

    /// Coordinates in lengths.
    fn point(&self, place: Point) -> Point {
        [0, 1].map(|axis| self.origin[axis] + self.cell * place[axis])
    }

    /// Cells whose middle lies in a polygon.
    fn paint(&self, faces: &[Vec<Point>]) -> Vec<bool> {
        let mut painted = vec![false; self.wide * self.high];
        for face in faces {
            let corners: Vec<Point> = face.iter().map(|&point| self.place(point)).collect();
            for k in 2..corners.len() {
                self.fill([corners[0], corners[k - 1], corners[k]], &mut painted);
            }
        }
        painted
    }

    /// Paints the cells whose middle lies in a triangle, row by row.
    fn fill(&self, corners: [Point; 3], painted: &mut [bool]) {
        let ends =
            corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[1]), b.max(p[1])));
        for row in (ends.0 - 0.5).ceil().max(0.0) as usize..=(ends.1 - 0.5).floor().max(0.0) as usize {
            let y = row as f64 + 0.5;
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if (a[1] <= y) == (b[1] <= y) {
                    continue;
                }
                let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                (from, to) = (from.min(x), to.max(x));
            }
            if from <= to && row < self.high {
                let columns =
                    (from - 0.5).ceil().max(0.0) as usize..((to - 0.5).floor() + 1.0).max(0.0) as usize;
                let columns = columns.start.min(self.wide)..columns.end.min(self.wide);
                painted[row * self.wide..][columns].fill(true);
            }
        }
    }
}

/// Closed lines along the sides of cells between what is painted and what is not, with the painted cells at their left.
fn borders(grid: &Grid, painted: &[bool]) -> Vec<Vec<Corner>> {
    let is_painted = |x: i32, y: i32| {
        let inside = x >= 0 && y >= 0 && (x as usize) < grid.wide && (y as usize) < grid.high;
        inside && painted[y as usize * grid.wide + x as usize]
    };
    let mut onward: BTreeMap<Corner, Vec<Corner>> = BTreeMap::new();
    for y in 0..grid.high as i32 {
        for x in 0..grid.wide as i32 {
            if !is_painted(x, y) {
                continue;
            }
            let sides = [
                ((x, y - 1), (x, y), (x + 1, y)),
                ((x + 1, y), (x + 1, y), (x + 1, y + 1)),
                ((x, y + 1), (x + 1, y + 1), (x, y + 1)),
                ((x - 1, y), (x, y + 1), (x, y)),
            ];
            for (beside, from, to) in sides {
                if !is_painted(beside.0, beside.1) {
                    onward.entry(from).or_default().push(to);
                }
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = onward.first_key_value() {
        let mut ring = vec![start];
        let mut at = start;
        while let Some(next) = onward.get_mut(&at).and_then(Vec::pop) {
            if onward.get(&at).is_some_and(Vec::is_empty) {
                onward.remove(&at);
            }
            if next == start {
                break;
            }
            ring.push(next);
            at = next;
        }
        rings.push(ring);
    }
    rings
}

/// Corners of a closed line that are needed to stay near it (Douglas and Peucker, Cartographica 10, 1973).
fn straightened(ring: &[Point]) -> Vec<Point> {
    let far = |from: usize| {
        let away = |k: &usize| f64::hypot(ring[*k][0] - ring[from][0], ring[*k][1] - ring[from][1]);
        (0..ring.len()).max_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(from)
    };
    // Both are corners, as nothing is farther away.
    let first = far(0);
    let turned: Vec<Point> = ring[first..].iter().chain(&ring[..=first]).copied().collect();
    let second = (far(first) + ring.len() - first) % ring.len();
    let mut kept = vec![0, second, turned.len() - 1];
    let mut open = vec![(0, second), (second, turned.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (turned[from], turned[to]);
        let length = f64::hypot(b[0] - a[0], b[1] - a[1]);
        let away =
            |k: usize| ((turned[k][0] - a[0]) * (b[1] - a[1]) - (turned[k][1] - a[1]) * (b[0] - a[0])).abs();
        let farthest = (from + 1..to).max_by(|&j, &k| away(j).total_cmp(&away(k)));
        if let Some(middle) = farthest.filter(|&k| away(k) > STRAIGHT * length) {
            kept.push(middle);
            open.extend([(from, middle), (middle, to)]);
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept.pop();
    kept.into_iter().map(|k| turned[k]).collect()
}

/// Nearest node of a corner, or the corner where none is near; nodes are in the order of their first coordinate.
fn snapped(corner: Point, nodes: &[Point]) -> Point {
    let begin = nodes.partition_point(|node| node[0] < corner[0] - NEAR);
    let near = nodes[begin..].iter().take_while(|node| node[0] <= corner[0] + NEAR);
    let away = |node: &Point| f64::hypot(node[0] - corner[0], node[1] - corner[1]);
    near.filter(|node| away(node) <= NEAR)
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .copied()
        .unwrap_or(corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadrangle(x: (f64, f64), y: (f64, f64)) -> Vec<Point> {
        vec![[x.0, y.0], [x.1, y.0], [x.1, y.1], [x.0, y.1]]
    }

    fn area(ring: &[Point]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        0.5 * ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    }

    /// L of squares of the side 10 and a bar across one of them: six corners where the squares have them, and the exact area.
    #[test]
    fn overlapping_faces_have_one_outline_with_their_own_corners() {
        let faces = [
            quadrangle((0.0, 10.0), (5.0, 15.0)),
            quadrangle((10.0, 20.0), (5.0, 15.0)),
            quadrangle((0.0, 10.0), (15.0, 25.0)),
        ];
        let bar = quadrangle((2.0, 18.0), (7.0, 9.0));
        let rings = outline(&[&faces[..], &[bar]].concat());
        let mut corners = rings.concat();
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let known = [[0.0, 5.0], [0.0, 25.0], [10.0, 15.0], [10.0, 25.0], [20.0, 5.0], [20.0, 15.0]];
        let off = corners.iter().flatten().zip(known.iter().flatten()).map(|(a, b)| (a - b).abs());
        assert!(corners.len() == 6 && off.fold(0.0, f64::max) < 1e-9, "{corners:?}");
        assert!((area(&rings[0]) - 300.0).abs() < 1e-9);
    }

    /// Disc of 60 sides: the area is that of the polygon within half a per mille, and a hole has a line of its own.
    #[test]
    fn curved_borders_are_smooth_and_holes_are_seen() {
        let at = |radius: f64, k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / 60.0).sin_cos();
            [radius * cos, radius * sin]
        };
        let faces: Vec<Vec<Point>> =
            (0..60).map(|k| vec![at(1.0, k), at(3.0, k), at(3.0, k + 1), at(1.0, k + 1)]).collect();
        let mut areas: Vec<f64> = outline(&faces).iter().map(|ring| area(ring)).collect();
        areas.sort_by(f64::total_cmp);
        let polygon = |radius: f64| 30.0 * radius * radius * (std::f64::consts::TAU / 60.0).sin();
        assert_eq!(areas.len(), 2);
        for (found, known) in areas.iter().zip([-polygon(1.0), polygon(3.0)]) {
            assert!((found / known - 1.0).abs() < 1e-3, "{areas:?}");
        }
    }

    #[test]
    fn faces_without_area_have_no_outline() {
        assert!(outline(&[]).is_empty() && outline(&[vec![[1.0, 2.0]; 4]]).is_empty());
        assert!(outline(&[vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]]).is_empty());
    }
}
