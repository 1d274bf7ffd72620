//! Rotating uniform cantilever (Wright, Smith, Thresher and Wang, J. Appl. Mech. 49, 1982): flap against the table, lag² = flap² − Ω².

use rubmap::assembly::SectorMatrices;
use rubmap::impeller::mesh::ElementOrder::{self, Linear, Quadratic};
use rubmap::impeller::{CantileverParameters, Material, cantilever, cantilever_mesh};

use crate::eigen::{dense_eigenvalues, lowest_real};

/// Frequencies ω* of flap modes 1 and 2 at η (Wright et al. 1982, recomputed by Legendre–Ritz).
pub(crate) const TABLE: [(f64, [f64; 2]); 4] = [
    (0.0, [3.51602, 22.03449]),
    (2.0, [4.13732, 22.61492]),
    (4.0, [5.58500, 24.27335]),
    (8.0, [9.25684, 29.99538]),
];

/// Square beam of unit length, E = ρ = A = 1; slenderness = length/side.
struct Beam {
    matrices: SectorMatrices,
    /// Unit of frequencies, √(EI/m)/L².
    unit: f64,
}

impl Beam {
    fn new(element_order: ElementOrder, slenderness: f64, elements: usize, poissons_ratio: f64) -> Self {
        let p = CantileverParameters {
            length: slenderness,
            width: 1.0,
            depth: 1.0,
            elements: [elements, 1, 1],
            element_order,
            material: Material { youngs_modulus: 1.0, poissons_ratio, density: 1.0, ..Material::default() },
            ..CantileverParameters::default()
        };
        let matrices = SectorMatrices::assemble(&cantilever_mesh(&p).unwrap().made_of(&p.material)).unwrap();
        Self { matrices, unit: (1.0_f64 / 12.0).sqrt() / slenderness.powi(2) }
    }

    /// Frequencies ω* of the four lowest modes at η, ascending: lag and flap of the first, then of the second family.
    fn frequencies(&self, eta: f64) -> [f64; 4] {
        let omega = eta * self.unit;
        let values = lowest_real(&self.matrices.stiffness(omega), &self.matrices.rest.mass(), 4).unwrap();
        std::array::from_fn(|j| values[j].sqrt() / self.unit)
    }
}

/// Relative errors of the flap modes and of lag² = flap² − Ω² at every η of the table.
fn errors(beam: &Beam) -> Vec<([f64; 2], [f64; 2])> {
    TABLE
        .iter()
        .map(|&(eta, exact)| {
            let f = beam.frequencies(eta);
            let flap = [f[1], f[3]];
            let lag = [f[0], f[2]];
            let flap_error = [0, 1].map(|j| flap[j] / exact[j] - 1.0);
            let lag_error = [0, 1].map(|j| (flap[j].powi(2) - eta * eta).sqrt() / lag[j] - 1.0);
            (flap_error, lag_error)
        })
        .collect()
}

/// Flap frequencies with ν = 0 (no clamping effect of the section), slenderness 200: mode 1 within 2e-5 of Euler–Bernoulli
/// with either element, mode 2 within 4e-4 (80 of 8 nodes) and 1e-4 (64 of 20). The rest is the mesh (next tests) and
/// shear and rotary inertia, −1e-5 at this slenderness.
#[test]
fn flap_frequencies_meet_the_table() {
    for (beam, second) in
        [(Beam::new(Linear, 200.0, 80, 0.0), 4e-4), (Beam::new(Quadratic, 200.0, 64, 0.0), 1e-4)]
    {
        for (&(eta, _), (flap, _)) in TABLE.iter().zip(errors(&beam)) {
            assert!(flap[0].abs() < 2e-5 && flap[1].abs() < second, "η = {eta}: {flap:?}");
        }
    }
}

/// Elements of 8 nodes: halving them divides the error of mode 2 by four, at rest and at every speed (second order; measured 4.2 to 5).
#[test]
fn linear_elements_converge_at_second_order() {
    let coarse = errors(&Beam::new(Linear, 200.0, 20, 0.0));
    let fine = errors(&Beam::new(Linear, 200.0, 40, 0.0));
    for (i, (coarse, fine)) in coarse.iter().zip(&fine).enumerate() {
        let ratio = coarse.0[1] / fine.0[1];
        assert!((3.7..5.0).contains(&ratio), "η = {}: {ratio:.2}", TABLE[i].0);
    }
}

/// Elements of 20 nodes: fourth order towards the beam's own limit (64 elements) once an element is about as long as
/// the beam is high, at rest and at every speed. Longer elements bend through parasitic shear, at second order.
#[test]
fn quadratic_elements_converge_at_fourth_order() {
    let [coarse, fine, limit] = [16, 32, 64].map(|n| errors(&Beam::new(Quadratic, 20.0, n, 0.0)));
    for i in 0..TABLE.len() {
        let order = ((coarse[i].0[1] - limit[i].0[1]) / (fine[i].0[1] - limit[i].0[1])).log2();
        println!("η = {}: order {order:.2}", TABLE[i].0);
        assert!((order - 4.0).abs() < 0.4, "η = {}: {order:.2}", TABLE[i].0);
    }
}

/// Lag² = flap² − Ω² is exact for a line; a section of finite height departs by its own rotary inertia, as
/// (side/length)² (measured at η = 8: 9.7e-5 at slenderness 100, 2.4e-5 at 200).
#[test]
fn spin_softens_lag_by_the_speed_squared() {
    for order in [Linear, Quadratic] {
        let slender = errors(&Beam::new(order, 200.0, 40, 0.0));
        let stout = errors(&Beam::new(order, 100.0, 40, 0.0));
        for (i, (_, lag)) in slender.iter().enumerate() {
            assert!(lag[0].abs() < 3e-5 && lag[1].abs() < 1e-5, "η = {}: {lag:?}", TABLE[i].0);
        }
        let ratio = stout[3].1[0] / slender[3].1[0];
        assert!((3.8..4.2).contains(&ratio), "{order:?}: {ratio:.3}");
    }
}

/// Poisson's ratio ν = 0.3: the clamp holds the section's own lateral strain over about one height: 4.4e-4 at this mesh.
#[test]
fn poissons_ratio_only_stiffens_the_clamp() {
    for (flap, lag) in errors(&Beam::new(Linear, 200.0, 160, 0.3)) {
        assert!(flap.iter().all(|&e| e > 0.0 && e < 6e-4), "{flap:?}");
        assert!(lag[0].abs() < 3e-5, "{lag:?}");
    }
}

/// The sparse iteration agrees with the dense solver where both run.
#[test]
fn subspace_iteration_agrees_with_the_dense_solver() {
    let beam = Beam::new(Linear, 20.0, 6, 0.3);
    let k = beam.matrices.stiffness(2.0 * beam.unit);
    let dense = dense_eigenvalues(&k, &beam.matrices.rest.mass());
    let sparse = lowest_real(&k, &beam.matrices.rest.mass(), 6).unwrap();
    for (d, s) in dense.iter().zip(&sparse) {
        // M spans six decades here; its Cholesky factor costs the dense route a few digits.
        assert!((d / s - 1.0).abs() < 1e-8, "{d} {s}");
    }
}

#[test]
fn package_of_the_beam_is_one_sector_without_cyclic_faces() {
    let p = CantileverParameters::default();
    let package = cantilever(&p).unwrap();
    assert_eq!(package.manifest.sectors, 1);
    assert!(package.manifest.cyclic.is_empty());
    let [nx, ny, nz] = p.elements;
    assert_eq!(package.dofs.len(), 3 * nx * (ny + 1) * (nz + 1));
    assert_eq!(package.manifest.contact.len(), nz + 1);
    assert_eq!(package.stiffness.len(), 3);
    assert_eq!(package.mass.size, package.dofs.len());
}
