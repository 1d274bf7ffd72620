//! Pyramids |ξ|, |η| ≤ 1 − ζ, 0 ≤ ζ ≤ 1, with rational functions (Bedrosian, Int. J. Numer. Methods Eng. 35, 1992): on every face they are those of
//! the hexahedron or the tetrahedron beside it.

use nalgebra::Vector3;

use crate::natural::{Natural, PYRAMID_CORNERS, PYRAMID_EDGES};

/// Least distance from the apex: on ξ = η = 0 it gives the limit of the derivatives, which have no value at the apex itself. Its third power is no
/// zero.
const NEAREST_APEX: f64 = 1e-100;

/// Function with its derivative.
type Value = (f64, Vector3<f64>);

fn product(a: Value, b: Value) -> Value {
    (a.0 * b.0, a.1 * b.0 + b.1 * a.0)
}

fn scaled(factor: f64, a: Value) -> Value {
    (factor * a.0, a.1 * factor)
}

/// Ratio of a function to the distance from the apex, 1 − ζ.
fn over_up(a: Value, up: f64) -> Value {
    (a.0 / up, a.1 / up + Vector3::z() * (a.0 / (up * up)))
}

/// Distance from the apex, and the linear functions 1 − ζ + c ξ and 1 − ζ + c η, each with its derivative.
fn parts(xi: Natural) -> (f64, impl Fn(f64) -> Value, impl Fn(f64) -> Value) {
    let up = (1.0 - xi[2]).max(NEAREST_APEX);
    let side = move |d: usize, axis: Vector3<f64>| move |c: f64| (up + c * xi[d], axis * c - Vector3::z());
    (up, side(0, Vector3::x()), side(1, Vector3::y()))
}

/// Linear shape functions: corners `(1 − ζ + ξ_a ξ)(1 − ζ + η_a η)/(4(1 − ζ))`, apex ζ.
pub(super) fn linear(xi: Natural) -> [Value; 5] {
    let (up, along_x, along_y) = parts(xi);
    std::array::from_fn(|a| {
        let [x, y, z] = PYRAMID_CORNERS[a];
        if z > 0.0 {
            (1.0 - up, Vector3::z())
        } else {
            scaled(0.25, over_up(product(along_x(x), along_y(y)), up))
        }
    })
}

/// Quadratic shape functions: corners `N_a (ξ_a ξ + η_a η − 1)` with the linear `N_a`, apex `ζ(2ζ − 1)`, middles of the base's edges
/// `(1 − ζ + ξ)(1 − ζ − ξ)(1 − ζ + η_a η)/(2(1 − ζ))` and likewise along η, of the others `4 ζ N_a`.
pub(super) fn quadratic(xi: Natural) -> [Value; 13] {
    let (up, along_x, along_y) = parts(xi);
    let corner = linear(xi);
    let z = (1.0 - up, Vector3::z());
    std::array::from_fn(|a| {
        if a == 4 {
            return product(z, (2.0 * z.0 - 1.0, Vector3::z() * 2.0));
        }
        if let Some([x, y, _]) = PYRAMID_CORNERS.get(a) {
            return product(corner[a], (x * xi[0] + y * xi[1] - 1.0, Vector3::new(*x, *y, 0.0)));
        }
        let [from, to] = PYRAMID_EDGES[a - 5];
        if to == 4 {
            return scaled(4.0, product(z, corner[from]));
        }
        let [x, y] = [0, 1].map(|d| 0.5 * (PYRAMID_CORNERS[from][d] + PYRAMID_CORNERS[to][d]));
        let along = if x == 0.0 {
            product(product(along_x(1.0), along_x(-1.0)), along_y(y))
        } else {
            product(product(along_y(1.0), along_y(-1.0)), along_x(x))
        };
        scaled(0.5, over_up(along, up))
    })
}
