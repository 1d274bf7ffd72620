//! Integration points of each element, as CalculiX numbers them.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use crate::element::ElementKind;
use crate::gauss::{GaussPoint, four_along_z, gauss_points};
use crate::natural::Natural;

static TETRAHEDRON: [LazyLock<Vec<GaussPoint>>; 2] = [
    LazyLock::new(|| vec![GaussPoint { xi: [0.25; 3], weight: 1.0 / 6.0 }]),
    LazyLock::new(|| {
        let (near, far) = ((5.0 - 5.0_f64.sqrt()) / 20.0, (5.0 + 3.0 * 5.0_f64.sqrt()) / 20.0);
        let point = |k: usize| {
            // Near corner k; corner 0 is the origin.
            let xi = std::array::from_fn(|d| if d + 1 == k { far } else { near });
            GaussPoint { xi, weight: 1.0 / 24.0 }
        };
        (0..4).map(point).collect()
    }),
];

static WEDGE: [LazyLock<Vec<GaussPoint>>; 2] = [
    LazyLock::new(|| {
        let along = [-1.0 / 3.0_f64.sqrt(), 1.0 / 3.0_f64.sqrt()];
        along.map(|z| GaussPoint { xi: [1.0 / 3.0, 1.0 / 3.0, z], weight: 0.5 }).into()
    }),
    LazyLock::new(|| {
        let g = 0.6_f64.sqrt();
        let mut points = Vec::with_capacity(9);
        for (z, weight) in [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)] {
            for [x, y] in [[1.0 / 6.0; 2], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]] {
                points.push(GaussPoint { xi: [x, y, z], weight: weight / 6.0 });
            }
        }
        points
    }),
];

static PYRAMID: [LazyLock<Vec<GaussPoint>>; 2] = [
    LazyLock::new(|| collapsed(gauss_points(2), to_pyramid)),
    LazyLock::new(|| collapsed(gauss_points(3), to_pyramid)),
];

/// Points at which an element's stiffness is integrated and its stress is evaluated.
pub fn points(kind: ElementKind) -> &'static [GaussPoint] {
    match kind {
        ElementKind::C3D4 => &TETRAHEDRON[0],
        ElementKind::C3D10 => &TETRAHEDRON[1],
        ElementKind::C3D5 => &PYRAMID[0],
        ElementKind::C3D13 => &PYRAMID[1],
        ElementKind::C3D6 => &WEDGE[0],
        ElementKind::C3D15 => &WEDGE[1],
        ElementKind::C3D8 | ElementKind::C3D8I | ElementKind::C3D20R | ElementKind::QM6 => gauss_points(2),
        ElementKind::C3D20 => gauss_points(3),
    }
}

/// Rule by which mass is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum MassRule {
    /// Consistent mass that is positive definite: the points of stiffness where these suffice (C3D8, C3D8I, C3D20), elsewhere a rule that is
    /// exact in elements with straight edges.
    #[default]
    Consistent,
    /// Points of stiffness in every element, as CalculiX has it. Tetrahedra, wedges and C3D20R may leave motions without mass.
    AsStiffness,
}

/// Points at which an element's mass is integrated.
pub fn mass_points(kind: ElementKind, rule: MassRule) -> &'static [GaussPoint] {
    match (rule, kind) {
        (MassRule::AsStiffness, _) | (_, ElementKind::C3D8 | ElementKind::C3D8I | ElementKind::C3D20) => {
            points(kind)
        }
        (_, ElementKind::C3D10) => &MASS_TETRAHEDRON,
        (_, ElementKind::C3D13) => &MASS_PYRAMID,
        _ => fine_points(kind),
    }
}

/// Points of products of two quadratic functions: the collapsed direction has two powers more.
static MASS_TETRAHEDRON: LazyLock<Vec<GaussPoint>> =
    LazyLock::new(|| collapsed(four_along_z(), to_tetrahedron));
static MASS_PYRAMID: LazyLock<Vec<GaussPoint>> = LazyLock::new(|| collapsed(four_along_z(), to_pyramid));

static FINE_TETRAHEDRON: LazyLock<Vec<GaussPoint>> =
    LazyLock::new(|| collapsed(gauss_points(3), to_tetrahedron));

static FINE_WEDGE: LazyLock<Vec<GaussPoint>> = LazyLock::new(|| {
    collapsed(gauss_points(3), |[x, y, z]| ([x * (1.0 - y), y, 2.0 * z - 1.0], (1.0 - y) / 4.0))
});

/// Rule of 27 points for mass and loads: exact to the third degree at least in any shape.
pub(crate) fn fine_points(kind: ElementKind) -> &'static [GaussPoint] {
    match kind.corners() {
        4 => &FINE_TETRAHEDRON,
        5 => &PYRAMID[1],
        6 => &FINE_WEDGE,
        _ => gauss_points(3),
    }
}

/// Place in the tetrahedron of a place in the unit cube, with the factor of its weight.
fn to_tetrahedron([x, y, z]: [f64; 3]) -> (Natural, f64) {
    ([x * (1.0 - y) * (1.0 - z), y * (1.0 - z), z], (1.0 - y) * (1.0 - z).powi(2) / 8.0)
}

/// Place in the pyramid of a place in the unit cube, with the factor of its weight.
fn to_pyramid([x, y, z]: [f64; 3]) -> (Natural, f64) {
    let up = 1.0 - z;
    ([(2.0 * x - 1.0) * up, (2.0 * y - 1.0) * up, z], 0.5 * up * up)
}

/// Points of the cube carried over by a map of the unit cube, given with the factor of its weights.
fn collapsed(cube: &[GaussPoint], map: impl Fn([f64; 3]) -> (Natural, f64)) -> Vec<GaussPoint> {
    let carried = |point: &GaussPoint| {
        let (xi, factor) = map(point.xi.map(|x| 0.5 * (1.0 + x)));
        GaussPoint { xi, weight: point.weight * factor }
    };
    cube.iter().map(carried).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrals ∫ ξ^a η^b ζ^c over each shape, in closed form.
    #[test]
    fn rules_integrate_polynomials() {
        let integral = |points: &[GaussPoint], power: [i32; 3]| -> f64 {
            let value = |p: &GaussPoint| p.weight * (0..3).map(|d| p.xi[d].powi(power[d])).product::<f64>();
            points.iter().map(value).sum()
        };
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for a in 0..4 {
            for b in 0..(4 - a) {
                for c in 0..(4 - a - b) {
                    let tetrahedron = factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
                    let fine = integral(fine_points(ElementKind::C3D4), [a, b, c]);
                    assert!((fine - tetrahedron).abs() < 1e-15, "{a} {b} {c}");
                    let along = if c % 2 == 0 { 2.0 / f64::from(c + 1) } else { 0.0 };
                    let wedge = factorial(a) * factorial(b) / factorial(a + b + 2) * along;
                    let fine = integral(fine_points(ElementKind::C3D15), [a, b, c]);
                    assert!((fine - wedge).abs() < 1e-15, "{a} {b} {c}");
                    let base: f64 = [a, b]
                        .map(|p| if p % 2 == 0 { 2.0 / f64::from(p + 1) } else { 0.0 })
                        .iter()
                        .product();
                    let pyramid = base * factorial(c) * factorial(a + b + 2) / factorial(a + b + c + 3);
                    let degree = a + b + c;
                    for (kind, exact, to) in [
                        (ElementKind::C3D4, tetrahedron, 1),
                        (ElementKind::C3D10, tetrahedron, 2),
                        (ElementKind::C3D5, pyramid, 1),
                        (ElementKind::C3D13, pyramid, 3),
                        (ElementKind::C3D6, wedge, 1),
                        (ElementKind::C3D15, wedge, 2),
                    ] {
                        let error = (integral(points(kind), [a, b, c]) - exact).abs();
                        assert!(degree > to || error < 1e-15, "{kind:?} {a} {b} {c}");
                    }
                }
            }
        }
    }
}
