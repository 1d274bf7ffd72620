//! Run-up through a resonance.

use std::f64::consts::TAU;

use faer::c64;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::integrate::{Part, Simulation};
use rubmap_wheel::dynamics::run_up::profile::SpeedProfile;
use rubmap_wheel::dynamics::run_up::segments::Cutting;

use super::blade::{Blade, at, difference};
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "run-up-through-resonance",
    covers: &[Subject::Kind("run_up"), Subject::Effect("engine_order_excitation")],
    claim: "A wheel that speeds up or slows down passes a resonance with the motion of its rate.",
    reference: "Lewis, Trans. ASME 54 (1932) 253–261: Duhamel's integral of ẍ + 2ζωẋ + ω²x = cos(n(Ω0 t + at²/2)), by Simpson's rule",
    quantity: "largest error over the whole run, over the largest displacement, slowly and fast upwards and slowly downwards",
    check: Check::Computed(Computed {
        error: passage,
        wrong: "amplitude of the force",
        limit: 4e-3,
        reason: "angles are kept to 1e-3 rad, and the force to three times that",
    }),
}];

const OMEGA: f64 = 600.0;
const RATIO: f64 = 0.002;
const ORDER: u32 = 3;

fn passage(wrong: f64) -> anyhow::Result<f64> {
    let samples = 96;
    let excitation = [EngineOrderExcitation {
        order: ORDER,
        directions: vec![Direction { node: 0, components: [0.0, 0.0, 1.0] }],
        amplitude: wrong,
        phase_rad: 0.0,
        ramp_revolutions: 0.0,
    }];
    let mut most = 0.0f64;
    for (from, to, rate) in [(150.0, 260.0, 220.0), (150.0, 260.0, 1500.0), (260.0, 150.0, -220.0)] {
        let profile = SpeedProfile::linear(&[(0.0, from), ((to - from) / rate, to)]);
        let cutting = Cutting {
            samples_per_revolution: samples,
            tolerance_rad: 1e-3,
            frame_revolutions: 64,
            band_ratio: 10.0,
            most_segments: 100_000,
        };
        let (mut state, mut found) = (Vec::new(), Vec::new());
        for segment in cutting.segments(&profile)? {
            let mut blade = Blade::new(vec![OMEGA], &[[0.0, 0.0, 1.0]]).damped(RATIO);
            blade.wheel.speed_rad_s = segment.speed_rad_s;
            (blade.steps, blade.samples) = (16 * samples, samples);
            let seen = [at(0, [0.0, 0.0, 1.0])];
            let simulation =
                blade.simulation(Effects { excitation: &excitation, ..Effects::default() }, &seen);
            let part = Part { first_sample: segment.first_sample, samples: segment.samples };
            let stretch = Simulation { initial: &state, ..simulation }.stretch(part, &|_| true);
            anyhow::ensure!(stretch.ended.is_none(), "the run-up broke off");
            found.extend_from_slice(&stretch.displacement[0]);
            state = stretch.end;
        }
        let instant = |sample: usize| {
            let angle = TAU * (sample + 1) as f64 / samples as f64;
            (-from + (from * from + 2.0 * rate * angle).sqrt()) / rate
        };
        let instants: Vec<f64> = (0..found.len()).map(instant).collect();
        let exact = duhamel(from, rate, &instants);
        most = most.max(difference(&found, |sample| exact[sample]));
    }
    Ok(most)
}

/// Displacement at ascending instants of an oscillator of mass 1 from rest: ∫ e^{p(T − t)} f(t) dt, its imaginary part over that of the pole p.
fn duhamel(start: f64, rate: f64, instants: &[f64]) -> Vec<f64> {
    let pole = c64::new(-RATIO * OMEGA, OMEGA * (1.0 - RATIO * RATIO).sqrt());
    let turned = |t: f64| c64::new((pole.im * t).cos(), (pole.im * t).sin()) * (pole.re * t).exp();
    let force = |t: f64| (f64::from(ORDER) * (start * t + 0.5 * rate * t * t)).cos();
    let halves = 128;
    let (mut sum, mut now) = (c64::ZERO, 0.0);
    let step = |&instant: &f64| {
        let h = (instant - now) / f64::from(halves);
        sum *= turned(instant - now);
        for half in 0..=halves {
            let weight = match half {
                0 => 1.0,
                _ if half == halves => 1.0,
                _ if half % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let t = now + h * f64::from(half);
            sum += turned(instant - t) * (weight * h / 3.0 * force(t));
        }
        now = instant;
        sum.im / pole.im
    };
    instants.iter().map(step).collect()
}
