//! Energy of the assembled wheel, computed without any of the importer's steps: what the sector model means.
//!
//! A random displacement of every node of the wheel, in global components, has an energy that the raw sector
//! matrices give sector by sector, and that Y0 and Y1 must give too: Σ_s q_sᵀ Y0 q_s + 2 q_sᵀ Y1 q_{s+1}. Likewise the power
//! of Coriolis forces between two displacements: Σ_s p_sᵀ G0 q_s + p_sᵀ G1 q_{s+1} − q_sᵀ G1 p_{s+1}.

use std::f64::consts::TAU;

use faer::sparse::SparseColMat;
use proptest::prelude::*;
use rubmap::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap::package;
use rubmap::package::raw::{Frame, RawMatrix, RawPackage};

use crate::fixed::fixed;
use crate::sample::{Numbers, Shape, package as sample, turn, unit, with_gyroscopic};

type Vector = [f64; 3];

/// Energy uᵀ A u of one sector, u in the package's frame.
fn raw_energy(matrix: &RawMatrix, u: &[f64]) -> f64 {
    let energy = |&(i, j, value): &(u32, u32, f64)| {
        let twice = if i == j { 1.0 } else { 2.0 };
        twice * value * u[i as usize] * u[j as usize]
    };
    matrix.entries.iter().map(energy).sum()
}

fn bilinear(matrix: &SparseColMat<usize, f64>, left: &[f64], right: &[f64]) -> f64 {
    matrix.triplet_iter().map(|entry| left[entry.row] * entry.val * right[entry.col]).sum()
}

/// Power pᵀ G u of one sector, G skew-symmetric.
fn raw_power(matrix: &RawMatrix, p: &[f64], u: &[f64]) -> f64 {
    let term = |&(i, j, value): &(u32, u32, f64)| {
        let (i, j) = (i as usize, j as usize);
        value * (p[i] * u[j] - p[j] * u[i])
    };
    matrix.entries.iter().map(term).sum()
}

fn folded_power(matrix: &CyclicMatrix, p: &[Vec<f64>], q: &[Vec<f64>]) -> f64 {
    let of = |s: usize| {
        let t = (s + 1) % q.len();
        bilinear(&matrix.own, &p[s], &q[s]) + bilinear(&matrix.next, &p[s], &q[t])
            - bilinear(&matrix.next, &q[s], &p[t])
    };
    (0..q.len()).map(of).sum()
}

fn folded_energy(matrix: &CyclicMatrix, q: &[Vec<f64>]) -> f64 {
    let sectors = q.len();
    let of = |s: usize| {
        bilinear(&matrix.own, &q[s], &q[s]) + 2.0 * bilinear(&matrix.next, &q[s], &q[(s + 1) % sectors])
    };
    (0..sectors).map(of).sum()
}

/// Unit vectors r, θ, z of a node in its own sector.
fn cylindrical(package: &RawPackage, node: u64) -> [Vector; 3] {
    let axis = unit(package.manifest.axis.direction);
    let origin = package.manifest.axis.origin;
    let position = package.nodes.iter().find(|n| n.id == node).expect("a node").position;
    let v: Vector = std::array::from_fn(|k| position[k] - origin[k]);
    let along: f64 = (0..3).map(|k| v[k] * axis[k]).sum();
    let radial = unit(std::array::from_fn(|k| v[k] - along * axis[k]));
    [radial, turn(radial, axis, TAU / 4.0), axis]
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// Random displacement of the wheel, sector by sector: in the rows of the package, and in those of the sector model.
fn displacement(package: &RawPackage, seed: u64) -> [Vec<Vec<f64>>; 2] {
    let sectors = package.manifest.sectors;
    let alpha = TAU / sectors as f64;
    let axis = unit(package.manifest.axis.direction);
    let mut numbers = Numbers(seed);
    // Displacement of node 1, 2, 3, 4 in each sector, as a vector in that sector's own (turned) global frame;
    // partly clamped nodes move along their free directions only.
    let is_free =
        |node: u64, component: u8| package.dofs.iter().any(|d| (d.node, d.component) == (node, component));
    let mut u = vec![[[0.0; 3]; 4]; sectors];
    for sector in &mut u {
        for (node, vector) in (1..).zip(sector) {
            let basis = match package.manifest.frame {
                Frame::Cylindrical => cylindrical(package, node),
                Frame::Cartesian => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            };
            for (component, direction) in (1..).zip(basis) {
                let size = if is_free(node, component) { numbers.next() } else { 0.0 };
                (0..3).for_each(|k| vector[k] += size * direction[k]);
            }
        }
    }
    // The raw displacement of a sector: its own nodes, and on its high face the next sector's low nodes turned.
    let raw = |s: usize| -> Vec<f64> {
        let component = |dof: &rubmap::package::raw::RawDof| {
            let vector = match dof.node {
                own @ 1..=4 => u[s][own as usize - 1],
                high => turn(u[(s + 1) % sectors][high as usize - 5], axis, alpha),
            };
            let basis = match package.manifest.frame {
                Frame::Cylindrical => cylindrical(package, dof.node),
                Frame::Cartesian => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            };
            dot(basis[usize::from(dof.component) - 1], vector)
        };
        package.dofs.iter().map(component).collect()
    };
    let complete = |node: u64| (1..=3).all(|component| is_free(node, component));
    let own = |s: usize| -> Vec<f64> {
        let own_dofs = package.dofs.iter().filter(|dof| dof.node <= 4);
        let component = |dof: &rubmap::package::raw::RawDof| {
            let vector = u[s][dof.node as usize - 1];
            let k = usize::from(dof.component) - 1;
            // A partly clamped node of a Cartesian package stays Cartesian.
            let stays = package.manifest.frame == Frame::Cartesian && !complete(dof.node);
            if stays { vector[k] } else { dot(cylindrical(package, dof.node)[k], vector) }
        };
        own_dofs.map(component).collect()
    };
    [(0..sectors).map(raw).collect(), (0..sectors).map(own).collect()]
}

/// Energies of a random displacement, by the package's mass and first stiffness, and by the sector model's.
fn energies(package: &RawPackage, model: &SectorModel, seed: u64) -> [(f64, f64); 2] {
    let [raw, q] = displacement(package, seed);
    let both = |matrix: &RawMatrix, folded: &CyclicMatrix| {
        (raw.iter().map(|u| raw_energy(matrix, u)).sum(), folded_energy(folded, &q))
    };
    [both(&package.mass, &model.mass), both(&package.stiffness[0], &model.stiffness[0])]
}

fn assert_energies_agree(package: &RawPackage) {
    let model = package::to_sector(package.clone()).expect("a good package");
    for matrix in std::iter::once(&model.mass).chain(&model.stiffness) {
        let own = matrix.own.to_dense();
        assert_eq!(own, own.transpose().to_owned(), "Y0 is symmetric to the last bit");
    }
    for (seed, (raw, folded)) in
        (1..4).flat_map(|seed| energies(package, &model, seed).map(|pair| (seed, pair)))
    {
        // The difference is round-off of sums of some hundred terms of one sign, not more.
        assert!((raw - folded).abs() <= 1e-12 * raw.abs(), "seed {seed}: raw {raw:e}, folded {folded:e}");
    }
    assert_powers_agree(package);
}

fn assert_powers_agree(package: &RawPackage) {
    let package = with_gyroscopic(package.clone(), 77);
    let model = package::to_sector(package.clone()).expect("a good package");
    let (raw, folded) = (package.gyroscopic.as_ref().unwrap(), model.gyroscopic.as_ref().unwrap());
    let own = folded.own.to_dense();
    assert_eq!(own, -own.transpose(), "G0 is skew-symmetric to the last bit");
    for seed in 1..4 {
        let ([raw_p, p], [raw_q, q]) = (displacement(&package, seed), displacement(&package, seed + 10));
        let by_sector: Vec<f64> = raw_p.iter().zip(&raw_q).map(|(p, u)| raw_power(raw, p, u)).collect();
        // The sums have some hundred terms of up to 1e-9 a sector, of both signs.
        let scale = 1e-7 * by_sector.len() as f64;
        let (expected, found) = (by_sector.iter().sum::<f64>(), folded_power(folded, &p, &q));
        assert!((expected - found).abs() <= 1e-14 * scale, "seed {seed}: {expected:e} {found:e}");
    }
}

fn directions() -> impl Strategy<Value = Vector> {
    // The axis is along each coordinate, nearly along x (where θ is measured from y), or anywhere; not of unit length.
    prop_oneof![
        Just([0.0, 0.0, 1.0]),
        Just([0.0, 0.0, -3.0]),
        Just([2.0, 0.0, 0.0]),
        Just([1.0, 1e-5, 0.0]),
        [-1.0..1.0, -1.0..1.0, 0.1..1.0_f64],
    ]
}

proptest! {
    #![proptest_config(fixed(200))]

    #[test]
    fn the_wheel_has_the_energy_of_its_sectors(
        sectors in 1..8_usize,
        cartesian: bool,
        direction in directions(),
        origin in [-50.0..50.0, -50.0..50.0, -50.0..50.0_f64],
        seed: u64,
    ) {
        let frame = if cartesian { Frame::Cartesian } else { Frame::Cylindrical };
        assert_energies_agree(&sample(Shape { sectors, frame, origin, direction, seed, ..Shape::default() }));
    }
}

#[test]
fn partly_clamped_faces_are_exact_or_refused() {
    let z = [0.0, 0.0, 1.0];
    let cartesian = Shape { frame: Frame::Cartesian, direction: z, ..Shape::default() };
    assert_energies_agree(&sample(Shape { first_pair: [true, true, false], ..cartesian }));
    assert_energies_agree(&sample(Shape { first_pair: [false, false, true], ..cartesian }));
    assert_energies_agree(&sample(Shape { first_pair: [true, false, false], sectors: 2, ..cartesian }));
    assert_energies_agree(&sample(Shape {
        first_pair: [true, false, false],
        frame: Frame::Cylindrical,
        ..cartesian
    }));
    let refused = package::to_sector(sample(Shape { first_pair: [true, false, true], ..cartesian }));
    assert_eq!(refused.expect_err("x free, y clamped, turned by 120°").field(), Some("/cyclic/0"));
}

#[test]
fn a_high_face_assembled_on_the_low_side_is_the_same_wheel() {
    let apart = sample(Shape::default());
    let mut assembled = apart.clone();
    let first_high = 12;
    // Rows 13–15 are node 6, partner of node 2 (rows 4–6); rows 16–18 node 5, partner of node 1 (rows 1–3).
    let low = |row: u32| if row < 15 { row - 9 } else { row - 15 };
    for matrix in std::iter::once(&mut assembled.mass).chain(&mut assembled.stiffness) {
        let (high, mut rest): (Vec<_>, Vec<_>) =
            matrix.entries.iter().partition(|(_, column, _)| *column >= first_high);
        for (row, column, value) in high {
            let (i, j) = (low(row), low(column));
            let entry = rest.iter_mut().find(|e| (e.0, e.1) == (i.max(j), i.min(j))).expect("a full block");
            entry.2 += value;
        }
        matrix.entries = rest;
    }
    let [apart, assembled] = [apart, assembled].map(|package| package::to_sector(package).expect("good"));
    let pairs = std::iter::once((&apart.mass, &assembled.mass))
        .chain(apart.stiffness.iter().zip(&assembled.stiffness));
    for (a, b) in pairs {
        assert_eq!(a.own.to_dense(), b.own.to_dense());
        assert_eq!(a.next.to_dense(), b.next.to_dense());
    }
}

#[test]
fn rows_may_come_in_any_order() {
    let ordered = sample(Shape { frame: Frame::Cartesian, ..Shape::default() });
    let mut shuffled = ordered.clone();
    let size = ordered.dofs.len() as u32;
    // 7 and 18 have no common divisor: a permutation that tears nodes apart.
    let to = |row: u32| row * 7 % size;
    for (row, dof) in ordered.dofs.iter().enumerate() {
        shuffled.dofs[to(row as u32) as usize] = *dof;
    }
    for matrix in std::iter::once(&mut shuffled.mass).chain(&mut shuffled.stiffness) {
        for entry in &mut matrix.entries {
            *entry = (to(entry.0).max(to(entry.1)), to(entry.0).min(to(entry.1)), entry.2);
        }
    }
    assert_energies_agree(&shuffled);
    let model = package::to_sector(shuffled).expect("good");
    let nodes = &model.node_of_dof;
    assert_eq!(nodes.len(), 12);
    assert_eq!(nodes[0], 0);
    for contact in &model.contact {
        let [r, theta, z] = contact.dofs;
        assert!(nodes[r] == nodes[theta] && nodes[theta] == nodes[z]);
    }
}

#[test]
fn sectors_may_be_alone() {
    let mut blade = sample(Shape { sectors: 1, ..Shape::default() });
    blade.manifest.cyclic.clear();
    let mut blades = blade.clone();
    blades.manifest.sectors = 5;
    for package in [blade, blades] {
        let model = package::to_sector(package.clone()).expect("blades on a rigid disk");
        assert_eq!(model.own_dofs(), package.dofs.len());
        assert!(model.mass.next.val().is_empty());
    }
}
