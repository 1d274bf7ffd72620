//! Spinning annulus cut into sectors: centrifugal load, cyclic solve and stresses against the closed form.

use rubmap::assembly::SectorMatrices;
use rubmap::impeller::mesh::{ElementOrder, SectorMesh};
use rubmap::impeller::{AnnulusParameters, Material, annulus_mesh};
use rubmap::solid::rule::points;
use rubmap::solid::shape::functions;

const INNER: f64 = 0.3;
const OUTER: f64 = 1.0;
/// Thickness, so small that plane stress holds to 1e-7.
const THICKNESS: f64 = 1e-3;
const MATERIAL: Material = Material {
    youngs_modulus: 1.0,
    poissons_ratio: 0.3,
    density: 1.0,
    yield_strength: None,
    ultimate_strength: None,
    fatigue_strength: None,
};

/// Mesh of one layer on a frictionless plane; nothing turns (θ clamped at the inner edge only).
fn annulus(order: ElementOrder, sectors: usize, around: usize, radial: usize) -> SectorMesh {
    let p = AnnulusParameters {
        sectors,
        inner_radius: INNER,
        outer_radius: OUTER,
        thickness: THICKNESS,
        clamped_bore: false,
        elements: [radial, around, 1],
        element_order: order,
        ..AnnulusParameters::default()
    };
    let mut sector = annulus_mesh(&p).unwrap();
    for (clamped, [x, y, z]) in sector.clamped.iter_mut().zip(&sector.mesh.nodes) {
        *clamped = [false, x.hypot(*y) < INNER * 1.0001, *z < -0.499 * THICKNESS];
    }
    sector
}

/// Hoop stress at the bore in plane stress, per unit ρΩ².
fn exact_bore_stress() -> f64 {
    let nu = MATERIAL.poissons_ratio;
    (3.0 + nu) / 4.0 * (OUTER.powi(2) + (1.0 - nu) / (3.0 + nu) * INNER.powi(2))
}

/// Hoop stress at the bore, which is `E u_r/r` as `σ_r` = 0 there.
fn bore_stress(sector: &SectorMesh) -> f64 {
    let matrices = SectorMatrices::assemble(&sector.made_of(&MATERIAL)).unwrap();
    let u = &matrices.prestress.displacements;
    let &(low, high) = sector.cyclic.iter().find(|(low, _)| sector.clamped[*low][1]).unwrap();
    assert!((u[low][0] / u[high][0] - 1.0).abs() < 1e-12, "both faces move alike");
    u[low][0] * MATERIAL.youngs_modulus / INNER
}

/// Hoop stress at the bore converges to the closed form: second order in the mesh with 8 nodes, fourth with 20.
#[test]
fn hoop_stress_at_the_bore_converges_to_the_closed_form() {
    for (order, expected, within) in [(ElementOrder::Linear, 2.0, 2e-3), (ElementOrder::Quadratic, 4.0, 4e-6)]
    {
        let error = |around: usize, radial: usize| {
            bore_stress(&annulus(order, 12, around, radial)) / exact_bore_stress() - 1.0
        };
        let (coarse, fine) = (error(4, 8), error(8, 16));
        let measured = (coarse / fine).log2();
        println!("{order:?}: {coarse:.2e} {fine:.2e}, order {measured:.2}");
        assert!(fine.abs() < within, "{order:?}: {fine:.2e}");
        assert!((measured - expected).abs() < 0.3, "{order:?}: order {measured:.2}");
    }
}

/// Largest difference between the Gauss points' stresses, turned to (r, θ), and `σ_θ(r)` and `σ_r(r)` of the
/// plane-stress annulus, in parts of the largest stress.
fn stress_error(sector: &SectorMesh) -> f64 {
    let made = sector.made_of(&MATERIAL);
    let matrices = SectorMatrices::assemble(&made).unwrap();
    let nu = MATERIAL.poissons_ratio;
    let (a2, b2) = (INNER.powi(2), OUTER.powi(2));
    let mut worst = 0.0_f64;
    for (element, stresses) in made.mesh.elements.iter().zip(&matrices.prestress.stresses) {
        let x = made.mesh.positions(element);
        for (point, s) in points(element.kind).iter().zip(stresses) {
            let n = functions(element.kind, point.xi);
            let at: [f64; 2] = [0, 1].map(|d| x.iter().zip(&n).map(|(x, n)| n * x[d]).sum());
            let (r2, (sin, cos)) = (at[0].powi(2) + at[1].powi(2), at[1].atan2(at[0]).sin_cos());
            let hoop = s[0] * sin * sin + s[1] * cos * cos - 2.0 * s[3] * sin * cos;
            let radial = s[0] * cos * cos + s[1] * sin * sin + 2.0 * s[3] * sin * cos;
            let c = (3.0 + nu) / 8.0;
            let exact_hoop = c * (a2 + b2 + a2 * b2 / r2 - (1.0 + 3.0 * nu) / (3.0 + nu) * r2);
            let exact_radial = c * (a2 + b2 - a2 * b2 / r2 - r2);
            worst = worst.max((hoop - exact_hoop).abs()).max((radial - exact_radial).abs());
        }
    }
    worst / exact_bore_stress()
}

/// The worst Gauss point converges at first order with 8 nodes and at second with 20.
#[test]
fn gauss_point_stresses_follow_the_closed_form() {
    let error = |order, around, radial| stress_error(&annulus(order, 12, around, radial));
    for (order, expected, within) in [(ElementOrder::Linear, 1.0, 2e-2), (ElementOrder::Quadratic, 2.0, 1e-3)]
    {
        let (coarse, fine) = (error(order, 8, 16), error(order, 16, 32));
        let measured = (coarse / fine).log2();
        println!("{order:?}: stress {coarse:.2e} {fine:.2e}, order {measured:.2}");
        assert!(fine < within, "{order:?}: {fine:.2e}");
        assert!((measured - expected).abs() < 0.3, "{order:?}: order {measured:.2}");
    }
}

/// Ring of 48 elements cut into 8, 12 or 16 sectors, or 3: the same answer to round-off of the solve.
#[test]
fn sector_count_does_not_change_the_answer() {
    let reference = bore_stress(&annulus(ElementOrder::Linear, 12, 4, 8));
    for sectors in [3, 8, 16] {
        let other = bore_stress(&annulus(ElementOrder::Linear, sectors, 48 / sectors, 8));
        assert!((other / reference - 1.0).abs() < 1e-10, "{sectors}: {other} {reference}");
    }
}
