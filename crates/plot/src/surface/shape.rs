//! Faces as they are drawn: their light, and the edges that show the shape.

use std::collections::BTreeMap;

use rubmap_analysis::result::FieldSurface;

use super::depths::{Corner, Depths};

/// Cosine of the angle between two faces below which they meet in an edge and not in a bend: cos 35°.
const EDGE: f64 = 0.82;

/// Surface in pixels.
pub(super) struct Shape<'a> {
    /// Positions of the nodes in pixels: to the right, down, and towards the viewer.
    pub(super) places: Vec<[f64; 3]>,
    /// Faces with at least three corners, all at finite positions.
    faces: Vec<&'a [u32]>,
    /// Unit normal of each face, in the directions of `places`; none of a face without area.
    normals: Vec<Option<[f64; 3]>>,
    /// Number of each node, shared by all nodes in the same place: neighbouring sectors may have nodes of their own.
    merged: Vec<u32>,
}

impl<'a> Shape<'a> {
    /// Prepares the faces of a surface whose nodes are at these positions.
    pub(super) fn new(surface: &'a FieldSurface, places: Vec<[f64; 3]>) -> Self {
        let placed = |corner: &u32| {
            places.get(*corner as usize).is_some_and(|place| place.iter().all(|value| value.is_finite()))
        };
        let drawn = surface.faces.iter().filter(|face| face.len() >= 3 && face.iter().all(placed));
        let faces: Vec<&[u32]> = drawn.map(Vec::as_slice).collect();
        let normals = faces.iter().map(|face| normal(face, &places)).collect();
        Self { merged: merged(&surface.nodes), places, faces, normals }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Draws the faces, divided into triangles about their middles.
    pub(super) fn draw(&self, values: &[Option<f64>], depths: &mut Depths) {
        let lights = self.lights();
        for ((face, lights), normal) in self.faces.iter().zip(lights).zip(&self.normals) {
            if normal.is_none() {
                continue;
            }
            let corners: Vec<Corner> = face
                .iter()
                .zip(lights)
                .map(|(corner, light)| {
                    let corner = *corner as usize;
                    let value = values.get(corner).copied().flatten().filter(|value| value.is_finite());
                    let claim = if value.is_some() { 1.0 } else { 0.0 };
                    Corner { place: self.places[corner], value: value.unwrap_or(0.0), claim, light }
                })
                .collect();
            match corners[..] {
                [a, b, c] => depths.triangle(&[a, b, c]),
                _ => {
                    let middle = middle(&corners);
                    for (i, corner) in corners.iter().enumerate() {
                        depths.triangle(&[middle, *corner, corners[(i + 1) % corners.len()]]);
                    }
                }
            }
        }
    }

    /// Light at the corners of each face, from the mean normal of all faces that bend into each other there.
    fn lights(&self) -> Vec<Vec<f64>> {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.merged.len()];
        for (index, face) in self.faces.iter().enumerate() {
            for corner in *face {
                around[self.merged[*corner as usize] as usize].push(index as u32);
            }
        }
        let at = |own: &Option<[f64; 3]>, corner: &u32| {
            let Some(own) = own else { return 0.0 };
            let faces = &around[self.merged[*corner as usize] as usize];
            let bent = faces.iter().filter_map(|face| self.normals[*face as usize]);
            let sum = bent
                .filter(|other| dot(own, other) > EDGE)
                .fold([0.0; 3], |sum, other| [0, 1, 2].map(|i| sum[i] + other[i]));
            unit(sum).map_or(0.0, |mean| mean[2].abs())
        };
        let faces = self.faces.iter().zip(&self.normals);
        faces.map(|(face, own)| face.iter().map(|corner| at(own, corner)).collect()).collect()
    }

    /// Edges that show the shape: where a surface ends, where faces meet at an angle, and where it turns away from the viewer.
    pub(super) fn edges(&self) -> Vec<[[f64; 3]; 2]> {
        let mut uses: Vec<([u32; 2], u32, [u32; 2])> = Vec::new();
        for (index, face) in self.faces.iter().enumerate() {
            for (i, from) in face.iter().enumerate() {
                let ends = [*from, face[(i + 1) % face.len()]];
                let mut shared = ends.map(|end| self.merged[end as usize]);
                shared.sort_unstable();
                if shared[0] != shared[1] {
                    uses.push((shared, index as u32, ends));
                }
            }
        }
        uses.sort_unstable();
        let shown = |faces: &[([u32; 2], u32, [u32; 2])]| match faces {
            [(_, a, _), (_, b, _)] => match (self.normals[*a as usize], self.normals[*b as usize]) {
                (Some(a), Some(b)) => dot(&a, &b) < EDGE || (a[2] > 0.0) != (b[2] > 0.0),
                _ => false,
            },
            _ => true,
        };
        let edges = uses.chunk_by(|a, b| a.0 == b.0).filter(|faces| shown(faces));
        edges.map(|faces| faces[0].2.map(|end| self.places[end as usize])).collect()
    }
}

/// Mean of corners; its value is the mean of the claimed ones.
fn middle(corners: &[Corner]) -> Corner {
    let mean = |of: &dyn Fn(&Corner) -> f64| corners.iter().map(of).sum::<f64>() / corners.len() as f64;
    let claim = mean(&|corner| corner.claim);
    let value = mean(&|corner| corner.claim * corner.value);
    Corner {
        place: [0, 1, 2].map(|axis| mean(&|corner| corner.place[axis])),
        value: if claim > 0.0 { value / claim } else { 0.0 },
        claim,
        light: mean(&|corner| corner.light),
    }
}

/// Normal of a face (Newell), which need not be flat; down is negative here, so that up is positive.
fn normal(face: &[u32], places: &[[f64; 3]]) -> Option<[f64; 3]> {
    let mut sum = [0.0; 3];
    for (i, corner) in face.iter().enumerate() {
        let a = places[*corner as usize];
        let b = places[face[(i + 1) % face.len()] as usize];
        for (axis, value) in sum.iter_mut().enumerate() {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            *value += (a[j] - b[j]) * (a[k] + b[k]);
        }
    }
    // The vertical axis of pixels points down, so the mirrored corners turn the other way.
    unit(sum.map(|value| -value))
}

fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(&vector, &vector).sqrt();
    (length.is_finite() && length > 0.0).then(|| vector.map(|value| value / length))
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Number of each node, equal for nodes in the same place.
fn merged(nodes: &[[f64; 3]]) -> Vec<u32> {
    let size = nodes.iter().flatten().filter(|value| value.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
    let cell = |value: f64| (1e6 * value / size).round() as i64;
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut number = |node: &[f64; 3]| {
        let next = numbers.len() as u32;
        *numbers.entry(node.map(cell)).or_insert(next)
    };
    nodes.iter().map(&mut number).collect()
}
