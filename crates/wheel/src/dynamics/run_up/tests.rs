//! Runs in parts against runs in one. The passage of a resonance is a row of `rubmap_validation`.

mod euler;

use faer::{Mat, c64};

use crate::dynamics::casing::{Casing, Lobes};
use crate::dynamics::clearance_drift::ClearanceDrift;
use crate::dynamics::contact::disc::disc_directions;
use crate::dynamics::contact::friction::sliding_directions;
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::{Effects, Friction, FrictionLaw};
use crate::dynamics::euler::{EulerForce, SpeedRate, StraightRate};
use crate::dynamics::excitation::EngineOrderExcitation;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::integrate::{Outcome, Part, SensorRow, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::numbers::Numbers;
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 4 }];

fn nodes() -> Vec<ContactNode> {
    let node = |k: usize| ContactNode {
        id: k as u64,
        position: [100.0, 0.03 * k as f64, 4.0 * k as f64],
        normal: [0.8, 0.0, 0.6],
        dofs: [3 * k, 3 * k + 1, 3 * k + 2],
    };
    (0..2).map(node).collect()
}

/// Wheel of five sectors, seven modes each.
fn wheel(coriolis: bool) -> ModalWheel {
    let mut numbers = Numbers(0x1234_5678_9ABC_DEF1);
    let harmonic = |harmonic: usize| {
        let single = harmonic == 0;
        let contact = Mat::from_fn(6, 7, |_, _| {
            let (re, im) = (numbers.next(), numbers.next());
            c64::new(100.0 * re, if single { 0.0 } else { 100.0 * im })
        });
        let turned = |i: usize, j: usize| c64::from(0.3 * (j as f64 - i as f64).clamp(-1.0, 1.0));
        ModalHarmonic {
            harmonic,
            single,
            omega: (0..7).map(|m| 4000.0 * (1 + m) as f64 + 500.0 * harmonic as f64).collect(),
            contact,
            gyroscopic: coriolis.then(|| Mat::from_fn(7, 7, turned)),
        }
    };
    let harmonics = (0..=2).map(harmonic).collect();
    ModalWheel { speed_rad_s: 1000.0, sectors: 5, repeats: 1, harmonics }
}

fn excitation() -> [EngineOrderExcitation; 1] {
    [EngineOrderExcitation {
        order: 3,
        directions: vec![Direction { node: 1, components: [0.0, 0.0, 1.0] }],
        amplitude: 20.0,
        phase_rad: 0.2,
        ramp_revolutions: 0.5,
    }]
}

/// Effects of a run that is taken in parts.
#[derive(Debug, Clone, Copy, Default)]
struct Acting {
    touching: bool,
    driven: bool,
    coriolis: bool,
    mistuned: bool,
    friction: Option<FrictionLaw>,
    drifting: bool,
    speeding: bool,
}

/// Parts of a run, one after the other, are the run: free, touching, driven, on turning wheels, under friction, mistuned; parts that begin
/// within a revolution, and clearances that drift about others in each.
#[test]
fn parts_of_a_run_are_the_run() {
    let touching = Acting { touching: true, ..Acting::default() };
    let acting = [
        Acting::default(),
        touching,
        Acting { driven: true, ..touching },
        Acting { driven: true, coriolis: true, ..Acting::default() },
        Acting { driven: true, coriolis: true, ..touching },
        Acting { driven: true, mistuned: true, ..touching },
        Acting { friction: Some(FrictionLaw::Sliding), ..touching },
        Acting { friction: Some(FrictionLaw::Disc), ..touching },
        Acting { drifting: true, ..touching },
        Acting { speeding: true, mistuned: true, ..touching },
        Acting { speeding: true, coriolis: true, mistuned: true, ..touching },
    ];
    for scheme in SCHEMES {
        for acting in acting {
            let massless = matches!(scheme, Scheme::MasslessBoundary { .. });
            let runs = match acting {
                Acting { coriolis: true, .. } => scheme == Scheme::ExactModal,
                Acting { friction: Some(FrictionLaw::Disc), .. } => !massless,
                _ => true,
            };
            if runs {
                check_parts(scheme, acting);
            }
        }
    }
}

fn check_parts(scheme: Scheme, acting: Acting) {
    let (nodes, excitation) = (nodes(), excitation());
    let damping = ModalDamping { modal_ratio: 0.01, family_ratios: Vec::new(), ranks: Vec::new() };
    let casing = |clearance: [f64; 2]| Casing {
        clearance: clearance.to_vec(),
        restriction: Some(Lobes { count: 2, amplitude: 0.5, width_rad: 0.4, phase_rad: 0.1 }.into()),
        ramp_revolutions: 0.5,
    };
    // After so many revolutions, with drift.
    let clearance = |revolutions: f64| [0.25 + 0.02 * revolutions, 0.3 - 0.03 * revolutions];
    let drift = |revolutions: [f64; 2], without: [f64; 2]| {
        let [first, last] = revolutions.map(|at| clearance(at).to_vec());
        ClearanceDrift { revolutions, without: without.to_vec(), first, last }
    };
    let euler = |revolutions: [f64; 2]| EulerForce {
        rate: SpeedRate(vec![StraightRate { revolutions, rad_s2: revolutions.map(|at| 4e4 * (1.0 - at)) }]),
        load: (0..7).map(|m| 0.3 - 0.07 * f64::from(m)).collect(),
    };
    let directions = match acting.friction {
        Some(FrictionLaw::Sliding) => sliding_directions(&nodes, 0.05).unwrap(),
        Some(FrictionLaw::Disc) => disc_directions(&nodes).unwrap(),
        None => Vec::new(),
    };
    let push = InitialMode {
        harmonic: 1,
        family: 2,
        displacement: c64::new(1e-4, -2e-4),
        velocity: c64::new(0.5, 0.25),
    };
    let sensors = [SensorRow { direction: Direction { node: 1, components: [1.0, 0.25, 0.5] }, sector: 3 }];
    let wheel = wheel(acting.coriolis);
    let effects = Effects {
        excitation: if acting.driven { &excitation } else { &[] },
        mistuning: acting.mistuned.then_some(&[0.01, -0.02, 0.0, 0.015, -0.005][..]),
        friction: acting.friction.map(|law| Friction { coefficient: 0.05, law, directions: &directions }),
        ..Effects::default()
    };
    let (still, all) = (casing(clearance(0.0)), drift([0.0, 3.0], clearance(0.0)));
    let speeding = euler([0.0, 3.0]);
    let whole = Simulation {
        wheel: &wheel,
        contact_nodes: &nodes,
        damping: Some(&damping),
        casing: acting.touching.then_some(&still),
        effects: Effects {
            clearance_drift: acting.drifting.then_some(&all),
            euler_force: acting.speeding.then_some(&speeding),
            ..effects
        },
        initial: &[push],
        sensors: &sensors,
        scheme,
        steps_per_revolution: 960,
        samples_per_revolution: 120,
        revolutions: 3,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: None,
    };
    let run = whole.run(&|_| true);
    let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
    let mut state = vec![push];
    let (mut found, mut contact_steps) = (Vec::new(), 0);
    for samples in [37, 60, 83, 100, 80] {
        let part = Part { first_sample: found.len() as u64, samples };
        let ends = [part.first_sample, part.first_sample + samples].map(|sample| sample as f64 / 120.0);
        let middle = clearance(0.5 * (ends[0] + ends[1]));
        let (about, own, speeding) = (casing(middle), drift(ends, middle), euler(ends));
        let mut simulation = Simulation { initial: &state, window_revolutions: 0, ..whole };
        if acting.drifting {
            (simulation.casing, simulation.effects.clearance_drift) = (Some(&about), Some(&own));
        }
        simulation.effects.euler_force = acting.speeding.then_some(&speeding);
        let stretch = simulation.stretch(part, &|_| true);
        assert_eq!(stretch.ended, None);
        assert!(stretch.energy.residual() < 1e-9, "{acting:?} {}", stretch.energy.residual());
        for (largest, here) in stretch.largest[0].iter().zip(&stretch.displacement[0]) {
            assert!(*largest >= here.abs());
        }
        found.extend_from_slice(&stretch.displacement[0]);
        contact_steps += stretch.statistics.contact_steps;
        state = stretch.end;
    }
    let scale = history.displacement[0].iter().fold(0.0f64, |most, u| most.max(u.abs()));
    let off = found.iter().zip(&history.displacement[0]).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(off < 1e-8 * scale, "{scheme:?} {acting:?}: {}", off / scale);
    let counted = run.statistics.contact_steps;
    assert!(
        contact_steps.abs_diff(counted) <= 2 && (counted > 0) == acting.touching,
        "{contact_steps} {counted}"
    );
}

/// Drift is straight between its ends; a negative clearance presses by as much as the casing has grown.
#[test]
fn a_drift_is_linear_between_its_ends() {
    let drift = ClearanceDrift {
        revolutions: [4.0, 6.0],
        without: vec![0.1, -0.2],
        first: vec![0.2, -0.3],
        last: vec![0.4, 0.1],
    };
    for (revolutions, growth, expected) in
        [(4.0, 1.0, [0.1, -0.1]), (5.0, 1.0, [0.2, 0.1]), (6.0, 1.0, [0.3, 0.3]), (4.0, 0.5, [0.1, -0.05])]
    {
        let mut gaps = vec![0.0; 16];
        drift.add(revolutions, growth, 8, &mut gaps);
        for sector in gaps.chunks_exact(8) {
            assert!((sector[0] - expected[0]).abs() < 1e-15 && (sector[1] - expected[1]).abs() < 1e-15);
            assert_eq!(sector[2..], [0.0; 6]);
        }
    }
}

/// Wheel that nothing touches, with given steps and samples per revolution.
fn untouched<'a>(
    wheel: &'a ModalWheel,
    contact_nodes: &'a [ContactNode],
    damping: &'a ModalDamping,
    effects: Effects<'a>,
    initial: &'a [InitialMode],
    steps_per_revolution: usize,
    samples_per_revolution: usize,
) -> Simulation<'a> {
    Simulation {
        wheel,
        contact_nodes,
        damping: Some(damping),
        casing: None,
        effects,
        initial,
        sensors: &[],
        scheme: Scheme::ExactModal,
        steps_per_revolution,
        samples_per_revolution,
        revolutions: 1,
        window_revolutions: 0,
        repeats: None,
        detail: None,
        states: None,
    }
}
