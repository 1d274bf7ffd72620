//! Stress of bodies that spin.

use faer::{Mat, c64};
use rubmap_model::assembly::SectorMatrices;
use rubmap_model::impeller::mesh::ElementOrder;
use rubmap_model::impeller::{AnnulusParameters, Material, annulus_mesh};
use rubmap_solid::stress::NodalStress;

use crate::claim::{Check, Claim, Computed};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "spinning-disk",
    covers: &[],
    claim: "Nodal stresses under centrifugal load are those of a spinning disk.",
    reference: "closed form in plane stress (Timoshenko and Goodier, Theory of Elasticity, art. 32): disk held at its bore, free at its rim",
    quantity: "largest error of radial and hoop stress off the bore, over the radial stress at the bore",
    check: Check::Computed(Computed {
        error: spinning_disk,
        wrong: "density",
        limit: 3e-3,
        reason: "mesh of 24 elements of 20 nodes across; points within four thicknesses of the bore, which is held axially too, are left out",
    }),
}];

fn spinning_disk(wrong: f64) -> anyhow::Result<f64> {
    let material = Material::default();
    let p = AnnulusParameters {
        elements: [24, 2, 1],
        element_order: ElementOrder::Quadratic,
        ..AnnulusParameters::default()
    };
    let (e, nu, rho) = (material.youngs_modulus, material.poissons_ratio, material.density);
    let made = annulus_mesh(&p)?.made_of(&Material { density: wrong * rho, ..material });
    let moved = SectorMatrices::assemble(&made)?.prestress.displacements;
    let operator = NodalStress::new(&made.mesh);
    let u = Mat::from_fn(3 * moved.len(), 1, |row, _| c64::from(moved[row / 3][row % 3]));
    let found = operator.apply(c64::ONE, u.as_ref());
    let (a, b) = (p.inner_radius, p.outer_radius);
    // Displacement c₁r + c₂/r − kr³ with none at a and σ_rr none at b.
    let k = (1.0 - nu * nu) * rho / (8.0 * e);
    let c1 = k * ((3.0 + nu) * b * b + (1.0 - nu) * a.powi(4) / (b * b))
        / (1.0 + nu + (1.0 - nu) * a * a / (b * b));
    let c2 = k * a.powi(4) - c1 * a * a;
    let exact = |r: f64| {
        let (sum, apart) = ((1.0 + nu) * c1, (1.0 - nu) * c2 / (r * r));
        let plane = e / (1.0 - nu * nu);
        [plane * (sum - apart - k * (3.0 + nu) * r * r), plane * (sum + apart - k * (1.0 + 3.0 * nu) * r * r)]
    };
    let mut most = 0.0f64;
    for (place, &node) in operator.places().iter().enumerate() {
        let [x, y, _] = made.mesh.nodes[node as usize];
        let r = x.hypot(y);
        if r > a + 4.0 * p.thickness {
            for (component, exact) in exact(r).into_iter().enumerate() {
                most = most.max((found[(6 * place + component, 0)].re - exact).abs());
            }
        }
    }
    Ok(most / exact(a)[0])
}
