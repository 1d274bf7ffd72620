//! Faces that a turn about an axis carries onto others that look the opposite way.

use std::f64::consts::TAU;

use rubmap_solid::frame::AxisFrame;

use super::surface::Face;
use crate::package::by_place::NodeGrid;

/// Largest number of sectors that is looked for.
pub(super) const MOST_SECTORS: f64 = 400.0;

/// Largest difference of unit normals that are still opposite: that of faces whose nodes have few digits.
pub(super) const OPPOSITE: f64 = 1e-3;

/// Pairs (low face, high face) for a number of sectors, and the area of the low ones.
pub(super) fn matched(
    surface: &[Face],
    axis: &AxisFrame,
    sectors: usize,
    within: f64,
    opposite: f64,
) -> (Vec<(usize, usize)>, f64) {
    let centres = surface.iter().zip(0..).map(|(face, k)| (k, face.centre.into())).collect();
    let centres = NodeGrid::new(centres, within);
    let angle = TAU / sectors as f64;
    let turned = axis.turned_global(angle);
    let mut fits = Vec::new();
    let mut area = 0.0;
    for (low, face) in surface.iter().enumerate() {
        let Some(high) = centres.near(axis.turn_point(face.centre.into(), angle)) else { continue };
        let high = high as usize;
        // Rows are the turned unit vectors, so that their combination is the turned normal.
        let normal = turned.tr_mul(&face.normal);
        // Of two sectors each face is turned onto the other: the low one looks against the rotation.
        let is_low = sectors > 2 || face.cylindrical_normal(axis)[1] < 0.0;
        if is_low && (normal + surface[high].normal).norm() <= opposite {
            fits.push((low, high));
            area += face.area;
        }
    }
    (fits, area)
}
