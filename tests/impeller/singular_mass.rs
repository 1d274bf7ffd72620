//! Mass without full rank, as elements with few points of integration leave it (C3D15 and C3D20R of CalculiX): its zeros
//! lie at ±round-off. Modes do not need it definite; only a mass that is negative by more is refused, at the upload.

use std::collections::BTreeMap;

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side, c64};
use nalgebra::SVector;
use rubmap::assembly::{RestMatrices, SectorDofs};
use rubmap::dynamics::reduction::{Completeness, NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::impeller::mesh::{Elements, SectorMesh};
use rubmap::impeller::{AnnulusParameters, Material, annulus_mesh};
use rubmap::package::raw::{RawMatrix, RawPackage};
use rubmap::package::{PackageError, to_sector};
use rubmap::solid::element::ElementKind;
use rubmap::solid::gauss::gauss_points;
use rubmap::solid::jacobian;
use rubmap::solid::shape::hexahedron::quadratic;

use super::eigen::harmonic;
use super::packed::{cylindrical_frame, packed};

const SECTORS: usize = 5;

/// Numbers of elements: small enough to be solved densely, and large enough for the iteration.
const MESHES: [[usize; 3]; 2] = [[3, 2, 1], [8, 3, 1]];

fn mesh(elements: [usize; 3]) -> SectorMesh {
    let p = AnnulusParameters { sectors: SECTORS, elements, ..AnnulusParameters::default() };
    annulus_mesh(&p).unwrap()
}

/// Disk of quadratic hexahedra whose mass is integrated at four points of eight: rank 12 of an element's 60. `density`
/// of each element in parts of the material's, and every diagonal less by `shift` of itself.
fn disk(elements: [usize; 3], density: impl Fn(usize) -> f64, shift: f64) -> RawPackage {
    let (sector, material) = (mesh(elements), Material::default());
    let Elements::Quadratic(elements) = &sector.mesh.elements else { unreachable!("quadratic by default") };
    let made = sector.made_of(&material);
    let dofs = SectorDofs::new(&made);
    let mut entries: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for (e, nodes) in elements.iter().enumerate() {
        let positions = sector.mesh.positions(nodes);
        let tetrahedron = gauss_points(2).iter().filter(|p| p.xi.iter().product::<f64>() > 0.0);
        for point in tetrahedron {
            let n = SVector::<f64, 20>::from(quadratic(point.xi));
            let weight =
                2.0 * point.weight * jacobian(ElementKind::C3D20, &positions, point.xi).determinant();
            let m = n * n.transpose() * (density(e) * material.density * weight);
            for (a, &row_node) in nodes.iter().enumerate() {
                for (b, &column_node) in nodes.iter().enumerate() {
                    let frame = |node| cylindrical_frame(sector.mesh.angle(node));
                    let block = frame(row_node) * frame(column_node).transpose() * m[(a, b)];
                    for (i, row) in dofs.rows[row_node].iter().enumerate() {
                        for (j, column) in dofs.rows[column_node].iter().enumerate() {
                            if let (Some(row), Some(column)) = (*row, *column)
                                && row >= column
                            {
                                *entries.entry((column as u32, row as u32)).or_default() += block[(i, j)];
                            }
                        }
                    }
                }
            }
        }
    }
    let lessened = |row, column, value: f64| if row == column { value * (1.0 - shift) } else { value };
    let mut package = packed("disk", &sector, &material, &AnnulusParameters::default().units, 1000.0);
    package.mass = RawMatrix {
        size: dofs.list.len(),
        entries: entries.iter().map(|(&(c, r), &v)| (r, c, lessened(r, c, v))).collect(),
    };
    package.stiffness = vec![RestMatrices::assemble(&made).stiffness()];
    package.manifest.stiffness.truncate(1);
    package.manifest.speeds_rad_s = vec![0.0];
    package
}

/// Eigenvalues, ascending, of M̂(i) scaled to a unit diagonal.
fn scaled_mass(package: &RawPackage, i: usize) -> Vec<f64> {
    let m = harmonic(package, &package.mass, i).to_dense();
    let scale = |k: usize| 1.0 / m[(k, k)].re.sqrt();
    let scaled = Mat::from_fn(m.nrows(), m.ncols(), |r, c| m[(r, c)] * (scale(r) * scale(c)));
    scaled.self_adjoint_eigenvalues(Side::Lower).unwrap()
}

/// Frequencies ω of nodal diameter i, ascending, by the dense problem M̂ x = θ K̂ x, whose largest θ = 1/ω² need no definite mass.
fn frequencies(package: &RawPackage, i: usize) -> Vec<f64> {
    let factor = harmonic(package, &package.stiffness[0], i).to_dense().llt(Side::Lower).unwrap();
    let mut a: Mat<c64> = harmonic(package, &package.mass, i).to_dense();
    for _ in 0..2 {
        solve_lower_triangular_in_place(factor.L(), a.as_mut(), Par::Seq);
        a = a.adjoint().to_owned();
    }
    let theta = a.self_adjoint_eigenvalues(Side::Lower).unwrap();
    theta.iter().rev().take_while(|&&theta| theta > 0.0).map(|theta| 1.0 / theta.sqrt()).collect()
}

fn reduced(package: &RawPackage, modes: usize) -> ReducedWheel {
    let sector = to_sector(package.clone()).expect("a mass that carries modes");
    reduce(&sector, &ReductionOptions::new(modes), &NoCheckpoints, &|_, _| true).expect("reduced")
}

#[test]
fn directions_without_mass_at_round_off_are_carried() {
    for elements in MESHES {
        // The shift is as large as CalculiX leaves it: −7.5e-12 of the diagonal.
        let package = disk(elements, |_| 1.0, 7.5e-12);
        let wheel = reduced(&package, 12);
        for (i, compared) in wheel.comparison.iter().enumerate() {
            let mass = scaled_mass(&package, i);
            let without = mass.iter().filter(|value| value.abs() < 1e-10).count();
            assert!(without > 10 && mass[0] < -7e-12, "nodal diameter {i}: {without}, {:e}", mass[0]);
            let certificate = &wheel.harmonics[i].certificates[0];
            assert!(matches!(certificate.completeness, Completeness::Counted(_)), "{certificate:?}");
            let expected = frequencies(&package, i);
            let off = |found: &[f64], m: usize| found[m] / expected[m] - 1.0;
            let full = (0..compared.full.len()).map(|m| off(&compared.full, m).abs()).fold(0.0, f64::max);
            let reduced = (0..4).map(|m| off(&compared.reduced, m)).fold(0.0, f64::max);
            println!(
                "{elements:?}, nodal diameter {i}: {without} of {} without mass, full sector {full:.1e}, reduced {reduced:.1e}",
                mass.len()
            );
            // Frequencies of the full sector are asked for to nine digits; twelve modes give the lowest four to three.
            assert!(full < 1e-8 && reduced < 2e-3, "{elements:?}, nodal diameter {i}: {full:e} {reduced:e}");
        }
    }
}

/// Modes are those with mass: all there are, where more are asked for than have mass. So many modes show it if contact
/// nodes have a motion without mass.
#[test]
fn modes_are_those_with_mass() {
    let every = ReductionOptions::new(1000);
    let mut package = disk(MESHES[0], |_| 1.0, 7.5e-12);
    let sector = to_sector(package.clone()).expect("a mass that carries modes");
    let refused = reduce(&sector, &every, &NoCheckpoints, &|_, _| true).expect_err("a massless boundary");
    assert!(refused.to_string().contains("ask for fewer `modes_per_speed`"), "{refused}");

    let at_contact =
        |row: u32| package.manifest.contact.iter().any(|c| c.node == package.dofs[row as usize].node);
    for (row, column, value) in &mut package.mass.entries {
        if row == column && at_contact(*row) {
            *value *= 1.5;
        }
    }
    let wheel = reduced(&package, 1000);
    for (harmonic, compared) in wheel.harmonics.iter().zip(&wheel.comparison) {
        let certificate = &harmonic.certificates[0];
        let (modes, internal) = (certificate.eigenvalues.len(), sector.own_dofs() - wheel.contact_dofs());
        let off = compared.largest_difference();
        println!("nodal diameter {}: {modes} modes of {internal} DOF, {off:?}", harmonic.harmonic);
        assert!(modes < internal && certificate.completeness == Completeness::Whole, "{certificate:?}");
        // Only what has no mass is left out.
        assert!(off.is_some_and(|(off, _)| off < 1e-7), "{off:?}");
    }
}

fn refused(package: RawPackage) -> String {
    let error = to_sector(package).expect_err("refused");
    assert!(matches!(error, PackageError::Matrix { .. }), "{error}");
    error.to_string()
}

#[test]
fn a_mass_that_is_negative_by_more_is_refused_at_the_upload() {
    let text = refused(disk(MESHES[0], |_| 1.0, 1e-9));
    assert!(text.contains("is negative, by more than round-off, for a motion that node "), "{text}");

    // One element has a negative density, while all diagonals are still positive.
    let package = disk(MESHES[0], |e| if e == 3 { -0.2 } else { 1.0 }, 0.0);
    let mass = harmonic(&package, &package.mass, 0).to_dense();
    assert!((0..mass.nrows()).all(|k| mass[(k, k)].re > 0.0));
    let smallest = scaled_mass(&package, 0)[0];
    assert!(smallest < -1e-3, "{smallest:e}");
    let dofs = package.dofs.clone();
    let text = refused(package);
    println!("{text}");
    let number_after = |word: &str| -> u64 {
        let (_, after) = text.split_once(word).expect(&text);
        after.split(|c: char| !c.is_ascii_digit()).next().and_then(|digits| digits.parse().ok()).expect(&text)
    };
    assert_eq!(dofs[number_after("(row ") as usize - 1].node, number_after("node "), "{text}");
}
