//! Coriolis forces against closed forms and the explicitly assembled wheel.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix, DVector};
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::{Campbell, Wave};
use rubmap::analysis::run::{ModelFacts, modal_analysis, prepare, resolve_modal_analysis};
use rubmap::dynamics::error::ModelError;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::dynamics::sector::{ContactNode, SectorModel, SectorParts, Units};
use rubmap::dynamics::waves::{WaveFrequencies, wave_frequencies};
use rubmap::package::raw::RawMatrix;
use rubmap::package::to_sector;
use serde_json::json;

use crate::fixtures::{
    TOP_SPEED, WheelRecipe, assembled_skew, assembled_wheel, cyclic, gyroscopic, small_impeller, wheel,
};

fn complete(sector: &SectorModel) -> ReducedWheel {
    reduce(sector, &ReductionOptions::new(1000), &NoCheckpoints, &|_, _| true).unwrap()
}

fn campbell(sector: &SectorModel, modes: u32, request: serde_json::Value) -> Campbell {
    let request =
        resolve_modal_analysis(serde_json::from_value(request).unwrap(), &ModelFacts::of(sector)).unwrap();
    let reduced = prepare(sector, modes, None, &NoCheckpoints, &Unwatched).unwrap();
    modal_analysis(&reduced, &request, &Unwatched).unwrap()
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a / b - 1.0).abs() < tolerance, "{found:?} {expected:?}");
    }
}

/// Frequencies: all positive ν of M ü + Ω G u̇ + K u = 0, ascending: with energy coordinates u̇-like and u-like the
/// first-order matrix S is real and skew-symmetric, and SᵀS has every ν² twice.
fn dense_frequencies(m: &DMatrix<f64>, g: &DMatrix<f64>, k: &DMatrix<f64>) -> Vec<f64> {
    let n = m.nrows();
    let (l, root) = (m.clone().cholesky().unwrap().l(), k.clone().cholesky().unwrap().l());
    let coupling = l.solve_lower_triangular(&root).unwrap();
    let half = l.solve_lower_triangular(g).unwrap();
    let damping = l.solve_lower_triangular(&half.transpose()).unwrap().transpose();
    let mut s = DMatrix::zeros(2 * n, 2 * n);
    s.view_mut((0, n), (n, n)).copy_from(&coupling.transpose());
    s.view_mut((n, 0), (n, n)).copy_from(&-coupling);
    s.view_mut((n, n), (n, n)).copy_from(&-damping);
    let mut squares: Vec<f64> = (s.transpose() * s).symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares.chunks(2).map(|pair| (0.5 * (pair[0] + pair[1])).sqrt()).collect()
}

/// Wheel of `recipe` with random gyroscopic forces.
fn turning(recipe: WheelRecipe, seed: u64) -> SectorModel {
    let gyroscopic = Some(gyroscopic(recipe, seed));
    SectorModel::new(SectorParts { gyroscopic, ..wheel(recipe).into_parts() }).unwrap()
}

/// Waves of all nodal diameters, with every fixed-interface mode kept, are the motions of the assembled wheel.
#[test]
fn waves_are_those_of_the_assembled_wheel() {
    for sectors in [1, 2, 3, 4, 7, 10] {
        let recipe = WheelRecipe { sectors, ..Default::default() };
        let sector = turning(recipe, 11);
        let reduced = complete(&sector);
        for (index, speed) in [(1, 0.5 * TOP_SPEED), (2, TOP_SPEED)] {
            let mut found = Vec::new();
            for i in 0..reduced.harmonics.len() {
                let WaveFrequencies { forward, backward } =
                    wave_frequencies(&reduced, i, speed, true).unwrap();
                if i == 0 || 2 * i == sectors {
                    assert_eq!(forward, backward, "single");
                } else {
                    found.extend(forward);
                }
                found.extend(backward);
            }
            found.sort_by(f64::total_cmp);
            let expected = dense_frequencies(
                &assembled_wheel(&sector.mass, sectors),
                &(assembled_skew(sector.gyroscopic.as_ref().unwrap(), sectors) * speed),
                &assembled_wheel(&sector.stiffness[index], sectors),
            );
            close(&found, &expected, 1e-9);
        }
    }
}

/// Modal gyroscopic matrices g are skew-Hermitian to the last bit, real where the nodal diameter is single, absent unless
/// asked for; of a finite-element impeller with a truncated basis as of a complete one.
#[test]
fn modal_gyroscopic_matrices_are_skew() {
    let recipe = WheelRecipe::default();
    let springs = turning(recipe, 3);
    let mut package = small_impeller(4);
    let half = package.mass.entries.iter().filter(|entry| entry.0 == entry.1 + 1).copied();
    package.gyroscopic = Some(RawMatrix { size: package.mass.size, entries: half.collect() });
    package.manifest.gyroscopic = Some("g.npz".into());
    for sector in [springs, to_sector(package).unwrap()] {
        let reduced = reduce(&sector, &ReductionOptions::new(4), &NoCheckpoints, &|_, _| true).unwrap();
        let effects = RotationEffects { stiffening: true, coriolis: true };
        let with = ModalWheel::at(&reduced, 900.0, effects).unwrap();
        let without = ModalWheel::at(&reduced, 900.0, RotationEffects::stiffening(true)).unwrap();
        for (with, without) in with.harmonics.iter().zip(&without.harmonics) {
            assert_eq!((&with.omega, &with.contact), (&without.omega, &without.contact));
            assert!(without.gyroscopic.is_none());
            let g = with.gyroscopic.as_ref().unwrap();
            assert_eq!((g.nrows(), g.norm_max() > 0.0), (with.omega.len(), true));
            assert_eq!(*g, -g.adjoint().to_owned());
            assert!(!with.single || (0..g.ncols()).all(|j| (0..g.nrows()).all(|i| g[(i, j)].im == 0.0)));
        }
    }
}

/// Waves without speed or matrix: as the gyroscopic matrix or the speed goes to zero, either wave goes to the mode without Coriolis forces.
#[test]
fn without_speed_or_matrix_waves_are_plain_modes() {
    let recipe = WheelRecipe { stiffening: false, ..Default::default() };
    let plain = wheel(recipe);
    let of_zero = complete(&plain);
    let error = wave_frequencies(&of_zero, 1, 1.0, false).unwrap_err();
    assert_eq!(error, ModelError::NoGyroscopicMatrix);
    let reduced = complete(&turning(recipe, 8));
    let modes = ModalWheel::at(&reduced, 0.0, RotationEffects::stiffening(false)).unwrap();
    let shift = |speed: f64| {
        let of = |i: usize| {
            let waves = wave_frequencies(&reduced, i, speed, false).unwrap();
            let both = waves.forward.into_iter().chain(waves.backward);
            let twice = modes.harmonics[i].omega.iter().chain(&modes.harmonics[i].omega);
            both.zip(twice).map(|(nu, omega)| (nu / omega - 1.0).abs()).fold(0.0, f64::max)
        };
        (0..reduced.harmonics.len()).map(of).fold(0.0, f64::max)
    };
    assert!(shift(0.0) < 1e-12, "{:e}", shift(0.0));
    // The shift is of first order in Ω.
    let ratio = shift(1e-3 * TOP_SPEED) / shift(1e-4 * TOP_SPEED);
    assert!((ratio - 10.0).abs() < 0.1, "{ratio}");
}

/// Ring of `sectors` masses that stiff rods join, on soft isotropic springs, beside a stiff blade tip that takes no part.
fn ring(sectors: usize) -> SectorModel {
    let (mass, spring, rod) = (1e-6, 1.0, 1e7);
    let angle = PI / sectors as f64;
    let size = 6;
    let mut own = DMatrix::from_diagonal(&DVector::from_fn(size, |dof, _| match dof {
        0 | 1 => spring,
        _ => 1e4 * spring,
    }));
    let mut next = DMatrix::zeros(size, size);
    // A rod's extension is `from`·u_s + `to`·u_{s+1}, each in its own (r, θ).
    let from = [angle.sin(), -angle.cos()];
    let to = [angle.sin(), angle.cos()];
    let mut gyroscopic = DMatrix::zeros(size, size);
    for i in 0..2 {
        for j in 0..2 {
            own[(i, j)] += rod * (from[i] * from[j] + to[i] * to[j]);
            next[(i, j)] = rod * from[i] * to[j];
        }
    }
    (gyroscopic[(0, 1)], gyroscopic[(1, 0)]) = (-2.0 * mass, 2.0 * mass);
    let none = DMatrix::zeros(size, size);
    let parts = SectorParts {
        name: "ring".into(),
        sectors,
        units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
        mass: cyclic(&(DMatrix::identity(size, size) * mass), &none),
        stiffness: vec![cyclic(&own, &next)],
        gyroscopic: Some(cyclic(&gyroscopic, &none)),
        speeds_rad_s: vec![0.0],
        contact: vec![ContactNode {
            id: 2,
            position: [60.0, 0.0, 0.0],
            normal: [1.0, 0.0, 0.0],
            dofs: [3, 4, 5],
        }],
        axis: Vec::new(),
        node_of_dof: vec![0, 0, 0, 1, 1, 1],
    };
    SectorModel::new(parts).unwrap()
}

/// Bryan (1890): the vibration pattern of a spinning inextensional ring lags behind the ring, in the rotating frame by
/// 2Ω/(n² + 1), so that its backward wave is 4nΩ/(n² + 1) faster than its forward one. Of masses and rods the same with
/// tan(nα/2)/tan(α/2) in the place of n.
#[test]
fn the_pattern_of_a_spinning_ring_lags_behind() {
    let sectors = 12;
    let reduced = complete(&ring(sectors));
    let speed = 130.0;
    for i in 1..sectors / 2 {
        let half = PI / sectors as f64;
        let n = (i as f64 * half).tan() / half.tan();
        let split = 4.0 * n * speed / (n * n + 1.0);
        let middle = (split * split / 4.0 + 1e6).sqrt();
        let waves = wave_frequencies(&reduced, i, speed, false).unwrap();
        // Springs are 1e-7 of the rods.
        close(&[waves.forward[0]], &[middle - split / 2.0], 1e-5);
        close(&[waves.backward[0]], &[middle + split / 2.0], 1e-5);
    }
}

/// Driven crossings: there the force of its engine order, taken through the assembled wheel, resonates; the branch is the
/// one that order drives. Orders that drive the other wave are answered elsewhere.
#[test]
fn engine_orders_meet_the_waves_they_drive() {
    let sectors = 7;
    let sector = ring(sectors);
    let request = json!({"model": "ring", "modes_per_speed": 3, "families": 1, "superharmonics": [1], "lobes": 1,
        "max_engine_order": 10, "coriolis": true, "speeds": {"from": 90, "to": 700, "count": 60, "unit": "rad_s"}});
    let found = campbell(&sector, 3, request);
    let m = assembled_wheel(&sector.mass, sectors);
    let g = assembled_skew(sector.gyroscopic.as_ref().unwrap(), sectors);
    let k = assembled_wheel(&sector.stiffness[0], sectors);
    let response = |order: u32, speed: f64| {
        let omega = f64::from(order) * speed;
        let dynamic = DMatrix::from_fn(m.nrows(), m.nrows(), |i, j| {
            Complex::new(k[(i, j)] - omega * omega * m[(i, j)], omega * speed * g[(i, j)])
        });
        let force = DVector::from_fn(m.nrows(), |dof, _| match (dof / 6, dof % 6) {
            (s, 0) => Complex::cis(TAU * f64::from(order) * s as f64 / sectors as f64),
            _ => Complex::ZERO,
        });
        dynamic.lu().solve(&force).unwrap().norm()
    };
    let mut directions = Vec::new();
    for crossing in &found.driven_crossings {
        let (order, speed) = (crossing.engine_order, crossing.speed_rad_s);
        let beside = response(order, 1.01 * speed);
        assert!(response(order, speed) > 1e4 * beside, "{crossing:?}");
        directions.push(crossing.wave);
    }
    for wave in [None, Some(Wave::Forward), Some(Wave::Backward)] {
        assert!(directions.contains(&wave), "{wave:?} in {directions:?}");
    }
    // The linear criterion is the backward wave's that stands still in the fixed frame.
    assert!(!found.crossings.is_empty());
    for crossing in &found.crossings {
        assert!(
            response(crossing.nodal_diameter, crossing.speed_rad_s)
                > 1e4 * response(crossing.nodal_diameter, 1.01 * crossing.speed_rad_s)
        );
    }
    // f_a = 0 there, as absolute frequencies tell on the grid: they change sides of 0 where |f_a| is smallest.
    let absolute = &found.absolute_frequencies_hz[0].frequencies_hz;
    let at = found.speeds_rad_s.iter().position(|&speed| speed > found.crossings[0].speed_rad_s).unwrap();
    let i = found.crossings[0].nodal_diameter as usize;
    let step = found.speeds_rad_s[at] - found.speeds_rad_s[at - 1];
    assert!(absolute[at - 1][i][0] + absolute[at][i][0] < 2.0 * i as f64 * step / TAU);
}

#[test]
fn a_model_without_the_matrix_is_told_so() {
    let request = json!({"model": "m", "coriolis": true, "speeds": {"values": [1.0], "unit": "rad_s"}});
    let facts = ModelFacts::of(&wheel(WheelRecipe::default()));
    assert!(!facts.gyroscopic);
    let refused = resolve_modal_analysis(serde_json::from_value(request).unwrap(), &facts).unwrap_err();
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].pointer, "/coriolis");
    assert!(refused[0].message.contains("no gyroscopic matrix"), "{}", refused[0].message);
}
