//! Search for a face that lies where another one is laid and looks the opposite way.

use std::collections::HashMap;

use nalgebra::Vector3;
use rubmap_solid::mesh::SectorMesh;

use super::surface::Face;

/// Least cosine of the angle between the normals of faces that look at each other.
const OPPOSED: f64 = 0.95;

/// Faces by the cell of a grid that their centres lie in.
pub(super) struct Opposite<'a> {
    faces: Vec<&'a Face>,
    /// Distance of the farthest corner from the centre of each face.
    reaches: Vec<f64>,
    width: f64,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Opposite<'a> {
    pub(super) fn new(mesh: &SectorMesh, faces: Vec<&'a Face>) -> Self {
        let reach = |face: &&Face| {
            let corners = face.corners().iter().map(|&node| Vector3::from(mesh.nodes[node as usize]));
            corners.map(|corner| (corner - face.centre).norm()).fold(0.0, f64::max)
        };
        let reaches: Vec<f64> = faces.iter().map(reach).collect();
        let width = reaches.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (k, face) in faces.iter().enumerate() {
            cells.entry(cell(face.centre, width)).or_default().push(k);
        }
        Self { faces, reaches, width, cells }
    }

    /// Face around the place `at` whose normal is opposite to `normal` and whose plane is within `flat` of its size.
    pub(super) fn at(&self, at: Vector3<f64>, normal: Vector3<f64>, flat: f64) -> Option<&'a Face> {
        let found = self.around(at, normal, flat).next();
        found.map(|(face, _)| face)
    }

    /// Nearest face around the place `at` that looks at it against `normal` from within `flat` of its size, and its distance.
    pub(super) fn before(
        &self,
        at: Vector3<f64>,
        normal: Vector3<f64>,
        flat: f64,
    ) -> Option<(&'a Face, f64)> {
        let before = self.around(at, normal, flat).filter(|(_, off)| *off > 0.0);
        before.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Faces around a place with opposite normals, and the distance of the place from their planes.
    fn around(
        &self,
        at: Vector3<f64>,
        normal: Vector3<f64>,
        flat: f64,
    ) -> impl Iterator<Item = (&'a Face, f64)> {
        let [i, j, k] = cell(at, self.width);
        let around = (-1..=1)
            .flat_map(move |a| (-1..=1).flat_map(move |b| (-1..=1).map(move |c| [i + a, j + b, k + c])));
        let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.filter_map(move |&other| {
            let (face, reach) = (self.faces[other], self.reaches[other]);
            let off = at - face.centre;
            let away = off.dot(&face.normal);
            let meets =
                normal.dot(&face.normal) < -OPPOSED && away.abs() < flat * reach && off.norm() < reach;
            meets.then_some((face, away))
        })
    }
}

fn cell(at: Vector3<f64>, width: f64) -> [i64; 3] {
    at.map(|x| (x / width).floor() as i64).into()
}
