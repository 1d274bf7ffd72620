//! Places that are one: within the digits of a mesh, and on the axis of several sectors.

use std::f64::consts::TAU;

use crate::frame::{AxisFrame, distance};
use crate::mesh::SectorMesh;

/// Distance, in parts of the diagonal of a mesh's bounding box, within which two places are one: coordinates are printed with six digits.
const TOLERANCE: f64 = 1e-5;

/// Distance within which two places of a mesh with nodes at these positions are one.
pub fn tolerance(positions: impl Iterator<Item = [f64; 3]>) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in positions {
        for k in 0..3 {
            low[k] = low[k].min(position[k]);
            high[k] = high[k].max(position[k]);
        }
    }
    // A mesh of one point must still have cells.
    (TOLERANCE * distance(low, high)).max(f64::MIN_POSITIVE)
}

/// Whether a position is on the axis of several sectors: it coincides with the axis, or with its own copy in the next sector.
pub fn on_axis(position: [f64; 3], frame: &AxisFrame, sectors: usize, tolerance: f64) -> bool {
    if sectors == 1 {
        return false;
    }
    let own_copy = frame.turn_point(position, TAU / sectors as f64);
    frame.coordinates(position)[0].min(distance(position, own_copy)) <= tolerance
}

impl SectorMesh {
    /// Whether each node is on the axis of several sectors.
    pub fn on_axis(&self) -> Vec<bool> {
        let within = tolerance(self.nodes.iter().copied());
        match AxisFrame::new(self.axis.0, self.axis.1) {
            Some(frame) => self.nodes.iter().map(|&at| on_axis(at, &frame, self.sectors, within)).collect(),
            None => vec![false; self.nodes.len()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_is_where_a_place_is_its_own_copy() {
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        let is_on_axis = |x: f64, sectors| on_axis([x, 0.0, 0.3], &frame, sectors, 1e-5);
        assert!(is_on_axis(0.0, 7) && !is_on_axis(0.0, 1));
        // So near that its copy in the next sector is itself.
        assert!(is_on_axis(2e-5, 23) && !is_on_axis(5e-5, 23));
    }
}
