//! Fixture of a small impeller: a hub and thin blades, as the surface of a wheel or of a sector.

use std::f64::consts::{FRAC_PI_2, TAU};

use rubmap_analysis::result::{FieldSurface, SurfaceColour};

/// Number of sectors of a wheel.
pub(super) const SECTORS: usize = 9;

/// Point of a meridional section: axial coordinate and radius.
type Place = (f64, f64);

fn between(a: Place, b: Place, share: f64) -> Place {
    (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1))
}

/// Meridional curve of the hub from the front to the rim.
fn hub(s: f64) -> Place {
    (40.0 - 37.0 * (FRAC_PI_2 * s).sin(), 60.0 - 42.0 * (FRAC_PI_2 * s).cos())
}

/// Meridional curve of the bore and then the back.
fn core(s: f64) -> Place {
    if s < 0.5 { (40.0 * (1.0 - 2.0 * s), 12.0) } else { (0.0, 12.0 + 96.0 * (s - 0.5)) }
}

/// Meridional curve of the blade tips.
fn tip(s: f64) -> Place {
    (42.0 - 34.0 * (FRAC_PI_2 * s).sin(), 62.0 - 26.0 * (FRAC_PI_2 * s).cos())
}

/// Angle of the blade relative to its root at the rim.
fn wrap(s: f64) -> f64 {
    0.9 * (1.0 - s).powi(2) - 0.3
}

const THICKNESS: f64 = 1.4;

struct Builder {
    nodes: Vec<[f64; 3]>,
    /// Relative height of each node on the blade, from hub to tip; 0 in the hub.
    heights: Vec<f64>,
    faces: Vec<Vec<u32>>,
}

impl Builder {
    /// Adds a patch of `rows` × `columns` faces, seen from outside if rows × columns points there.
    fn patch(&mut self, rows: usize, columns: usize, at: impl Fn(f64, f64) -> (Place, f64, f64)) {
        let first = self.nodes.len() as u32;
        for i in 0..=rows {
            for j in 0..=columns {
                let ((z, r), angle, height) = at(i as f64 / rows as f64, j as f64 / columns as f64);
                self.nodes.push([r * angle.cos(), r * angle.sin(), z]);
                self.heights.push(height);
            }
        }
        let node = |i: usize, j: usize| first + (i * (columns + 1) + j) as u32;
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            self.faces.push(vec![node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
        }
    }

    fn sector(&mut self, index: usize, fine: usize, closed: bool) {
        let pitch = TAU / SECTORS as f64;
        let start = pitch * index as f64;
        let around = |j: f64| start + pitch * (j - 0.5);
        self.patch(2 * fine, fine, |i, j| (hub(i), around(j), 0.0));
        self.patch(1, fine, |i, j| (between(hub(1.0), core(1.0), i), around(j), 0.0));
        self.patch(2 * fine, fine, |i, j| (core(1.0 - i), around(j), 0.0));
        self.patch(1, fine, |i, j| (between(core(0.0), hub(0.0), i), around(j), 0.0));
        if closed {
            self.patch(2 * fine, 4, |i, j| (between(core(i), hub(i), j), around(0.0), 0.0));
            self.patch(2 * fine, 4, |i, j| (between(core(i), hub(i), 1.0 - j), around(1.0), 0.0));
        }
        let blade = |s: f64, t: f64, side: f64| {
            let place = between(hub(s), tip(s), t);
            (place, start + wrap(s) + side * THICKNESS / place.1, t)
        };
        let half = fine.div_ceil(2);
        self.patch(2 * fine, fine, |i, j| blade(i, j, -0.5));
        self.patch(2 * fine, fine, |i, j| blade(i, 1.0 - j, 0.5));
        self.patch(2 * fine, half, |i, j| blade(i, 1.0, j - 0.5));
        self.patch(2 * fine, half, |i, j| blade(i, 0.0, 0.5 - j));
        self.patch(fine, half, |i, j| blade(0.0, i, j - 0.5));
        self.patch(fine, half, |i, j| blade(1.0, i, 0.5 - j));
    }
}

/// Surface of the sectors `which`, divided this finely, in a mode of nodal diameter `i`; nothing is claimed of the tips.
pub(super) fn impeller(which: std::ops::Range<usize>, fine: usize, i: f64) -> FieldSurface {
    let mut built = Builder { nodes: Vec::new(), heights: Vec::new(), faces: Vec::new() };
    let closed = which.len() < SECTORS;
    for index in which {
        built.sector(index, fine, closed);
    }
    let Builder { nodes, heights, faces } = built;
    let all = || nodes.iter().zip(&heights);
    let moved = |(&[x, y, _], height): (&[f64; 3], &f64)| {
        let (radius, phase) = (x.hypot(y), (i * y.atan2(x)).cos());
        let (axial, around) = (0.02 * (radius / 62.0).powi(2) * phase, 0.05 * height * height * phase);
        [-around * y / radius, around * x / radius, axial]
    };
    let stressed = |(&[x, y, _], height): (&[f64; 3], &f64)| {
        let (radius, phase) = (x.hypot(y), (i * y.atan2(x)).cos());
        let value = 180.0 * (1.0 - height) * (1.2 - radius / 80.0) + 130.0 * (1.0 - height) * phase.abs();
        (*height <= 0.92).then_some(value)
    };
    FieldSurface {
        title: "Nodal diameter 2, mode 1, 1,234.5 Hz at 20,000 rpm".to_owned(),
        subtitles: vec!["a small impeller · standing wave".to_owned()],
        displacement: all().map(moved).collect(),
        colour: SurfaceColour {
            quantity: "von Mises stress".to_owned(),
            unit: "MPa".to_owned(),
            values: all().map(stressed).collect(),
        },
        faces,
        length_unit: "mm".to_owned(),
        nodes,
    }
}
