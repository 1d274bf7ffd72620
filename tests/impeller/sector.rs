//! Assembled sectors of both element orders: mass, rigid bodies, symmetry, definiteness.

use faer::sparse::{SparseColMat, Triplet};
use rubmap::assembly::{RestMatrices, SectorMatrices};
use rubmap::impeller::mesh::{ElementOrder, SectorMesh};
use rubmap::impeller::{
    AnnulusParameters, ImpellerParameters, Material, MeshDensities, Preset, annulus_mesh, impeller_sector,
};
use rubmap::numerics::sparse_cholesky::{SparseCholesky, SymbolicFactor};
use rubmap::package::raw::RawMatrix;
use rubmap::solid::material::Stress;

use crate::eigen::dense;
use crate::packed::cylindrical_frame;

const ORDERS: [ElementOrder; 2] = [ElementOrder::Linear, ElementOrder::Quadratic];

fn impeller(element_order: ElementOrder) -> SectorMesh {
    let mesh = MeshDensities {
        between_contact_nodes: 1,
        blade_height: 1,
        blade_thickness: 1,
        half_passage: 1,
        disk: 1,
    };
    impeller_sector(&ImpellerParameters { contact_nodes: 5, element_order, mesh, ..Default::default() })
        .unwrap()
}

/// Mass of a sector of a disk, ρ π (b² − a²) t / N: fourth order in the angle of an element with 20 nodes, whose edges
/// are parabolas, second order with 8, whose edges are chords.
#[test]
fn mass_of_a_disk_converges_to_density_times_volume() {
    for (order, expected) in [(ElementOrder::Linear, 4.0), (ElementOrder::Quadratic, 16.0)] {
        let error = |around: usize| {
            let p = AnnulusParameters {
                sectors: 6,
                elements: [1, around, 1],
                element_order: order,
                clamped_bore: false,
                ..Default::default()
            };
            let exact = p.material.density
                * std::f64::consts::PI
                * (p.outer_radius.powi(2) - p.inner_radius.powi(2))
                * p.thickness
                / 6.0;
            let rest = RestMatrices::assemble(&annulus_mesh(&p).unwrap().made_of(&p.material));
            // A translation along z is the same in every frame.
            let along_z: Vec<f64> =
                rest.dofs.list.iter().map(|&(_, c)| f64::from(u8::from(c == 2))).collect();
            dot(&along_z, &product(&rest.mass(), &along_z)) / exact - 1.0
        };
        let (coarse, fine) = (error(2), error(4));
        println!("{order:?}: mass {coarse:.2e} {fine:.2e}");
        assert!(((coarse / fine) / expected - 1.0).abs() < 0.05, "{order:?}: {coarse:.2e} {fine:.2e}");
    }
}

/// Sector without clamps: translations carry the same mass in every direction, and neither they nor turns cost energy.
#[test]
fn free_sector_moves_as_a_rigid_body_without_forces() {
    for order in ORDERS {
        let mut sector = impeller(order);
        sector.clamped.fill([false; 3]);
        let rest = RestMatrices::assemble(&sector.made_of(&Material::default()));
        let (m, k) = (rest.mass(), rest.stiffness());
        let field = |u: &dyn Fn([f64; 3]) -> [f64; 3]| -> Vec<f64> {
            let component = |&(node, component): &(usize, usize)| {
                let frame = cylindrical_frame(sector.mesh.angle(node));
                (frame * nalgebra::Vector3::from(u(sector.mesh.nodes[node])))[component]
            };
            rest.dofs.list.iter().map(component).collect()
        };
        let largest = k.entries.iter().map(|e| e.2.abs()).fold(0.0, f64::max);
        let total: f64 = {
            let along_z = field(&|_| [0.0, 0.0, 1.0]);
            dot(&along_z, &product(&m, &along_z))
        };
        for d in 0..3 {
            let translation = field(&|_| std::array::from_fn(|i| f64::from(u8::from(i == d))));
            let mass = dot(&translation, &product(&m, &translation));
            assert!((mass / total - 1.0).abs() < 1e-12, "{mass} {total}");
            let turn = field(&|x| {
                let mut u = [0.0; 3];
                u[(d + 1) % 3] = -x[(d + 2) % 3] / 100.0;
                u[(d + 2) % 3] = x[(d + 1) % 3] / 100.0;
                u
            });
            for mode in [translation, turn] {
                let force = product(&k, &mode).iter().fold(0.0_f64, |m, f| m.max(f.abs()));
                assert!(force < 1e-12 * largest, "direction {d}: {force:e} of {largest:e}");
            }
        }
        // Six zero eigenvalues and no more; the rest positive.
        let values = dense(&k).self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        assert!(values[..6].iter().all(|v| v.abs() < 1e-11 * values[values.len() - 1]), "{:?}", &values[..7]);
        assert!(values[6] > 1e3 * values[5].abs(), "{:?}", &values[..7]);
    }
}

/// Matrices have one lower triangle each, sorted, in one pattern; M and K of the clamped sector are positive definite.
#[test]
fn matrices_are_symmetric_and_definite() {
    for order in ORDERS {
        let p = ImpellerParameters::default();
        let matrices = SectorMatrices::assemble(&impeller(order).made_of(&p.material)).unwrap();
        let (m, k) = (matrices.rest.mass(), matrices.rest.stiffness());
        let place = |e: &(u32, u32, f64)| (e.1, e.0);
        for matrix in [&m, &k, &matrices.stiffness(p.top_speed_rad_s)] {
            assert!(matrix.entries.iter().map(place).eq(k.entries.iter().map(place)));
            assert!(matrix.entries.iter().all(|&(row, column, _)| row >= column));
            assert!(matrix.entries.is_sorted_by(|a, b| place(a) < place(b)));
            assert!(dense(matrix).llt(faer::Side::Lower).is_ok(), "{order:?}");
        }
    }
}

/// Medium preset at its Ω1: stresses stay below the 828 MPa at which Ti-6Al-4V may yield (ASTM B265, grade 5), and K is
/// positive definite even with both cyclic faces free, hence for every nodal diameter, each a restriction of it.
#[test]
fn medium_wheel_stands_its_top_speed() {
    let p = Preset::Medium.parameters();
    let matrices = SectorMatrices::assemble(&impeller_sector(&p).unwrap().made_of(&p.material)).unwrap();
    let von_mises = |s: &Stress| {
        let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
        (0.5 * normal + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])).sqrt()
    };
    let stresses = matrices.prestress.stresses.iter().flatten();
    let largest = stresses.map(von_mises).fold(0.0, f64::max) * p.top_speed_rad_s.powi(2);
    println!("largest von Mises stress {largest:.0} MPa");
    assert!((100.0..828.0).contains(&largest), "{largest}");

    let k = matrices.stiffness(p.top_speed_rad_s);
    let triplets: Vec<_> =
        k.entries.iter().map(|&(row, column, v)| Triplet::new(row as usize, column as usize, v)).collect();
    let k = SparseColMat::try_new_from_triplets(k.size, k.size, &triplets).unwrap();
    let nodes: Vec<usize> = matrices.rest.dofs.list.iter().map(|&(node, _)| node).collect();
    assert!(SparseCholesky::new(&SymbolicFactor::new(k.symbolic(), &nodes), &k).is_ok());
}

/// Elements are computed by as many threads as there are and summed in their order.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let p = ImpellerParameters { element_order: ElementOrder::Quadratic, ..ImpellerParameters::default() };
    let sector = impeller_sector(&p).unwrap();
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let matrices = pool.install(|| SectorMatrices::assemble(&sector.made_of(&p.material))).unwrap();
        (matrices.rest.mass(), matrices.stiffness(p.top_speed_rad_s), matrices.prestress.stresses)
    });
    assert!(one == three);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn product(matrix: &RawMatrix, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; matrix.size];
    for &(r, c, v) in &matrix.entries {
        let (r, c) = (r as usize, c as usize);
        y[r] += v * x[c];
        if r != c {
            y[c] += v * x[r];
        }
    }
    y
}
