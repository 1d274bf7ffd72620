//! Virtual strain gauges: the small strain of a fibre between two nodes, as one more row of the mode shapes.
//!
//! ```text
//! ε = (u_b − u_a)·e/L,   e = (x_b − x_a)/L,   L = |x_b − x_a|
//! ```

use std::f64::consts::TAU;

use faer::{Mat, c64};

use rubmap_wheel::dynamics::modal_wheel::ModalWheel;

/// End of a gauge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// Place of the node among the nodes of which the wheel has rows.
    pub(super) place: usize,
    /// Whether the node lies on the high face: its rows are those of the low node, which belongs to the next sector there.
    pub(super) on_high_face: bool,
    /// Coordinates r, θ, z.
    pub(super) coordinates: [f64; 3],
}

/// Adds the strain between two nodes to the rows of `wheel`, as the first component of one more node; returns the place of that node.
pub(super) fn add_gauge(wheel: &mut ModalWheel, [a, b]: [End; 2]) -> usize {
    let (from, to) = (cartesian(a.coordinates), cartesian(b.coordinates));
    let apart: [f64; 3] = std::array::from_fn(|d| to[d] - from[d]);
    let length = apart[0].hypot(apart[1]).hypot(apart[2]);
    let along = apart.map(|d| d / length);
    let sectors = wheel.around() as f64;
    let mut place = 0;
    for harmonic in &mut wheel.harmonics {
        let alpha = TAU * harmonic.harmonic as f64 / sectors;
        let shapes = &harmonic.contact;
        let rows = shapes.nrows();
        place = rows / 3;
        let moved = |end: End, mode: usize| -> c64 {
            let turn = if end.on_high_face { c64::cis(alpha) } else { c64::ONE };
            let components = cylindrical(along, end.coordinates[1]);
            (0..3).map(|d| turn * shapes[(3 * end.place + d, mode)] * components[d]).sum()
        };
        harmonic.contact = Mat::from_fn(rows + 3, shapes.ncols(), |row, mode| match row {
            row if row < rows => shapes[(row, mode)],
            row if row == rows => (moved(b, mode) - moved(a, mode)) / length,
            _ => c64::ZERO,
        });
    }
    place
}

fn cartesian([r, theta, z]: [f64; 3]) -> [f64; 3] {
    [r * theta.cos(), r * theta.sin(), z]
}

/// Components of a vector along r, θ, z at the angle `theta`.
fn cylindrical([x, y, z]: [f64; 3], theta: f64) -> [f64; 3] {
    let (sin, cos) = theta.sin_cos();
    [x * cos + y * sin, y * cos - x * sin, z]
}
