//! Bending vibration of a spinning disk without bending stiffness (Lamb and Southwell), BENCHMARKS.md.

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{AnnulusParameters, Material, SectorMatrices, annulus, annulus_mesh};

use crate::eigen::{harmonic, lowest};

/// ω²/Ω² of nodal diameters 1 … 5 without nodal circle, ν = 0.3.
const MEMBRANE: [f64; 5] = [1.0, 2.35, 4.05, 6.10, 8.50];

/// ω² of nodal diameter i at rest and at Ω; outer radius 1, E = ρ = 1.
fn squares(order: ElementOrder, hub: f64, thickness: f64, radial: usize, speed: f64, i: usize) -> [f64; 2] {
    let p = AnnulusParameters {
        sectors: 24,
        inner_radius: hub,
        outer_radius: 1.0,
        thickness,
        clamped_bore: true,
        elements: [radial, 2, 1],
        element_order: order,
        material: Material { youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0 },
        top_speed_rad_s: speed,
        ..AnnulusParameters::default()
    };
    let package = annulus(&p).unwrap();
    let m = harmonic(&package, &package.mass, i);
    [0, 2].map(|s| lowest(&harmonic(&package, &package.stiffness[s], i), &m, 1).unwrap()[0])
}

#[test]
fn explore() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        for (hub, thickness) in [(0.02, 1e-3), (0.01, 1e-3), (0.02, 1e-4), (0.1, 1e-3)] {
            let speed = 0.02;
            for i in 1..=5 {
                print!("{order:?} hub {hub} h {thickness} i {i}");
                for radial in [4, 8, 16] {
                    let [rest, spun] = squares(order, hub, thickness, radial, speed, i);
                    let unit = speed * speed;
                    let exact = MEMBRANE[i - 1];
                    print!(
                        "   {:.2e} {:.3e} ({:.1e})",
                        (spun - rest) / unit / exact - 1.0,
                        spun / unit / exact - 1.0,
                        rest / spun
                    );
                }
                println!();
            }
        }
    }
}
