//! Motion without contact against the continuous equations: the matrix exponential, and the frequency response.

use std::f64::consts::TAU;

use faer::c64;
use nalgebra::{Complex, DMatrix, DVector};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::initial::{InitialMode, InitialWave};
use rubmap::dynamics::schemes::Scheme;

use crate::literal::Literal;
use crate::scene::{Effect, SPEED, Scene, Start, difference, history};

const SAMPLES: usize = 100;

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: usize::MAX }];

fn free(sectors: usize, start: Start, effects: &[Effect]) -> Scene {
    let mut scene = Scene::rubbing(sectors, start).with(effects);
    scene.casing = None;
    scene.samples = SAMPLES;
    scene
}

/// Sensor values of u(t) = B x(t).
fn read(scene: &Scene, b: &DMatrix<f64>, x: &DVector<f64>) -> Vec<f64> {
    let moved = b * x;
    let of = |sensor: &rubmap::dynamics::integrate::SensorRow| {
        let first = 3 * (sensor.sector * scene.nodes.len() + sensor.direction.node);
        (0..3).map(|d| sensor.direction.components[d] * moved[first + d]).sum()
    };
    scene.sensors.iter().map(of).collect()
}

/// Free vibration: (x, ẋ) = exp([[0, 1], [−K, −C]] t) (x, ẋ)(0).
#[test]
fn free_vibration_follows_the_matrix_exponential() {
    let effects = [Effect::Coriolis, Effect::Mistuning];
    for (sectors, start) in [(4, Start::Travelling), (5, Start::Standing)] {
        for effects in [&effects[..1], &effects[1..], &effects] {
            let scene = free(sectors, start, effects);
            let literal = Literal::new(&scene);
            let (k, c, b) = literal.continuous();
            let (x, v) = literal.initial();
            let n = x.len();
            let mut system = DMatrix::zeros(2 * n, 2 * n);
            system.view_mut((0, n), (n, n)).fill_with_identity();
            system.view_mut((n, 0), (n, n)).copy_from(&-k);
            system.view_mut((n, n), (n, n)).copy_from(&-c);
            let sample = (system * (TAU / SPEED / SAMPLES as f64)).exp();
            let mut state = DVector::from_iterator(2 * n, x.iter().chain(&v).copied());
            let mut exact = vec![Vec::new(); scene.sensors.len()];
            for _ in 0..SAMPLES * scene.revolutions {
                state = &sample * state;
                let now = state.rows(0, n).into_owned();
                for (line, u) in exact.iter_mut().zip(read(&scene, &b, &now)) {
                    line.push(u);
                }
            }
            for scheme in SCHEMES {
                let error = |steps| {
                    let run = Scene { steps, scheme, ..scene.clone() }.run();
                    difference(&history(&run).displacement, &exact)
                };
                let (coarse, fine) = (error(1500), error(3000));
                assert!(fine < 1e-3, "{scheme:?} {effects:?}: {fine:e}");
                assert!((coarse / fine - 4.0).abs() < 0.1, "{scheme:?} {effects:?}: {coarse:e} {fine:e}");
            }
        }
    }
}

/// Steady response: Σ over the engine orders of Re (K − w² + jwC)⁻¹ Bᵀ F e^{jwt}, the transient gone.
#[test]
fn the_steady_response_is_the_frequency_response() {
    const REVOLUTIONS: usize = 12;
    for sectors in [4, 5] {
        let mut scene =
            free(sectors, Start::Rest, &[Effect::Coriolis, Effect::Mistuning, Effect::Excitation]);
        let damping = scene.damping.as_mut().unwrap();
        (damping.modal_ratio, damping.family_ratios) = (0.1, vec![0.2]);
        let (k, c, b) = Literal::new(&scene).continuous();
        let dofs = 3 * scene.nodes.len();
        let mut exact = vec![vec![0.0; SAMPLES]; scene.sensors.len()];
        for of in &scene.excitation {
            let order = f64::from(of.order);
            let w = order * SPEED;
            let dynamic = DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| {
                let inertia = if i == j { w * w } else { 0.0 };
                Complex::new(k[(i, j)] - inertia, w * c[(i, j)])
            });
            let mut force = DVector::<Complex<f64>>::zeros(b.nrows());
            for sector in 0..sectors {
                let phase = order * TAU * sector as f64 / sectors as f64 + of.phase_rad;
                for direction in &of.directions {
                    for d in 0..3 {
                        force[sector * dofs + 3 * direction.node + d] +=
                            Complex::from_polar(of.amplitude * direction.components[d], phase);
                    }
                }
            }
            let modal = b.transpose().map(Complex::from) * force;
            let x = dynamic.lu().solve(&modal).unwrap();
            for q in 0..SAMPLES {
                let turn = Complex::cis(order * TAU * (q + 1) as f64 / SAMPLES as f64);
                let now = x.map(|x| (x * turn).re);
                for (line, u) in exact.iter_mut().zip(read(&scene, &b, &now)) {
                    line[q] += u;
                }
            }
        }
        scene.revolutions = REVOLUTIONS;
        for scheme in SCHEMES {
            let error = |steps| {
                let run = Scene { steps, scheme, ..scene.clone() }.run();
                let last = |line: &Vec<f64>| line[SAMPLES * (REVOLUTIONS - 1)..].to_vec();
                difference(&history(&run).displacement.iter().map(last).collect::<Vec<_>>(), &exact)
            };
            let (coarse, fine) = (error(600), error(1200));
            assert!(fine < 1e-3, "{scheme:?}: {fine:e}");
            assert!((coarse / fine - 4.0).abs() < 0.2, "{scheme:?}: {coarse:e} {fine:e}");
        }
    }
}

/// Engine order k drives nodal diameter |k − N round(k/N)| and no other.
#[test]
fn an_engine_order_drives_its_alias_only() {
    for sectors in [5usize, 6] {
        for order in 0..=2 * sectors as u32 + 1 {
            let mut scene = free(sectors, Start::Rest, &[]);
            scene.excitation = vec![EngineOrderExcitation {
                order,
                directions: vec![Direction { node: 0, components: [0.5, 0.3, -0.2] }],
                amplitude: 2.0,
                phase_rad: 0.3,
                ramp_revolutions: 0.5,
            }];
            let (k, n) = (f64::from(order), sectors as f64);
            let driven = (k - n * (k / n).round()).abs() as usize;
            let run = scene.run();
            let columns = &history(&run).harmonics[0];
            let largest = |column: &Vec<f64>| column.iter().fold(0.0f64, |m: f64, u: &f64| m.max(u.abs()));
            for (column, line) in columns.iter().enumerate() {
                let diameter = column.div_ceil(2);
                assert_eq!(largest(line) > 0.0, diameter == driven, "order {order}, column {column}");
            }
        }
    }
}

/// Initial waves u_s(t) = a cos(isα ∓ ωt + …): forward towards +θ, with the amplitude that was asked for.
#[test]
fn initial_waves_travel_as_they_are_called() {
    let (sectors, harmonic, amplitude) = (5, 2, 0.3);
    let wheel = crate::scene::wheel(sectors, 1, 1);
    let omega = wheel.harmonics[harmonic].omega[0];
    for (wave, direction) in [(InitialWave::Forward, -1.0), (InitialWave::Backward, 1.0)] {
        let phase = c64::cis(0.7);
        let start = InitialMode::of_amplitude(&wheel, harmonic, 0, amplitude, phase, wave);
        let mut scene = Scene { scheme: Scheme::ExactModal, ..Scene::free(wheel.clone(), vec![start]) };
        let shape = &wheel.harmonics[harmonic].contact;
        // This is the component that moves most.
        let norm = |d: usize| shape[(d, 0)].norm();
        let most = (0..3).max_by(|&a, &b| norm(a).total_cmp(&norm(b))).unwrap();
        for sensor in &mut scene.sensors {
            sensor.direction.components = [0, 1, 2].map(|d| if d == most { 1.0 } else { 0.0 });
        }
        let turned = shape[(most, 0)] / norm(most) * phase;
        let exact: Vec<Vec<f64>> = (0..sectors)
            .map(|s| {
                let around = c64::cis(TAU * (harmonic * s) as f64 / sectors as f64) * turned * amplitude;
                let time = |q: usize| scene.step_s() * (q + 1) as f64;
                (0..2 * scene.steps).map(|q| (around * c64::cis(direction * omega * time(q))).re).collect()
            })
            .collect();
        let apart = difference(&history(&scene.run()).displacement, &exact);
        assert!(apart < 1e-10, "{wave:?}: {apart:e}");
    }
}

/// Run that starts from the end of another: it goes on as that one would have.
#[test]
fn a_run_goes_on_from_its_end() {
    let effects = [Effect::Mistuning, Effect::Coriolis, Effect::Excitation];
    for scheme in SCHEMES {
        for effects in [&effects[..1], &effects[1..2], &effects[2..], &effects] {
            let mut whole = Scene { scheme, ..free(5, Start::Travelling, effects) };
            whole.excitation.iter_mut().for_each(|of| of.ramp_revolutions = 0.0);
            let first = Scene { revolutions: 1, ..whole.clone() };
            let second = Scene { initial: history(&first.run()).end.clone(), ..first };
            let rest: Vec<_> =
                history(&whole.run()).displacement.iter().map(|u| u[SAMPLES..].to_vec()).collect();
            let apart = difference(&history(&second.run()).displacement, &rest);
            assert!(apart < 1e-9, "{scheme:?} {effects:?}: {apart:e}");
        }
    }
}
