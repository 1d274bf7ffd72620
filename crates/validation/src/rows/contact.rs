//! Contact: impacts, static pressure, friction, coating, and clearances that close.

use std::f64::consts::{PI, SQRT_2, TAU};

use anyhow::ensure;
use faer::{Mat, c64};
use rubmap_wheel::dynamics::clearance_change::ClearanceChange;
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap_wheel::dynamics::contact::friction::sliding_directions;
use rubmap_wheel::dynamics::effects::{Effects, Friction, FrictionLaw};
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::sector::ContactNode;

use super::blade::{Blade, SPEED, relative};
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[
    Claim {
        name: "thrown-bar",
        covers: &[Subject::Effect("contact"), Subject::Effect("casing"), Subject::Effect("initial")],
        claim: "An elastic bar that is thrown against a wall is stopped by the wave and leaves as it came, with every contact scheme.",
        reference: "closed form of the wave equation (Doyen, Ern and Piperno, SIAM J. Sci. Comput. 33 (2011) 223–249): force EAv/c for the time 2L/c, then the velocity −v",
        quantity: "largest relative error of force, duration of contact and velocity after it, 400 elements",
        check: Check::Computed(Computed {
            error: thrown_bar,
            wrong: "velocity of the throw",
            limit: 1e-2,
            reason: "first order in the length of an element: mass at the contact node, and beginning and end of contact within a step",
        }),
    },
    Claim {
        name: "impact-oscillator",
        covers: &[Subject::Effect("contact"), Subject::Effect("orbit"), Subject::Effect("initial")],
        claim: "A blade bounces off the wall without loss, at the frequency that the distance of the wall gives it.",
        reference: "closed form: oscillator with a stop of restitution one at the distance d from its middle, ω/ω0 = π/(π − arccos(d/A))",
        quantity: "largest relative error of the frequency at d/A of 0.9, 0.5 and 0",
        check: Check::Computed(Computed {
            error: impact_oscillator,
            wrong: "natural frequency",
            limit: 2e-3,
            reason: "the stop is elastic: contact lasts about a thousandth of a period",
        }),
    },
    Claim {
        name: "closing-clearance",
        covers: &[Subject::Effect("clearance_change"), Subject::Effect("casing")],
        claim: "A wall that has closed in on a blade presses it as on a spring.",
        reference: "closed form: F = kδ of a spring pushed by δ",
        quantity: "relative error of the mean force over the revolution after the closing",
        check: Check::Computed(Computed {
            error: closing_clearance,
            wrong: "displacement of the wall",
            limit: 1e-6,
            reason: "the closing leaves a vibration, which damping has taken away",
        }),
    },
    Claim {
        name: "leaning-rod",
        covers: &[Subject::Effect("friction"), Subject::Effect("damping"), Subject::Effect("orbit")],
        claim: "A tip that slides over the casing is dragged back by the friction coefficient times the force.",
        reference: "closed form: leaning rod pushed by δ with the flexibility C, force N = δ/(nᵀC(n + μt)), displacement −N C(n + μt)",
        quantity: "largest error of the displacement's two components over the larger one",
        check: Check::Computed(Computed {
            error: leaning_rod,
            wrong: "friction coefficient",
            limit: 1e-6,
            reason: "the approach leaves a vibration, which damping has taken away",
        }),
    },
    Claim {
        name: "abradable-rod",
        covers: &[Subject::Effect("abradable")],
        claim: "A blade wears an abradable coating until the stress in it falls to its yield stress.",
        reference: "closed form: spring against an elastic–plastic rod with linear hardening, k(δ − x) = A(σ_Y + EK/(E + K)(x/t − σ_Y/E))",
        quantity: "relative error of the depth x after five revolutions",
        check: Check::Computed(Computed {
            error: abradable_rod,
            wrong: "yield stress",
            limit: 1e-6,
            reason: "the approach leaves a vibration, which damping has taken away",
        }),
    },
];

/// Length, Young's modulus and wave speed of a bar of density and cross-section one.
const LENGTH: f64 = 10.0;
const MODULUS: f64 = 900.0;
const WAVE_SPEED: f64 = 30.0;

/// Free bar of elements with their mass at the nodes, whose end points to the casing; its tangential displacement is that of its middle.
/// A revolution takes `duration`.
fn bar(elements: usize, scheme: Scheme, step: f64, duration: f64, velocity: f64) -> Blade {
    let shape = |mode: usize| {
        let alone = mode == 0 || mode == elements;
        let end = if alone { 1.0 } else { SQRT_2 } / LENGTH.sqrt();
        [end, if mode == 0 { end } else { 0.0 }, 0.0]
    };
    let omega = |mode: usize| {
        let size = LENGTH / elements as f64;
        2.0 * MODULUS.sqrt() / size * (0.5 * PI * mode as f64 / elements as f64).sin()
    };
    let shapes: Vec<_> = (0..=elements).map(shape).collect();
    let mut bar = Blade::new((0..=elements).map(omega).collect(), &shapes);
    bar.scheme = scheme;
    bar.steps = (duration / step).round() as usize;
    bar.samples = bar.steps;
    bar.wheel.speed_rad_s = TAU / (bar.steps as f64 * step);
    bar.initial = vec![InitialMode {
        harmonic: 0,
        family: 0,
        displacement: c64::ZERO,
        velocity: c64::from(velocity / shape(0)[0]),
    }];
    bar
}

fn thrown_bar(wrong: f64) -> anyhow::Result<f64> {
    let (elements, clearance, velocity) = (400, 1.0, 3.0);
    let crossing = LENGTH / WAVE_SPEED;
    let step = 0.9 * crossing / elements as f64;
    let mut most = 0.0f64;
    for scheme in
        [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 40 }]
    {
        let thrown = |after: f64| {
            let bar = bar(elements, scheme, step, clearance / velocity + after, wrong * velocity);
            bar.in_casing(clearance, 0.0).run(Effects::default())
        };
        let (half, _) = thrown(crossing)?;
        let force = half.statistics.contact_impulse / crossing;
        let (all, seen) = thrown(3.0 * crossing)?;
        let lasted = all.statistics.contact_steps as f64 * step;
        let middle = &seen[1][seen[1].len() - 2..];
        most = most.max(relative([
            (force, MODULUS * velocity / WAVE_SPEED),
            (lasted, 2.0 * crossing),
            ((middle[1] - middle[0]) / step, -velocity),
        ]));
    }
    Ok(most)
}

fn impact_oscillator(wrong: f64) -> anyhow::Result<f64> {
    let omega = 10.0 * SPEED;
    let mut most = 0.0f64;
    for share in [0.9f64, 0.5, 0.0] {
        let orbit = Orbit { radius: 0.4, whirl_ratio: 1.0, phase_rad: 0.2 };
        let shapes = [[1.0, 0.0, 0.0], [10.0, 0.0, 0.0]];
        let mut blade = Blade::new(vec![wrong * omega, 1e4 * omega], &shapes)
            .in_casing(share + orbit.radius * orbit.phase_rad.cos(), 0.0);
        blade.scheme = Scheme::MasslessBoundary { kept_modes: 1 };
        let start =
            InitialMode { harmonic: 0, family: 0, displacement: c64::from(-1.0), velocity: c64::ZERO };
        blade.initial = vec![start];
        blade.steps = 32 * blade.scheme.smallest_stable_steps(&blade.wheel, &blade.nodes) as usize;
        blade.samples = blade.steps;
        let (_, seen) = blade.run(Effects { orbit: Some(orbit), ..Effects::default() })?;
        let line = &seen[0];
        let turns: Vec<usize> = (1..line.len() - 1)
            .filter(|&q| line[q] < line[q - 1] && line[q] <= line[q + 1] && line[q] < -0.5)
            .collect();
        ensure!(turns.len() > 5, "the blade swings {} times only", turns.len());
        let time = (turns[turns.len() - 1] - turns[0]) as f64 * blade.step_s();
        let found = TAU * (turns.len() - 1) as f64 / time;
        most = most.max(relative([(found / omega, PI / (PI - share.acos()))]));
    }
    Ok(most)
}

fn closing_clearance(wrong: f64) -> anyhow::Result<f64> {
    let (mass, omega, clearance, push) = (2.5e-6f64, 2e4, 0.1, 0.05);
    let course = vec![(2.0, -wrong * (clearance + push))];
    let change = ClearanceChange { course, along_chord: None };
    let mut blade =
        Blade::new(vec![omega], &[[mass.sqrt().recip(), 0.0, 0.0]]).damped(0.3).in_casing(clearance, 0.0);
    let mut impulse = |revolutions: usize| {
        blade.revolutions = revolutions;
        let effects = Effects { clearance_change: Some(&change), ..Effects::default() };
        anyhow::Ok(blade.run(effects)?.0.statistics.contact_impulse)
    };
    let force = (impulse(5)? - impulse(4)?) * SPEED / TAU;
    Ok(relative([(force, mass * omega * omega * push)]))
}

fn leaning_rod(wrong: f64) -> anyhow::Result<f64> {
    let (coefficient, lean, clearance, radius) = (0.3, 0.4f64, 0.05, 0.35);
    let (sin, cos) = lean.sin_cos();
    // Along the rod and across it.
    let (omega, shapes) = ([9.0 * SPEED, 5.0 * SPEED], [[cos, sin, 0.0], [-sin, cos, 0.0]]);
    let mut blade = Blade::new(omega.to_vec(), &shapes).damped(0.3).in_casing(clearance, 1.0);
    blade.revolutions = 4;
    let directions = sliding_directions(&blade.nodes, wrong * coefficient)?;
    let friction =
        Friction { coefficient: wrong * coefficient, law: FrictionLaw::Sliding, directions: &directions };
    let orbit = Orbit { radius, whirl_ratio: 1.0, phase_rad: 0.0 };
    let effects = Effects { friction: Some(friction), orbit: Some(orbit), ..Effects::default() };
    let (_, seen) = blade.run(effects)?;
    let along = [1.0, coefficient];
    let moved = [0, 1].map(|row: usize| {
        let part = |mode: usize| {
            shapes[mode][row] * (shapes[mode][0] * along[0] + shapes[mode][1] * along[1])
                / omega[mode].powi(2)
        };
        part(0) + part(1)
    });
    let force = (radius - clearance) / moved[0];
    let exact = moved.map(|flexibility| -force * flexibility);
    let largest = exact[0].abs().max(exact[1].abs());
    let last = |component: usize| seen[component][seen[component].len() - 1];
    Ok([0, 1].map(|k| (last(k) - exact[k]).abs() / largest).into_iter().fold(0.0, f64::max))
}

fn abradable_rod(wrong: f64) -> anyhow::Result<f64> {
    let (mass, omega, clearance, radius): (f64, f64, f64, f64) = (2.5e-6, 2e4, 0.05, 0.35);
    let (modulus, yield_stress, hardening, thickness, rods, height) = (2e3, 20.0, 100.0, 1.0, 400, 4.0);
    let mut blade = Blade::new(vec![omega; 2], &[[0.0; 3]; 2]).damped(0.5);
    let end = |z: f64, first: usize| ContactNode {
        position: [100.0, 0.0, z],
        dofs: [first, first + 1, first + 2],
        ..blade.nodes[0].clone()
    };
    blade.nodes = vec![end(0.0, 0), end(height, 3)];
    // Both ends of the tip move radially, each on its own.
    let radial = |row: usize, mode: usize| if row == 3 * mode { mass.sqrt().recip() } else { 0.0 };
    blade.wheel.harmonics[0].contact = Mat::from_fn(6, 2, |row, mode| c64::from(radial(row, mode)));
    let mut blade = blade.in_casing(clearance, 3.0);
    blade.revolutions = 5;
    let material = CoatingMaterial { modulus, yield_stress: wrong * yield_stress, hardening };
    let coating = Coating::new(material, thickness, rods, &blade.nodes, 1)?;
    let orbit = Orbit { radius, whirl_ratio: 1.0, phase_rad: 0.0 };
    let effects = Effects { coating: Some(&coating), orbit: Some(orbit), ..Effects::default() };
    let (_, seen) = blade.run(effects)?;
    let push = radius - clearance;
    let (stiffness, area) = (mass * omega * omega, TAU * 100.0 / rods as f64 * 0.5 * height);
    let plastic = modulus * hardening / (modulus + hardening);
    let exact = (stiffness * push - area * yield_stress * (1.0 - plastic / modulus))
        / (stiffness + area * plastic / thickness);
    let found = push + seen[0][seen[0].len() - 1];
    Ok(relative([(found, exact)]))
}
