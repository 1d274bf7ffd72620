//! Annular plates, clamped inside and free outside, against BENCHMARKS.md.

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{AnnulusParameters, Material, annulus};

use crate::eigen::{harmonic, lowest};

/// λ² = ωa²√(ρh/D) per b/a and nodal diameter, without and with one nodal circle; ν = 0.3.
const TABLE: [(f64, [[f64; 2]; 5]); 2] = [
    (0.1, [[4.2374, 25.2618], [3.4781, 27.6728], [5.6227, 36.9409], [12.4505, 53.2026], [21.8356, 73.5565]]),
    (0.3, [[6.6604, 42.6142], [6.5523, 44.6311], [7.9565, 50.9473], [13.2757, 62.0528], [22.0738, 78.1195]]),
];

/// λ² of nodal diameter i of a plate of outer radius 1. The sectors are many, so that a harmonic's two lowest modes are
/// those of its own nodal diameter and not of N − i.
fn lambda(order: ElementOrder, ratio: f64, thickness: f64, radial: usize, i: usize) -> [f64; 2] {
    let p = AnnulusParameters {
        sectors: 24,
        inner_radius: ratio,
        outer_radius: 1.0,
        thickness,
        clamped_bore: true,
        elements: [radial, 2, 1],
        element_order: order,
        material: Material { youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0 },
        top_speed_rad_s: 1e-6,
        ..AnnulusParameters::default()
    };
    let package = annulus(&p).unwrap();
    let k = harmonic(&package, &package.stiffness[0], i);
    let values = lowest(&k, &harmonic(&package, &package.mass, i), 2).unwrap();
    let unit = thickness / (12.0 * (1.0 - 0.3_f64.powi(2))).sqrt();
    std::array::from_fn(|s| values[s].sqrt() / unit)
}

#[test]
fn explore() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        for (ratio, rows) in TABLE {
            for thickness in [0.02, 0.01, 0.005] {
                for (i, exact) in rows.iter().enumerate() {
                    print!("{order:?} {ratio} h {thickness} i {i}:");
                    for radial in [4, 8, 16] {
                        let l = lambda(order, ratio, thickness, radial, i);
                        print!("  {:.3e} {:.3e}", l[0] / exact[0] - 1.0, l[1] / exact[1] - 1.0);
                    }
                    println!();
                }
            }
        }
    }
}
