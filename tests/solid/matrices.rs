//! Stiffness and mass of every element: those that CalculiX stores, and forces that nothing may make.

use std::collections::HashMap;

use faer::Mat;
use faer::linalg::solvers::Solve;
use nalgebra::{DMatrix, Vector3};
use rubmap::solid::element::ElementKind;
use rubmap::solid::integrals::{centrifugal_load, geometric_stiffness, gyroscopic, mass, stiffness};
use rubmap::solid::load;
use rubmap::solid::material::Stress;
use rubmap::solid::mesh::SectorMesh;
use rubmap::solid::rule::{MassRule, points};

use crate::calculix::{its_own, run};
use crate::crooked::crooked;
use crate::deck::deck;
use crate::meshes::block;

/// Sum of the elements' matrices over the nodes of a mesh, x, y, z of each.
fn assembled(mesh: &SectorMesh, of: impl Fn(ElementKind, &[[f64; 3]]) -> DMatrix<f64>) -> Mat<f64> {
    let mut sum = Mat::zeros(3 * mesh.nodes.len(), 3 * mesh.nodes.len());
    for element in &mesh.elements {
        let matrix = of(element.kind, &mesh.positions(element));
        for (a, &row) in element.nodes.iter().enumerate() {
            for (b, &column) in element.nodes.iter().enumerate() {
                for i in 0..3 {
                    for j in 0..3 {
                        sum[(3 * row as usize + i, 3 * column as usize + j)] +=
                            matrix[(3 * a + i, 3 * b + j)];
                    }
                }
            }
        }
    }
    sum
}

fn stiffness_of(mesh: &SectorMesh) -> Mat<f64> {
    let constants = mesh.sets[0].material.lame_constants();
    assembled(mesh, |kind, at| {
        let blocks = stiffness(kind, at, constants);
        DMatrix::from_fn(3 * at.len(), 3 * at.len(), |i, j| blocks[(i / 3, j / 3)][(i % 3, j % 3)])
    })
}

fn mass_of(mesh: &SectorMesh, rule: MassRule) -> Mat<f64> {
    let density = mesh.sets[0].material.density;
    assembled(mesh, |kind, at| {
        let nodal = mass(kind, at, density, rule);
        DMatrix::from_fn(
            3 * at.len(),
            3 * at.len(),
            |i, j| if i % 3 == j % 3 { nodal[(i / 3, j / 3)] } else { 0.0 },
        )
    })
}

/// Matrix that CalculiX stored, in the order of `dofs`.
fn stored(text: &str, rows: &HashMap<usize, usize>, size: usize) -> Mat<f64> {
    let mut full = Mat::zeros(size, size);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = |k: usize| rows[&words[k].parse().unwrap()];
        let value: f64 = words[2].parse().unwrap();
        (full[(at(0), at(1))], full[(at(1), at(0))]) = (value, value);
    }
    full
}

/// Stiffness of the first `kept` displacements, the others following statically.
fn condensed(full: &Mat<f64>, kept: usize) -> Mat<f64> {
    let rest = full.nrows() - kept;
    let own = full.submatrix(0, 0, kept, kept).to_owned();
    if rest == 0 {
        return own;
    }
    let coupling = full.submatrix(kept, 0, rest, kept);
    let factor = full.submatrix(kept, kept, rest, rest).llt(faer::Side::Lower).unwrap();
    own - coupling.transpose() * factor.solve(coupling)
}

/// Largest difference of two matrices in parts of the largest entry.
fn difference(ours: &Mat<f64>, theirs: &Mat<f64>) -> f64 {
    (ours - theirs).norm_max() / theirs.norm_max()
}

/// CalculiX stores sixteen digits.
#[test]
fn matrices_are_those_of_calculix() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| its_own(*kind)) {
        let mesh = block(kind, [2, 1, 1], |at| crooked(at, 0.1));
        let step = "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n*END STEP\n";
        let Some(folder) = run(&(deck(&mesh) + step)) else { return };
        let read =
            |extension| std::fs::read_to_string(folder.path().join(format!("block.{extension}"))).unwrap();
        let place = |(row, dof): (usize, &str)| {
            let (node, component) = dof.trim().split_once('.').unwrap();
            let at = 3 * (node.parse::<usize>().unwrap() - 1) + component.parse::<usize>().unwrap() - 1;
            (row + 1, at)
        };
        let rows: HashMap<usize, usize> = read("dof").lines().enumerate().map(place).collect();
        // Incompatible modes are displacements of nodes of their own.
        let size = rows.values().max().unwrap() + 1;
        let nodes = 3 * mesh.nodes.len();
        let of_stiffness =
            difference(&stiffness_of(&mesh), &condensed(&stored(&read("sti"), &rows, size), nodes));
        let theirs = stored(&read("mas"), &rows, size);
        let of_mass = difference(
            &mass_of(&mesh, MassRule::AsStiffness),
            &theirs.submatrix(0, 0, nodes, nodes).to_owned(),
        );
        println!("{kind:?}: stiffness {of_stiffness:.1e}, mass {of_mass:.1e}");
        assert!(of_stiffness < 1e-12, "{kind:?}: {of_stiffness:e}");
        assert!(of_mass < 1e-12, "{kind:?}: {of_mass:e}");
    }
}

/// Rigid motions of a free mesh: no elastic force; its mass, and the load of its own spin as `load` integrates it.
#[test]
fn rigid_motions_make_no_force_and_have_the_mass() {
    for kind in ElementKind::ALL {
        let mesh = block(kind, [2, 2, 1], |at| crooked(at, 0.1));
        let (k, m) = (stiffness_of(&mesh), mass_of(&mesh, MassRule::Consistent));
        let motion = |of: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
            Mat::from_fn(3 * mesh.nodes.len(), 1, |row, _| of(mesh.nodes[row / 3].into())[row % 3])
        };
        let total: f64 = load::volumes(&mesh).iter().sum::<f64>() * mesh.sets[0].material.density;
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let (along, around) = (motion(&|_| axis), motion(&|x| axis.cross(&x)));
            for rigid in [&along, &around] {
                assert!((&k * rigid).norm_max() < 1e-13 * k.norm_max(), "{kind:?}");
            }
            // Fewer points than the shape needs lose some of the mass of crooked elements.
            let moved = (along.transpose() * &m * &along)[(0, 0)];
            assert!((moved / total - 1.0).abs() < 2e-3, "{kind:?}: {moved} {total}");
        }
        assert!(m.llt(faer::Side::Lower).is_ok(), "{kind:?}: the mass is positive definite");
    }
}

/// Gyroscopic forces, spin and geometric stiffness of one element of each kind: closed forms for linear fields.
#[test]
fn matrices_of_spin_act_on_linear_fields_as_they_must() {
    let axis = Vector3::new(0.2, -0.5, 0.8).normalize();
    let origin = Vector3::new(0.3, 0.1, -0.2);
    for kind in ElementKind::ALL {
        let mesh = block(kind, [1, 1, 1], |at| crooked(at, 0.08));
        for element in &mesh.elements {
            let at = mesh.positions(element);
            let m = mass(kind, &at, 2.5, MassRule::Consistent);
            let nodes = at.len();
            let load = centrifugal_load(&m, &at, origin, axis);
            let g = gyroscopic(&m, axis);
            for a in 0..nodes {
                // Turning with the speed −e × r, a body at rest in space feels −2 e × (e × r): twice the centrifugal load.
                let coriolis: Vector3<f64> =
                    (0..nodes).map(|b| g[(a, b)] * -axis.cross(&(Vector3::from(at[b]) - origin))).sum();
                assert!(
                    (coriolis - load[a] * 2.0).norm() < 1e-12 * load.iter().map(|f| f.norm()).sum::<f64>()
                );
            }
            let stress = Stress::new(3.0, -1.0, 2.0, 0.5, 0.2, -0.4);
            let k = geometric_stiffness(kind, &at, &vec![stress; points(kind).len()]);
            let sum: f64 = k.iter().sum();
            assert!(sum.abs() < 1e-12 * k.amax(), "{kind:?}: no force on a translation");
            assert!((&k - k.transpose()).amax() == 0.0);
        }
    }
}

/// Consistent mass of straight tetrahedra of ten nodes in closed form (volume 1, density 1): corners 1/70, corner with corner 1/420, edge 4/105, and
/// no dependence on which corner comes first.
#[test]
fn consistent_mass_of_quadratic_tetrahedra_is_exact() {
    let corners = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.2, 1.0]];
    let order = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    for turned in [[0, 1, 2, 3], [1, 2, 0, 3], [3, 1, 0, 2], [2, 3, 0, 1]] {
        let corners = turned.map(|k: usize| corners[k]);
        let middles =
            order.map(|[a, b]: [usize; 2]| std::array::from_fn(|d| 0.5 * (corners[a][d] + corners[b][d])));
        let at: Vec<[f64; 3]> = corners.into_iter().chain(middles).collect();
        let m = mass(ElementKind::C3D10, &at, 1.0, MassRule::Consistent);
        for (place, expected) in [
            ((0, 0), 6.0),
            ((3, 3), 6.0),
            ((0, 3), 1.0),
            ((0, 4), -4.0),
            ((0, 5), -6.0),
            ((4, 4), 32.0),
            ((4, 5), 16.0),
            ((4, 9), 8.0),
        ] {
            assert!(
                (m[place] * 420.0 - expected).abs() < 1e-12,
                "{turned:?} {place:?}: {} {expected}",
                m[place] * 420.0
            );
        }
    }
}
