//! Gauss–Legendre points of the cube.

use std::sync::LazyLock;

use crate::natural::Natural;

/// Integration point.
#[derive(Debug, Clone, Copy)]
pub struct GaussPoint {
    /// Natural coordinates of the point.
    pub xi: Natural,
    /// Weight of the point; the weights of a rule of the cube add up to 8.
    pub weight: f64,
}

static TWO: LazyLock<Vec<GaussPoint>> = LazyLock::new(|| {
    let g = 1.0 / 3.0_f64.sqrt();
    product(&[(-g, 1.0), (g, 1.0)])
});

static THREE: LazyLock<Vec<GaussPoint>> = LazyLock::new(|| {
    let g = 0.6_f64.sqrt();
    product(&[(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)])
});

static FOUR_ALONG_Z: LazyLock<Vec<GaussPoint>> = LazyLock::new(|| {
    let (a, b) = (3.0 / 7.0, 2.0 / 7.0 * 1.2_f64.sqrt());
    let (inner, outer) = ((a - b).sqrt(), (a + b).sqrt());
    let (heavy, light) = ((18.0 + 30.0_f64.sqrt()) / 36.0, (18.0 - 30.0_f64.sqrt()) / 36.0);
    let along = [(-outer, light), (-inner, heavy), (inner, heavy), (outer, light)];
    let g = 0.6_f64.sqrt();
    let across = [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)];
    let mut points = Vec::with_capacity(36);
    for (z, wz) in along {
        for (y, wy) in across {
            points.extend(across.map(|(x, wx)| GaussPoint { xi: [x, y, z], weight: wx * wy * wz }));
        }
    }
    points
});

/// Product rule of three points in ξ and η (degree 5) and four in ζ (degree 7).
pub(crate) fn four_along_z() -> &'static [GaussPoint] {
    &FOUR_ALONG_Z
}

/// Product rule of two (exact to degree 3 in each coordinate) or three (degree 5) points in each direction, ξ fastest.
///
/// # Panics
/// For any other number of points.
pub fn gauss_points(per_direction: usize) -> &'static [GaussPoint] {
    match per_direction {
        2 => &TWO,
        3 => &THREE,
        other => panic!("no rule of {other} points"),
    }
}

/// Product of a one-dimensional rule of (abscissa, weight).
fn product(rule: &[(f64, f64)]) -> Vec<GaussPoint> {
    let mut points = Vec::with_capacity(rule.len().pow(3));
    for &(z, wz) in rule {
        for &(y, wy) in rule {
            for &(x, wx) in rule {
                points.push(GaussPoint { xi: [x, y, z], weight: wx * wy * wz });
            }
        }
    }
    points
}
