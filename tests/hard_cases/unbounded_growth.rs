//! Response that grows without bound.
//!
//! Left alone it overflows after hours, spreads NaN over every result, or is reported as an amplitude. Guaranteed: found at
//! the first sample at which any component of a tip is beyond a tenth of the wheel's radius, with node, sector, component, time and the
//! growth of its energy; the sweep
//! has a message at that speed and no amplitude, and goes on.

use std::f64::consts::TAU;

use faer::c64;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::PointStatus;
use rubmap::analysis::run::run_speed;
use rubmap::dynamics::initial::{InitialMode, InitialWave};
use rubmap::dynamics::integrate::{Divergence, Outcome, TipComponent, TipDisplacement};
use rubmap::dynamics::schemes::Scheme;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::scenes::Scene;
use crate::support::{ENERGY_TOLERANCE, SCHEMES, assert_sound, assert_survives_json, reduced, sweep};

const SECTORS: usize = 7;

/// Unstable step: the highest mode of nodal diameter 1 a little beyond central differences' limit, ωh = 2(1 + δ), grows
/// by exp(acosh(1 + 4δ + 2δ²)) a step and changes sign.
#[test]
fn an_unstable_step_is_found_when_theory_says() {
    for delta in [1e-5, 1e-4, 1e-2] {
        let mut scene = Scene::new(WheelRecipe { sectors: SECTORS, stiffening: false, ..Default::default() });
        let casing = scene.casing.as_mut().unwrap();
        (casing.clearance, casing.restriction) = (vec![100.0; 3], None);
        scene.damping_ratio = 0.0;
        let pair = &scene.wheel.harmonics[1];
        let family = pair.omega.len() - 1;
        let (steps, start) = (640, 1e-12);
        // h = 2(1 + δ)/ω
        scene.wheel.speed_rad_s = TAU * pair.omega[family] / (2.0 * (1.0 + delta) * steps as f64);
        let growth = (4.0 * delta + 2.0 * delta * delta + 1.0f64).acosh();
        scene.samples = 64;
        scene.revolutions = 40;
        scene.initial = vec![InitialMode {
            harmonic: 1,
            family,
            displacement: c64::new(start, 0.0),
            velocity: c64::ZERO,
        }];
        // z_q = ±start·cosh(q·growth): the node and sector that move most, and when they pass the bound.
        let (mut most, mut place) = (0.0, (0, 0, TipComponent::Normal));
        for sector in 0..SECTORS {
            let turn = TAU * sector as f64 / SECTORS as f64;
            for (k, node) in scene.contact.iter().enumerate() {
                for (component, along) in [
                    (TipComponent::Normal, node.normal),
                    (TipComponent::Radial, [1.0, 0.0, 0.0]),
                    (TipComponent::Tangential, [0.0, 1.0, 0.0]),
                    (TipComponent::Axial, [0.0, 0.0, 1.0]),
                ] {
                    let shape: c64 = (0..3).map(|d| pair.contact[(3 * k + d, family)] * along[d]).sum();
                    let turned = (shape * c64::new(turn.cos(), turn.sin())).re;
                    let moved = ((2.0 / SECTORS as f64).sqrt() * turned).abs();
                    if moved > most {
                        (most, place) = (moved, (k, sector, component));
                    }
                }
            }
        }
        let radius = scene.contact.iter().fold(0.0f64, |r, node| r.max(node.position[0]));
        let expected = (0.1 * radius / (most * start)).acosh() / growth;
        let run = scene.run(Scheme::CentralDifferences, steps);
        let Outcome::Diverged(found) = run.outcome else { panic!("{:?}", run.outcome) };
        let Divergence { revolutions, tip, energy_growth } = found;
        let TipDisplacement { displacement, contact_node, sector, component } = tip.unwrap();
        let step = (revolutions * steps as f64).round();
        // Samples are ten steps apart.
        assert!((expected..expected + 11.0).contains(&step), "{found:?} {expected}");
        assert_eq!((contact_node, sector, component), place);
        assert!(
            displacement > 0.1 * radius && displacement < 0.1 * radius * (11.0 * growth).exp(),
            "{found:?}"
        );
        assert_eq!(energy_growth.is_some(), revolutions > 1.0, "{found:?}");
    }
}

/// Tip that swings along the casing and not at all towards it: nothing touches, and nothing along the normal tells.
#[test]
fn a_tip_that_swings_along_the_casing_is_found() {
    let mut scene = Scene::new(WheelRecipe { sectors: SECTORS, ..Default::default() });
    scene.damping_ratio = 0.0;
    scene.casing.as_mut().unwrap().restriction = None;
    for node in &mut scene.contact {
        node.normal = [0.8, 0.0, 0.6];
    }
    let shapes = &mut scene.wheel.harmonics[1].contact;
    for row in (0..shapes.nrows()).filter(|row| row % 3 != 1) {
        shapes[(row, 0)] = c64::ZERO;
    }
    let radius = scene.contact.iter().fold(0.0f64, |r, node| r.max(node.position[0]));
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 3 }]
    {
        for share in [0.12, 0.099] {
            let amplitude = share * radius;
            scene.initial = vec![InitialMode::of_amplitude(
                &scene.wheel,
                1,
                0,
                amplitude,
                c64::new(1.0, 0.0),
                InitialWave::Standing,
            )];
            let run = scene.run(scheme, scene.steps(scheme, 1.5));
            match run.outcome {
                Outcome::Diverged(Divergence { tip: Some(tip), .. }) => {
                    assert!(share > 0.1 && tip.component == TipComponent::Tangential, "{tip:?}");
                    assert!((0.1 * radius..=amplitude).contains(&tip.displacement), "{tip:?}");
                }
                Outcome::Completed(_) => assert!(share < 0.1, "{scheme:?}"),
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Wheel that hardly anything holds to its hub, without damping: lobes throw its blades about ever more.
#[test]
fn a_speed_that_diverges_has_a_message_and_no_amplitude() {
    let sector = wheel(WheelRecipe { ground: 0.01, ..Default::default() });
    let reduced = reduced(&sector, 6);
    for scheme in SCHEMES {
        let changes = json!({
            "scene": {"damping": {"modal_ratio": 0.0}, "casing": {"lobes": {"amplitude": 1.0}}},
            "integration": {"revolutions": 30, "window_revolutions": 4}
        });
        let request = sweep(&sector, scheme, &[0.6, 0.3].map(|share| share * TOP_SPEED), changes);
        let [thrown, held] =
            [0, 1].map(|index| run_speed(&reduced, &request, index, None, &Unwatched).unwrap());
        let point = &thrown.point;
        assert_eq!(point.status, PointStatus::Diverged, "{point:?}");
        assert!(point.steps < 30 * u64::from(point.steps_per_revolution), "{point:?}");
        let message = point.message.as_deref().unwrap();
        let directions = ["radially", "tangentially", "axially", "along its normal"];
        assert!(directions.iter().any(|direction| message.contains(direction)), "{message}");
        for said in ["revolutions contact node", "of sector", " mm, more than a tenth of the wheel's radius"]
        {
            assert!(message.contains(said), "{message}");
        }
        // A blade that is thrown out may lose energy on its way.
        let grew = message.starts_with("the response grew without bound: ");
        assert_eq!(grew, message.contains("; the energy was "), "{message}");
        assert!(
            thrown.spectra.is_none() && point.responses.is_empty() && point.settling.is_none(),
            "{point:?}"
        );
        // The work until then is accounted for.
        assert!(point.energy_residual.unwrap() < ENERGY_TOLERANCE, "{point:?}");
        assert!(point.largest_energy.is_some() && point.contact_share > 0.0, "{point:?}");
        assert_survives_json(&thrown);
        if held.point.status == PointStatus::Completed {
            assert_sound(&held, 1.0);
        } else {
            assert!(held.point.message.is_some() && held.spectra.is_none(), "{:?}", held.point);
        }
    }
}
