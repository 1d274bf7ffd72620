//! Effects on the modes and on the casing: engine orders, damping, mistuning, elastic ring.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::flexible_casing::{FlexibleCasing, Ring};
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::modal_wheel::ModalHarmonic;
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::schemes::Scheme;

use super::blade::{Blade, SPEED, at, difference};
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[
    Claim {
        name: "driven-oscillator",
        covers: &[Subject::Effect("engine_order_excitation"), Subject::Effect("damping")],
        claim: "A damped blade answers to an engine order with amplitude and phase.",
        reference: "closed form: z = F e^{jkΩt}/(ω² − (kΩ)² + 2jζωkΩ)",
        quantity: "largest error over a revolution, over the amplitude, central differences and exact modes",
        check: Check::Computed(Computed {
            error: driven_oscillator,
            wrong: "damping ratio",
            limit: 1e-4,
            reason: "second order in the step, 4000 a revolution",
        }),
    },
    Claim {
        name: "mistuned-pair",
        covers: &[Subject::Effect("mistuning"), Subject::Effect("initial")],
        claim: "Two blades of different stiffness beat.",
        reference: "closed form: λ = (ω0² + ω1²)/2 ± √((ω1² − ω0²)²/4 + (ω0ω1δ)²) for deviations δ and −δ",
        quantity: "largest error of both blades over two revolutions, over the amplitude",
        check: Check::Computed(Computed {
            error: mistuned_pair,
            wrong: "deviation of the stiffness",
            limit: 1e-3,
            reason: "second order in the step, 4000 a revolution",
        }),
    },
    Claim {
        name: "blade-on-a-ring",
        covers: &[Subject::Effect("flexible_casing"), Subject::Effect("contact")],
        claim: "A blade that presses an elastic casing vibrates with it.",
        reference: "closed form: ω² = (m_b ω_b² + m_c ω_c²)/(m_b + m_c) with the breathing ring, ω_c² = E/ρR², m_c = 2πρAR (Love; Timoshenko, Vibration Problems in Engineering)",
        quantity: "relative error of ω², by the acceleration over the displacement",
        check: Check::Computed(Computed {
            error: blade_on_a_ring,
            wrong: "cross-section of the ring",
            limit: 1e-7,
            reason: "round-off of second differences",
        }),
    },
];

fn driven_oscillator(wrong: f64) -> anyhow::Result<f64> {
    let (omega, ratio, order, amplitude, phase) = (2.3 * SPEED, 0.3, 3, 4e5, 0.7);
    let excitation = [EngineOrderExcitation {
        order,
        directions: vec![Direction { node: 0, components: [0.0, 1.0, 0.0] }],
        amplitude,
        phase_rad: phase,
        ramp_revolutions: 1.0,
    }];
    let driven = f64::from(order) * SPEED;
    let force = c64::new(phase.cos(), phase.sin()) * (0.5 * amplitude);
    let z = force / c64::new(omega * omega - driven * driven, 2.0 * ratio * omega * driven);
    let mut most = 0.0f64;
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
        let mut blade = Blade::new(vec![omega], &[[1.0, 0.5, 0.0]]).damped(wrong * ratio);
        (blade.scheme, blade.revolutions) = (scheme, 8);
        let (_, seen) = blade.run(Effects { excitation: &excitation, ..Effects::default() })?;
        let last = &seen[0][7 * blade.samples..];
        let turned = |sample: usize| f64::from(order) * TAU * (sample + 1) as f64 / blade.samples as f64;
        let exact = |sample: usize| (z * c64::new(turned(sample).cos(), turned(sample).sin())).re;
        most = most.max(difference(last, exact));
    }
    Ok(most)
}

fn mistuned_pair(wrong: f64) -> anyhow::Result<f64> {
    let (omega, delta) = ([2.9 * SPEED, 3.1 * SPEED], 0.12);
    let mut blade = Blade::new(Vec::new(), &[]);
    blade.wheel.sectors = 2;
    let mode = |harmonic: usize| ModalHarmonic {
        harmonic,
        single: true,
        omega: vec![omega[harmonic]],
        contact: Mat::from_fn(3, 1, |row, _| c64::from(if row == 0 { 1.0 } else { 0.0 })),
        gyroscopic: None,
    };
    blade.wheel.harmonics = vec![mode(0), mode(1)];
    blade.initial = vec![InitialMode { harmonic: 0, family: 0, displacement: c64::ONE, velocity: c64::ZERO }];
    blade.revolutions = 2;
    let deviations = [wrong * delta, -wrong * delta];
    let effects = Effects { mistuning: Some(&deviations), ..Effects::default() };
    let (_, seen) = blade.run_seen(effects, &[0, 1].map(|sector| at(sector, [1.0, 0.0, 0.0])))?;
    let (squares, coupling) = (omega.map(|w| w * w), omega[0] * omega[1] * delta);
    let (mean, half) = (0.5 * (squares[0] + squares[1]), 0.5 * (squares[1] - squares[0]));
    let spread = half.hypot(coupling);
    let exact = |sector: usize, sample: usize| {
        let t = TAU / SPEED * (sample + 1) as f64 / blade.samples as f64;
        let (fast, slow) = (((mean + spread).sqrt() * t).cos(), ((mean - spread).sqrt() * t).cos());
        let alike = 0.5 * (fast + slow) - 0.5 * half / spread * (fast - slow);
        let opposed = 0.5 * coupling / spread * (fast - slow);
        (if sector == 0 { alike + opposed } else { alike - opposed }) * 0.5f64.sqrt()
    };
    Ok((0..2).map(|sector| difference(&seen[sector], |sample| exact(sector, sample))).fold(0.0, f64::max))
}

fn blade_on_a_ring(wrong: f64) -> anyhow::Result<f64> {
    let (radius, modulus, density, area) = (101.0, 2e5, 8e-9, 9.0);
    let ring = Ring { radius, modulus, density, area: wrong * area, second_moment: 7.0 };
    let casing = FlexibleCasing { waves: ring.waves(0), damping_ratio: 0.0 };
    let (mass, omega) = (3e-4f64, 4.0 * SPEED);
    let mut blade = Blade::new(vec![omega], &[[mass.sqrt().recip(), 0.0, 0.0]]).in_casing(0.05, 0.3);
    // Whirl that takes the whole gap and more, and after its growth stays.
    let orbit = Orbit { radius: 0.5, whirl_ratio: 1.0, phase_rad: 0.0 };
    (blade.scheme, blade.samples, blade.revolutions) = (Scheme::CentralDifferences, blade.steps, 2);
    let effects = Effects { flexible_casing: Some(&casing), orbit: Some(orbit), ..Effects::default() };
    let (_, seen) = blade.run(effects)?;
    let h = blade.step_s();
    // Straight line of (u⁺ − 2u + u⁻)/h² over u, of the slope −ω².
    let points: Vec<_> =
        seen[0][1500..].windows(3).map(|u| (u[1], (u[2] - 2.0 * u[1] + u[0]) / (h * h))).collect();
    let count = points.len() as f64;
    let x = points.iter().map(|point| point.0).sum::<f64>() / count;
    let y = points.iter().map(|point| point.1).sum::<f64>() / count;
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    let ring_mass = TAU * density * area * radius;
    let ring_square = modulus / (density * radius * radius);
    let exact = (mass * omega * omega + ring_mass * ring_square) / (mass + ring_mass);
    Ok((-slope / exact - 1.0).abs())
}
