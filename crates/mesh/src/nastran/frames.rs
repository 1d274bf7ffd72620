//! Positions in rectangular, cylindrical and spherical coordinate systems.

use std::collections::BTreeMap;

use crate::error::MeshProblem;

/// Point in a coordinate system; 0 is the basic one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// Number of the system.
    pub(super) system: u64,
    /// Coordinates there.
    pub(super) position: [f64; 3],
}

/// Meaning of the three coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// Three coordinates along the axes.
    Rectangular,
    /// Radius, angle in degrees, height.
    Cylindrical,
    /// Radius, angle from the z axis and angle about it, both in degrees.
    Spherical,
}

impl Kind {
    fn rectangular(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        let ((sb, cb), (sc, cc)) = (b.to_radians().sin_cos(), c.to_radians().sin_cos());
        match self {
            Self::Rectangular => [a, b, c],
            Self::Cylindrical => [a * cb, a * sb, c],
            Self::Spherical => [a * sb * cc, a * sb * sc, a * cb],
        }
    }
}

/// Axes of a system in the basic one.
struct Frame {
    kind: Kind,
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

/// Axes of all systems.
pub(super) struct Frames(BTreeMap<u64, Frame>);

impl Frame {
    fn basic() -> Self {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self { kind: Kind::Rectangular, origin: [0.0; 3], axes }
    }
}

impl Frames {
    /// Basic system alone.
    pub(super) fn basic() -> Self {
        Self(BTreeMap::from([(0, Frame::basic())]))
    }

    /// Whether the axes of a system are known.
    pub(super) fn have(&self, system: u64) -> bool {
        self.0.contains_key(&system)
    }

    /// Adds a system by its origin, a point on its z axis and one in its plane of x and z, in systems that are known.
    pub(super) fn add(&mut self, system: u64, kind: Kind, [a, b, c]: [Point; 3]) -> Result<(), MeshProblem> {
        let [origin, b, c] = [self.position(a)?, self.position(b)?, self.position(c)?];
        let on_a_line =
            || MeshProblem::Expected { expected: "three points that are not on one line".to_owned() };
        let z = unit(minus(b, origin)).ok_or_else(on_a_line)?;
        let in_plane = unit(minus(c, origin)).ok_or_else(on_a_line)?;
        let y = unit(cross(z, in_plane)).ok_or_else(on_a_line)?;
        self.0.insert(system, Frame { kind, origin, axes: [cross(y, z), y, z] });
        Ok(())
    }

    /// Cartesian position of a point in the basic system.
    pub(super) fn position(&self, point: Point) -> Result<[f64; 3], MeshProblem> {
        let frame = self.0.get(&point.system).ok_or_else(|| no_such(point.system))?;
        if point.system == 0 {
            return Ok(point.position);
        }
        let local = frame.kind.rectangular(point.position);
        let mut position = frame.origin;
        for (x, axis) in local.iter().zip(frame.axes) {
            position.iter_mut().zip(axis).for_each(|(p, a)| *p += x * a);
        }
        if position.iter().all(|x| x.is_finite()) {
            return Ok(position);
        }
        Err(MeshProblem::Expected { expected: "coordinates of a finite position".to_owned() })
    }
}

/// Refusal of a system that is not there.
pub(super) fn no_such(system: u64) -> MeshProblem {
    MeshProblem::NoSuch { what: "coordinate system", name: system.to_string() }
}

/// Smallest length of a vector that has a direction: among unit vectors, rounding is far below.
const SHORTEST: f64 = 1e-12;

fn unit(x: [f64; 3]) -> Option<[f64; 3]> {
    let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > SHORTEST && length.is_finite()).then(|| x.map(|x| x / length))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
