//! Annular plates, clamped inside and free outside, against the zeros of the determinant of Bessel functions of Kirchhoff's plate.

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{AnnulusParameters, Material, annulus};

use crate::eigen::{harmonic, lowest};

/// Zeros λ² = ωa²√(ρh/D) per b/a and nodal diameter, without and with one nodal circle; ν = 0.3.
pub(crate) const TABLE: [(f64, [[f64; 2]; 5]); 2] = [
    (0.1, [[4.2374, 25.2618], [3.4781, 27.6728], [5.6227, 36.9409], [12.4505, 53.2026], [21.8356, 73.5565]]),
    (0.3, [[6.6604, 42.6142], [6.5523, 44.6311], [7.9565, 50.9473], [13.2757, 62.0528], [22.0738, 78.1195]]),
];

/// Mesh of an annulus of outer radius one and unit stiffness and density, clamped inside, `radial` elements across.
pub(crate) fn unit_annulus(
    element_order: ElementOrder,
    inner_radius: f64,
    thickness: f64,
    radial: usize,
    top_speed_rad_s: f64,
) -> AnnulusParameters {
    AnnulusParameters {
        sectors: 48,
        inner_radius,
        outer_radius: 1.0,
        thickness,
        clamped_bore: true,
        elements: [radial, 2, 1],
        element_order,
        material: Material { youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0, ..Material::default() },
        top_speed_rad_s,
        ..AnnulusParameters::default()
    }
}

/// Frequency parameter λ² of nodal diameter i of a plate of outer radius 1. The sectors are many, so that a harmonic's
/// two lowest modes are those of its own nodal diameter and not of N − i.
fn lambda(order: ElementOrder, ratio: f64, thickness: f64, radial: usize, i: usize) -> [f64; 2] {
    let p = unit_annulus(order, ratio, thickness, radial, 1e-6);
    let package = annulus(&p).unwrap();
    let k = harmonic(&package, &package.stiffness[0], i);
    let values = lowest(&k, &harmonic(&package, &package.mass, i), 2).unwrap();
    let unit = thickness / (12.0 * (1.0 - 0.3_f64.powi(2))).sqrt();
    std::array::from_fn(|s| values[s].sqrt() / unit)
}

/// Annular plates of both elements, thickness 0.01, all ten modes of both tables within 1 % (measured: 0.9 % with 8
/// nodes, 0.53 % with 20; shear and rotary inertia take up to 0.2 % of it, the rest is the mesh).
#[test]
fn annular_plate_meets_the_table() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        for (ratio, rows) in TABLE {
            for (i, exact) in rows.iter().enumerate() {
                let ours = lambda(order, ratio, 0.01, 32, i);
                for (ours, exact) in ours.into_iter().zip(exact) {
                    let error = ours / exact - 1.0;
                    assert!(error.abs() < 0.01, "{order:?}, b/a {ratio}, nodal diameter {i}: {error:.2e}");
                }
            }
        }
    }
}

/// Thin plates leave the table with the square of their thickness: shear and rotary inertia.
#[test]
fn thickness_lowers_the_frequencies_quadratically() {
    let exact = TABLE[1].1[4][1];
    let [thick, thin] = [0.04, 0.02].map(|h| lambda(ElementOrder::Quadratic, 0.3, h, 32, 4)[1] / exact - 1.0);
    println!("thickness: {thick:.2e} {thin:.2e}");
    assert!(
        thick < thin && thin < 0.0 && ((thick / thin).log2() - 2.0).abs() < 0.25,
        "{thick:.2e} {thin:.2e}"
    );
}

/// Thin plates of elements ten times longer than thick and more: second order for both, since 20 nodes at full integration
/// bend a thin plate through parasitic shear (measured 2.03 and 1.93). Fourth order, with elements as long as thick:
/// `beam`, `annulus`.
#[test]
fn thin_plate_converges_at_second_order() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        let [a, b, c] = [8, 16, 32].map(|radial| lambda(order, 0.3, 0.01, radial, 0)[1]);
        let measured = ((a - b) / (b - c)).log2();
        println!("{order:?}: order {measured:.2}");
        assert!((measured - 2.0).abs() < 0.2, "{order:?}: {measured:.2}");
    }
}
