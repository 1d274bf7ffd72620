//! A spinning annulus cut into sectors: centrifugal load, cyclic solve and stresses against the closed form.

use std::f64::consts::PI;

use rubmap::impeller::mesh::{Elements, HexMesh, SectorMesh};
use rubmap::impeller::{Material, SectorMatrices};

const INNER: f64 = 0.3;
const OUTER: f64 = 1.0;
const MATERIAL: Material = Material { youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0 };

/// One layer, thickness 0.01, on a frictionless plane (z = 0); nothing turns (θ clamped at the inner edge only).
fn annulus(sectors: usize, around: usize, radial: usize) -> SectorMesh {
    let mut mesh = HexMesh::default();
    let mut clamped = Vec::new();
    let mut cyclic = Vec::new();
    let pitch = 2.0 * PI / sectors as f64;
    for k in 0..2 {
        for j in 0..=around {
            for i in 0..=radial {
                let r = INNER + (OUTER - INNER) * i as f64 / radial as f64;
                let theta = 0.4 + pitch * j as f64 / around as f64;
                mesh.nodes.push([r * theta.cos(), r * theta.sin(), 0.01 * k as f64]);
                clamped.push([false, i == 0, k == 0]);
            }
        }
    }
    let node = |i: usize, j: usize, k: usize| i + (radial + 1) * (j + (around + 1) * k);
    for k in 0..2 {
        for i in 0..=radial {
            cyclic.push((node(i, 0, k), node(i, around, k)));
        }
    }
    let mut elements = Vec::new();
    for j in 0..around {
        for i in 0..radial {
            let face =
                |k: usize| [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)];
            let (a, b) = (face(0), face(1));
            elements.push([a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
        }
    }
    mesh.elements = Elements::Linear(elements);
    SectorMesh { sectors, mesh, clamped, cyclic, contact: Vec::new() }
}

/// Hoop stress at the bore, per unit ρΩ² (BENCHMARKS.md).
fn exact_bore_stress() -> f64 {
    let nu = MATERIAL.poissons_ratio;
    (3.0 + nu) / 4.0 * (OUTER.powi(2) + (1.0 - nu) / (3.0 + nu) * INNER.powi(2))
}

/// `E u_r/r` at the bore, where `σ_r` = 0: the hoop stress there.
fn bore_stress(sector: &SectorMesh) -> f64 {
    let matrices = SectorMatrices::assemble(sector, &MATERIAL).unwrap();
    let u = &matrices.prestress.displacements;
    assert!((u[0][0] / u[sector.cyclic[0].1][0] - 1.0).abs() < 1e-12, "both faces move alike");
    u[0][0] * MATERIAL.youngs_modulus / INNER
}

/// Second order in the mesh (measured ratio 4.0), 2e-3 at 96 × 32 elements.
#[test]
fn hoop_stress_at_the_bore_converges_to_the_closed_form() {
    let error =
        |around: usize, radial: usize| bore_stress(&annulus(12, around, radial)) / exact_bore_stress() - 1.0;
    let (coarse, fine) = (error(4, 16), error(8, 32));
    println!("bore hoop stress error {coarse:.2e} {fine:.2e}");
    assert!(fine.abs() < 2e-3, "{fine:.2e}");
    assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse:.2e} / {fine:.2e}");
}

/// Stresses at the Gauss points, turned to (r, θ), follow `σ_θ(r)` and `σ_r(r)` of the plane-stress annulus.
#[test]
fn gauss_point_stresses_follow_the_closed_form() {
    let sector = annulus(12, 8, 32);
    let matrices = SectorMatrices::assemble(&sector, &MATERIAL).unwrap();
    let nu = MATERIAL.poissons_ratio;
    let (a2, b2) = (INNER.powi(2), OUTER.powi(2));
    let mut worst = 0.0_f64;
    for (e, stresses) in matrices.prestress.stresses.iter().enumerate() {
        let x = sector.mesh.corners(e);
        // The element's mean against the closed form at its centre: second order.
        let centre: [f64; 2] = [0, 1].map(|d| x.iter().map(|x| x[d] / 8.0).sum());
        let s = stresses.iter().fold(nalgebra::Vector6::zeros(), |sum, s| sum + s / 8.0);
        let theta = centre[1].atan2(centre[0]);
        let r2 = centre[0].powi(2) + centre[1].powi(2);
        let (sin, cos) = theta.sin_cos();
        let hoop = s[0] * sin * sin + s[1] * cos * cos - 2.0 * s[3] * sin * cos;
        let radial = s[0] * cos * cos + s[1] * sin * sin + 2.0 * s[3] * sin * cos;
        let c = (3.0 + nu) / 8.0;
        let exact_hoop = c * (a2 + b2 + a2 * b2 / r2 - (1.0 + 3.0 * nu) / (3.0 + nu) * r2);
        let exact_radial = c * (a2 + b2 - a2 * b2 / r2 - r2);
        worst = worst.max((hoop - exact_hoop).abs()).max((radial - exact_radial).abs());
    }
    println!("worst stress error {worst:.2e}");
    assert!(worst < 4e-3 * exact_bore_stress(), "{worst:.2e}");
}

/// The same ring of 48 elements cut into 8, 12 or 16 sectors, or 3: the same answer to round-off of the solve.
#[test]
fn sector_count_does_not_change_the_answer() {
    let reference = bore_stress(&annulus(12, 4, 8));
    for sectors in [3, 8, 16] {
        let other = bore_stress(&annulus(sectors, 48 / sectors, 8));
        assert!((other / reference - 1.0).abs() < 1e-10, "{sectors}: {other} {reference}");
    }
}
