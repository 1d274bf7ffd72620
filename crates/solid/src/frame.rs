//! Cylindrical coordinates about an arbitrary axis.
//!
//! e3 is the direction of the axis; e1 is the package's x axis projected normal to it (the y axis if x is within
//! about 0.06° of parallel to it), where θ = 0; e2 = e3 × e1, so that +θ turns positively about the direction, which is how the wheel
//! rotates (docs/method.md, Conventions). A point on the axis has θ = 0.

use nalgebra::{Matrix3, RowVector3, Vector3};

/// Sine of the angle between x and the axis below which y takes over.
const NEARLY_PARALLEL: f64 = 1e-3;

/// Matrix of a local basis: rows are the local unit vectors in global components, local = basis · global.
pub type Basis = Matrix3<f64>;

/// Axis of rotation with its zero of θ.
#[derive(Debug, Clone)]
pub struct AxisFrame {
    origin: Vector3<f64>,
    e: Basis,
}

impl AxisFrame {
    /// Frame of an axis by a point on it and its direction, of any length; `None` if the direction is zero or not finite.
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Option<Self> {
        let e3 = unit(direction.into())?;
        let normal_part = |v: Vector3<f64>| v - e3 * v.dot(&e3);
        let from_x = normal_part(Vector3::x());
        let e1 =
            if from_x.norm() > NEARLY_PARALLEL { unit(from_x) } else { unit(normal_part(Vector3::y())) }?;
        let e = Basis::from_columns(&[e1, e3.cross(&e1), e3]).transpose();
        Some(Self { origin: origin.into(), e })
    }

    /// Unit vector of the axis.
    pub fn direction(&self) -> Vector3<f64> {
        self.e.row(2).transpose()
    }

    /// Cylindrical coordinates (r, θ, z) of a point, θ in (−π, π].
    pub fn coordinates(&self, position: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = (self.e * (Vector3::from(position) - self.origin)).into();
        let r = x.hypot(y);
        [r, if r == 0.0 { 0.0 } else { y.atan2(x) }, z]
    }

    /// Unit vectors r, θ, z at the angle `theta`.
    pub fn cylindrical(&self, theta: f64) -> Basis {
        let (sin, cos) = theta.sin_cos();
        let [e1, e2, e3]: [RowVector3<f64>; 3] = std::array::from_fn(|k| self.e.row(k).into_owned());
        Basis::from_rows(&[e1 * cos + e2 * sin, e1 * -sin + e2 * cos, e3])
    }

    /// Global unit vectors turned by `angle` about the axis.
    pub fn turned_global(&self, angle: f64) -> Basis {
        let units = [Vector3::x(), Vector3::y(), Vector3::z()];
        Basis::from_columns(&units.map(|v| self.turn_vector(v, angle))).transpose()
    }

    /// A point turned by `angle` about the axis.
    pub fn turn_point(&self, position: [f64; 3], angle: f64) -> [f64; 3] {
        (self.turn_vector(Vector3::from(position) - self.origin, angle) + self.origin).into()
    }

    fn turn_vector(&self, v: Vector3<f64>, angle: f64) -> Vector3<f64> {
        let [x, y, z] = (self.e * v).into();
        let (sin, cos) = angle.sin_cos();
        self.e.tr_mul(&Vector3::new(cos * x - sin * y, sin * x + cos * y, z))
    }
}

/// Distance of two points; unlike the norm of their difference it neither over- nor underflows on the way.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// Unit vector along `v`, scaled first, so that no finite non-zero direction over- or underflows.
fn unit(v: Vector3<f64>) -> Option<Vector3<f64>> {
    let largest = v.amax();
    (largest > 0.0 && v.iter().all(|x| x.is_finite())).then(|| (v / largest).normalize())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn frame(direction: [f64; 3]) -> AxisFrame {
        AxisFrame::new([1.0, 2.0, 3.0], direction).expect("a direction")
    }

    fn close(a: [f64; 3], b: [f64; 3]) -> bool {
        distance(a, b) < 1e-14 * (1.0 + Vector3::from(b).norm())
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
                let v = Vector3::new(0.2, 0.3, -0.4);
                let before = frame.cylindrical(theta) * v;
                let after = frame.cylindrical(theta + angle) * frame.turn_vector(v, angle);
                assert!(close(before.into(), after.into()));
            }
        }
        assert!(AxisFrame::new([0.0; 3], [0.0; 3]).is_none());
    }
}
