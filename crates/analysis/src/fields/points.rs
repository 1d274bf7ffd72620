//! Points of a part: node and sector of each.

use super::sector::{FieldSector, Part};
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::skin::skin;

/// Points of a part, sector after sector. In the whole wheel the faces between sectors count once: its last sector meets its first.
#[derive(Debug)]
pub struct Points<'a> {
    of: &'a FieldSector,
    part: Part,
    /// Nodes of each sector that are points.
    places: Vec<u32>,
    /// Rank of each node in `places`.
    rank: Vec<u32>,
}

impl<'a> Points<'a> {
    /// All nodes of a part as points.
    pub fn all(of: &'a FieldSector, part: Part) -> Self {
        Self::those(of, part, |_| true)
    }

    /// Nodes of some faces of the sector as points.
    pub fn of_faces(of: &'a FieldSector, part: Part, faces: &[Vec<u32>]) -> Self {
        let mut wanted = vec![false; of.nodes().len()];
        for &corner in faces.iter().flatten() {
            wanted[corner as usize] = true;
            // In the whole wheel the high node is a point of the next sector.
            if part == Part::Wheel {
                wanted[of.low(corner) as usize] = true;
            }
        }
        Self::those(of, part, |place| wanted[place as usize])
    }

    fn those(of: &'a FieldSector, part: Part, wanted: impl Fn(u32) -> bool) -> Self {
        let all = 0..of.nodes().len() as u32;
        let is_point = |&place: &u32| wanted(place) && (part != Part::Wheel || !of.is_high(place));
        let places: Vec<u32> = all.filter(is_point).collect();
        let mut rank = vec![0; of.nodes().len()];
        for (number, &place) in (0..).zip(&places) {
            rank[place as usize] = number;
        }
        Self { of, part, places, rank }
    }

    /// Nodes of each sector that are points of the part.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Number of points.
    pub fn count(&self) -> usize {
        self.of.sectors_of(self.part).len() * self.places.len()
    }

    /// Number of the point at a node of a sector of the part.
    pub fn number(&self, sector: usize, place: u32) -> usize {
        if self.part != Part::Wheel {
            return self.rank[place as usize] as usize;
        }
        let low = self.of.low(place);
        let onward = usize::from(low != place);
        (sector + onward) % self.of.sectors() * self.places.len() + self.rank[low as usize] as usize
    }
}

/// Corners of the faces of a part's skin in each of its sectors, anticlockwise seen from outside. A single sector includes its two cut
/// faces.
pub fn skin_faces(mesh: &SectorMesh, part: Part) -> Vec<Vec<u32>> {
    let faces = skin(mesh).faces.into_iter().filter(|face| face.cut.is_none() || part != Part::Wheel);
    faces.map(|face| face.nodes[..face.corners].to_vec()).collect()
}
