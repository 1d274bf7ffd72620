//! Double, multiple and clustered eigenvalues: sectors made of identical parts.
//!
//! A Krylov method with a single vector sees one copy of a multiple eigenvalue in exact arithmetic and finds others by
//! accident; one that stops at the k-th mode cuts a multiplet in two. A missing copy is a part of the wheel that stands
//! still in every simulation. Guaranteed: every copy is found and counted, and identical parts that touch nothing
//! but the casing each do what one alone does.

use std::f64::consts::PI;

use faer::sparse::{SparseColMat, Triplet};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, spectral_difference, sweep};

/// Number of masses of a chain, fixed at one end.
const LINKS: usize = 5;
const MASS: f64 = 2e-6;
const SPRING: f64 = 40.0;

/// Sector with a contact node on springs of its own, and for each of `factors` a chain in r, θ and z whose springs are
/// factor·SPRING. Nothing is coupled to anything else.
fn chains(sectors: usize, factors: &[f64]) -> SectorModel {
    let size = 3 * (1 + LINKS * factors.len());
    let mut own: Vec<_> = (0..3).map(|d| Triplet::new(d, d, SPRING)).collect();
    for (part, factor) in factors.iter().enumerate() {
        let k = factor * SPRING;
        for link in 0..LINKS {
            for d in 0..3 {
                let dof = 3 * (1 + part * LINKS + link) + d;
                own.push(Triplet::new(dof, dof, if link + 1 == LINKS { k } else { 2.0 * k }));
                if link > 0 {
                    own.push(Triplet::new(dof, dof - 3, -k));
                    own.push(Triplet::new(dof - 3, dof, -k));
                }
            }
        }
    }
    let matrix = |own: &[Triplet<usize, usize, f64>]| CyclicMatrix {
        own: SparseColMat::try_new_from_triplets(size, size, own).unwrap(),
        next: SparseColMat::try_new_from_triplets(size, size, &[]).unwrap(),
    };
    let mass: Vec<_> = (0..size).map(|dof| Triplet::new(dof, dof, MASS)).collect();
    let parts = SectorParts {
        name: "chains".into(),
        sectors,
        units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
        mass: matrix(&mass),
        stiffness: vec![matrix(&own)],
        gyroscopic: None,
        speeds_rad_s: vec![0.0],
        contact: vec![ContactNode {
            id: 1,
            position: [50.0, 0.0, 0.0],
            normal: [1.0, 0.0, 0.0],
            dofs: [0, 1, 2],
        }],
        axis: Vec::new(),
        node_of_dof: (0..size).map(|dof| dof / 3).collect(),
    };
    SectorModel::new(parts).unwrap()
}

/// Closed form of ω² of the chains, ascending, three of each: 4 k/m sin²((2j − 1)π/(2(2n + 1))), fixed at one end, free at the other.
fn closed_form(factors: &[f64]) -> Vec<f64> {
    let square = |factor: f64, j: usize| {
        let sine = ((2 * j - 1) as f64 * PI / (2 * (2 * LINKS + 1)) as f64).sin();
        4.0 * factor * SPRING / MASS * sine * sine
    };
    let mut all: Vec<f64> =
        factors.iter().flat_map(|&f| (1..=LINKS).flat_map(move |j| [square(f, j); 3])).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Twelve identical chains: every eigenvalue 36 times, in every nodal diameter.
#[test]
fn every_copy_of_a_multiple_eigenvalue_is_found() {
    every_mode_is_found(&[1.0; 12]);
}

/// Twelve nearly identical chains, whose eigenvalues spread over a few parts in 1e9, and over a few per cent.
#[test]
fn every_member_of_a_cluster_is_found() {
    for spread in [1e-13, 1e-9, 1e-5, 1e-2] {
        let factors: Vec<f64> = (0..12).map(|part| 1.0 + spread * f64::from(part)).collect();
        every_mode_is_found(&factors);
    }
}

fn every_mode_is_found(factors: &[f64]) {
    let expected = closed_form(factors);
    for sectors in [1, 4, 5] {
        let sector = chains(sectors, factors);
        // The numbers of modes are one of a multiplet, one less than it, it, one more, and one and a half.
        for modes in [1, 35, 36, 37, 54] {
            let reduced = reduced(&sector, modes);
            assert_eq!(reduced.report.counted_modes, reduced.report.modes, "{sectors} {modes}");
            for harmonic in &reduced.wheel.harmonics {
                let found = &harmonic.certificates[0].eigenvalues;
                assert_eq!(found.len(), modes as usize);
                for (found, expected) in found.iter().zip(&expected) {
                    assert!((found / expected - 1.0).abs() < 1e-11, "{modes}: {found} {expected}");
                }
                assert_eq!(harmonic.mass.nrows(), 3 + modes as usize, "copies are independent directions");
            }
        }
    }
}

/// Sector with the `sector` twice, the second one turned on by half a sector of `sectors`.
fn twins(blade: &SectorModel, sectors: usize) -> SectorModel {
    let size = blade.own_dofs();
    let twice = |matrix: &CyclicMatrix| {
        let entries = matrix.own.triplet_iter().flat_map(|entry| {
            [0, size].map(|first| Triplet::new(first + entry.row, first + entry.col, *entry.val))
        });
        CyclicMatrix {
            own: SparseColMat::try_new_from_triplets(2 * size, 2 * size, &entries.collect::<Vec<_>>())
                .unwrap(),
            next: SparseColMat::try_new_from_triplets(2 * size, 2 * size, &[]).unwrap(),
        }
    };
    let second = blade.contact.iter().map(|node| {
        let mut node = node.clone();
        node.id += 100;
        node.position[1] += PI / sectors as f64;
        node.dofs = node.dofs.map(|dof| size + dof);
        node
    });
    let nodes = blade.node_of_dof.len() / 3;
    let parts = SectorParts {
        sectors,
        mass: twice(&blade.mass),
        stiffness: blade.stiffness.iter().map(twice).collect(),
        contact: blade.contact.iter().cloned().chain(second).collect(),
        axis: Vec::new(),
        node_of_dof: blade
            .node_of_dof
            .iter()
            .copied()
            .chain(blade.node_of_dof.iter().map(|n| n + nodes))
            .collect(),
        ..blade.clone().into_parts()
    };
    SectorModel::new(parts).unwrap()
}

/// Two blades a sector that nothing joins: each frequency 2N times on the wheel, and the first blade does what it does
/// alone on its disk.
#[test]
fn blades_that_nothing_joins_do_what_one_does_alone() {
    let alone =
        wheel(WheelRecipe { sectors: 1, nodes: 5, contact_nodes: 2, face_nodes: 0, ..Default::default() });
    let of_alone = reduced(&alone, 6);
    for sectors in [1, 6, 7] {
        let pair = twins(&alone, sectors);
        let of_pair = reduced(&pair, 12);
        let modes = |reduced, speed| {
            ModalWheel::at(reduced, speed, RotationEffects::stiffening(true)).unwrap().harmonics
        };
        let single = &modes(&of_alone.wheel, 0.6 * TOP_SPEED)[0].omega;
        for harmonic in modes(&of_pair.wheel, 0.6 * TOP_SPEED) {
            assert_eq!(harmonic.omega.len(), 2 * single.len());
            for (found, expected) in harmonic.omega.chunks(2).zip(single) {
                assert!(found.iter().all(|f| (f / expected - 1.0).abs() < 1e-10), "{found:?} {expected}");
            }
        }
        for scheme in SCHEMES {
            let changes = |clearance: &[f64], kept_modes: u32| {
                json!({
                    "scene": {"casing": {"clearance": {"leading": null, "trailing": null, "values": clearance}}},
                    "integration": {"revolutions": 6, "window_revolutions": 2, "steps_per_revolution": 3840,
                                    "kept_modes": kept_modes},
                    "sensors": [{"contact_node": 0, "component": "radial"}, {"contact_node": 1, "component": "axial"}]
                })
            };
            let speeds = [0.6 * TOP_SPEED];
            let one = run(&of_alone, &sweep(&alone, scheme, &speeds, changes(&[0.3, 0.22], 5)));
            let all = run(&of_pair, &sweep(&pair, scheme, &speeds, changes(&[0.3, 0.22, 0.3, 0.22], 10)));
            assert_sound(&one[0], 1.0);
            assert_sound(&all[0], 1.0);
            assert!(one[0].point.contact_share > 0.0);
            let difference = spectral_difference(&one[0], &all[0]);
            assert!(difference < 1e-9, "{scheme}, {sectors} sectors: {difference:e}");
        }
    }
}

/// Multiplets stay whole under `auto`: `massless_boundary` with one mode of a pair of twins kept and the other left out
/// treats equal blades differently, by 8 % of the response with 9 or 11 modes of these. Two of a pair need the same
/// step, so `auto` takes both.
#[test]
fn auto_keeps_whole_multiplets() {
    let alone =
        wheel(WheelRecipe { sectors: 1, nodes: 5, contact_nodes: 2, face_nodes: 0, ..Default::default() });
    let pair = twins(&alone, 6);
    let reduced = reduced(&pair, 12);
    let mut kept = Vec::new();
    for steps in [150, 200, 300, 400, 500, 1000, 2000, 4000] {
        let changes = json!({"integration": {
            "revolutions": 2, "window_revolutions": 1, "steps_per_revolution": steps, "kept_modes": "auto"}});
        let result = &run(&reduced, &sweep(&pair, "massless_boundary", &[0.3 * TOP_SPEED], changes))[0];
        assert_sound(result, 1.0);
        kept.extend(result.point.scheme.as_ref().unwrap().kept_modes);
    }
    assert!(kept.iter().all(|kept| kept % 2 == 0), "{kept:?}");
    assert!(kept.first() < kept.last(), "{kept:?}");
}
