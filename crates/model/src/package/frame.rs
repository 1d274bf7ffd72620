//! Cylindrical coordinates about an arbitrary axis.
//!
//! e3 is the direction of the axis; e1 is the package's x axis projected normal to it (the y axis if x is within
//! about 0.06° of parallel to it), where θ = 0; e2 = e3 × e1, so that +θ turns positively about the direction, which is how the wheel
//! rotates (docs/method.md, Conventions). A point on the axis has θ = 0.

use super::raw::Axis;

/// Sine of the angle between x and the axis below which y takes over.
const NEARLY_PARALLEL: f64 = 1e-3;

/// Rows are the local unit vectors in global components: local = basis · global.
pub(super) type Basis = [[f64; 3]; 3];

/// Local components are global components.
pub(super) const GLOBAL: Basis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The axis of rotation with its zero of θ.
#[derive(Debug, Clone)]
pub(super) struct AxisFrame {
    origin: [f64; 3],
    e: Basis,
}

impl AxisFrame {
    /// `None` if the direction is zero or not finite.
    pub(super) fn new(axis: &Axis) -> Option<Self> {
        let e3 = unit(axis.direction)?;
        let normal_part = |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| v[k] - dot(v, e3) * e3[k]) };
        let from_x = normal_part(GLOBAL[0]);
        let e1 = if dot(from_x, from_x).sqrt() > NEARLY_PARALLEL {
            unit(from_x)
        } else {
            unit(normal_part(GLOBAL[1]))
        }?;
        Some(Self { origin: axis.origin, e: [e1, cross(e3, e1), e3] })
    }

    /// (r, θ, z) of a point, θ in (−π, π].
    pub(super) fn coordinates(&self, position: [f64; 3]) -> [f64; 3] {
        let from_origin = std::array::from_fn(|k| position[k] - self.origin[k]);
        let [x, y, z] = apply(&self.e, from_origin);
        let r = x.hypot(y);
        [r, if r == 0.0 { 0.0 } else { y.atan2(x) }, z]
    }

    /// The unit vectors r, θ, z at the angle `theta`.
    pub(super) fn cylindrical(&self, theta: f64) -> Basis {
        let (sin, cos) = theta.sin_cos();
        let [e1, e2, e3] = self.e;
        [combine(cos, e1, sin, e2), combine(-sin, e1, cos, e2), e3]
    }

    /// The global unit vectors turned by `angle` about the axis.
    pub(super) fn turned_global(&self, angle: f64) -> Basis {
        GLOBAL.map(|v| self.turn_vector(v, angle))
    }

    /// A point turned by `angle` about the axis.
    pub(super) fn turn_point(&self, position: [f64; 3], angle: f64) -> [f64; 3] {
        let from_origin = std::array::from_fn(|k| position[k] - self.origin[k]);
        let turned = self.turn_vector(from_origin, angle);
        std::array::from_fn(|k| turned[k] + self.origin[k])
    }

    fn turn_vector(&self, v: [f64; 3], angle: f64) -> [f64; 3] {
        let [x, y, z] = apply(&self.e, v);
        let (sin, cos) = angle.sin_cos();
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        std::array::from_fn(|k| x * self.e[0][k] + y * self.e[1][k] + z * self.e[2][k])
    }
}

/// basis · v.
pub(super) fn apply(basis: &Basis, v: [f64; 3]) -> [f64; 3] {
    basis.map(|row| dot(row, v))
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Distance of two points.
pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

fn combine(a: f64, u: [f64; 3], b: f64, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a * u[k] + b * v[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Scaled first, so that no finite non-zero direction over- or underflows.
fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let largest = v.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite() && v.iter().all(|x| x.is_finite())) {
        return None;
    }
    let v = v.map(|x| x / largest);
    let length = dot(v, v).sqrt();
    Some(v.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn frame(direction: [f64; 3]) -> AxisFrame {
        AxisFrame::new(&Axis { origin: [1.0, 2.0, 3.0], direction }).expect("a direction")
    }

    fn close(a: [f64; 3], b: [f64; 3]) -> bool {
        distance(a, b) < 1e-14 * (1.0 + dot(b, b).sqrt())
    }

    #[test]
    fn theta_starts_at_x_and_grows_with_rotation() {
        let up = frame([0.0, 0.0, 7.0]);
        assert!(close(up.coordinates([3.0, 2.0, 8.0]), [2.0, 0.0, 5.0]));
        assert!(close(up.coordinates([1.0, 4.0, 3.0]), [2.0, FRAC_PI_2, 0.0]));
        let down = frame([0.0, 0.0, -1e-300]);
        assert!(close(down.coordinates([1.0, 4.0, 3.0]), [2.0, -FRAC_PI_2, 0.0]));
        assert!(close(down.coordinates([1.0, 2.0, 4.0]), [0.0, 0.0, -1.0]), "on the axis");
    }

    #[test]
    fn an_axis_along_x_measures_from_y() {
        for nearly in [0.0, 1e-5] {
            let along_x = frame([1.0, nearly, 0.0]);
            let [_, theta, _] = along_x.coordinates([1.0, 5.0, 3.0]);
            assert!(theta.abs() < 1e-9);
        }
    }

    #[test]
    fn turning_a_point_adds_to_its_angle_and_keeps_its_components() {
        for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, -2.0, 0.5], [-1e9, 1e3, 2.0]] {
            let frame = frame(direction);
            let point = [4.0, -1.0, 0.5];
            let [r, theta, z] = frame.coordinates(point);
            for angle in [0.3, 1.0, -0.7] {
                let turned = frame.coordinates(frame.turn_point(point, angle));
                let wrapped = (theta + angle + PI).rem_euclid(2.0 * PI) - PI;
                assert!(close(turned, [r, wrapped, z]), "{direction:?} {turned:?}");
                // A vector turned with the point has the same cylindrical components.
                let v = [0.2, 0.3, -0.4];
                let before = apply(&frame.cylindrical(theta), v);
                let after = apply(&frame.cylindrical(theta + angle), frame.turn_vector(v, angle));
                assert!(close(before, after));
            }
        }
        assert!(AxisFrame::new(&Axis { origin: [0.0; 3], direction: [0.0; 3] }).is_none());
    }
}
