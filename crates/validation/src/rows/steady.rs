//! Periodic responses, and what becomes of a disturbance of them.

use std::f64::consts::TAU;

use faer::c64;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::integrate::Passage;
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::steady::multipliers::multipliers;
use rubmap_wheel::dynamics::steady::periodic::{Search, find};
use rubmap_wheel::dynamics::steady::tangent::Tangent;

use super::blade::Blade;
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "one-sided-spring",
    covers: &[Subject::Kind("sweep"), Subject::Kind("branches"), Subject::Effect("orbit")],
    claim: "Steady states of a rubbing blade repeat, and their multipliers tell how a disturbance grows or decays.",
    reference: "closed form: mass on a spring that an eccentric stop with a spring of its own meets from one side, two linear phases joined where they meet; their flow, and its derivative by differences",
    quantity: "largest error of the state over the clearance, and of sum and product of both multipliers, at three speeds",
    check: Check::Computed(Computed {
        error: one_sided_spring,
        wrong: "stiffness of the stop",
        limit: 5e-4,
        reason: "first order in the step where phases end within one, 16 000 a revolution",
    }),
}];

const OMEGA: f64 = 1.0;
const RATIO: f64 = 0.05;
/// Stiffness of the stop.
const STOP: f64 = 3.0;
const CLEARANCE: f64 = 0.3;
const AMPLITUDE: f64 = 0.5;

type State = [f64; 2];

/// Overlap of mass and stop at an instant.
fn overlap(x: State, speed: f64, t: f64) -> f64 {
    x[0] + AMPLITUDE * (speed * t).cos() - CLEARANCE
}

/// State after a time `t` that begins at `from` and is all touching or all free.
fn phase(x: State, speed: f64, from: f64, t: f64, touching: bool) -> State {
    let stop = if touching { STOP } else { 0.0 };
    let stiffness = OMEGA * OMEGA + stop;
    let transfer = c64::new(stiffness - speed * speed, 2.0 * RATIO * OMEGA * speed);
    let forced = |t: f64| {
        let (sin, cos) = (speed * t).sin_cos();
        let x = c64::new(cos, sin) * (-stop * AMPLITUDE) / transfer;
        [x.re + stop * CLEARANCE / stiffness, -speed * x.im]
    };
    let decay = RATIO * OMEGA;
    let damped = (stiffness - decay * decay).sqrt();
    let (sin, cos) = (damped * t).sin_cos();
    let (before, after, less) = (forced(from), forced(from + t), (-decay * t).exp());
    let [u, v] = [x[0] - before[0], x[1] - before[1]];
    [
        after[0] + less * (cos * u + sin / damped * (v + decay * u)),
        after[1] + less * (cos * v - sin / damped * (stiffness * u + decay * v)),
    ]
}

/// State after a revolution: phases end where the overlap does, found by bisection.
fn flow(mut x: State, speed: f64) -> State {
    let period = TAU / speed;
    let mut t = 0.0;
    while t < period {
        // Past the present instant, which may lie between two phases.
        let mut held = 1e-9 * period;
        let soon = phase(x, speed, t, held, overlap(x, speed, t) > 0.0);
        let touching = overlap(soon, speed, t + held) > 0.0;
        let goes_on = |dt: f64| (overlap(phase(x, speed, t, dt, touching), speed, t + dt) > 0.0) == touching;
        let mut next = held;
        while t + next < period && goes_on(next) {
            held = next;
            next += period / 4096.0;
        }
        next = next.min(period - t);
        if goes_on(next) {
            held = next;
        } else {
            while next - held > 1e-15 * period {
                let middle = 0.5 * (held + next);
                if goes_on(middle) { held = middle } else { next = middle }
            }
            held = next;
        }
        x = phase(x, speed, t, held, touching);
        t += held;
    }
    x
}

/// Derivative of the flow.
fn derivative(x: State, speed: f64) -> [[f64; 2]; 2] {
    let by = 1e-5;
    let aside = |axis: usize, by: f64| {
        let mut x = x;
        x[axis] += by;
        flow(x, speed)
    };
    let columns = [0, 1].map(|axis| {
        let (ahead, behind) = (aside(axis, by), aside(axis, -by));
        [0, 1].map(|row| (ahead[row] - behind[row]) / (2.0 * by))
    });
    [[columns[0][0], columns[1][0]], [columns[0][1], columns[1][1]]]
}

/// Periodic response near `x`, by Newton's method, with sum and product of its multipliers.
fn exact(mut x: State, speed: f64) -> (State, f64, f64) {
    for _ in 0..20 {
        let (end, d) = (flow(x, speed), derivative(x, speed));
        let (a, b, c, e) = (1.0 - d[0][0], -d[0][1], -d[1][0], 1.0 - d[1][1]);
        let (f, g) = (end[0] - x[0], end[1] - x[1]);
        let determinant = a * e - b * c;
        x = [x[0] + (e * f - b * g) / determinant, x[1] + (a * g - c * f) / determinant];
    }
    let d = derivative(x, speed);
    (x, d[0][0] + d[1][1], d[0][0] * d[1][1] - d[0][1] * d[1][0])
}

fn one_sided_spring(wrong: f64) -> anyhow::Result<f64> {
    let mut most = 0.0f64;
    for speed in [0.8, 1.2, 1.9] {
        // Second mode that does not move but yields as the stop does.
        let stiff = 1e3 * OMEGA;
        let yielding = (wrong * STOP).recip().sqrt() * stiff;
        let shapes = [[1.0, 0.0, 0.0], [yielding, 0.0, 0.0]];
        let mut blade = Blade::new(vec![OMEGA, stiff], &shapes).damped(RATIO).in_casing(CLEARANCE, 0.0);
        blade.wheel.speed_rad_s = speed;
        blade.scheme = Scheme::MasslessBoundary { kept_modes: 1 };
        blade.steps = 16_000;
        let orbit = Orbit { radius: AMPLITUDE, whirl_ratio: 0.0, phase_rad: 0.0 };
        let simulation = blade.simulation(Effects { orbit: Some(orbit), ..Effects::default() }, &[]);
        let mut passage = Passage::over_lobes(&simulation, 1)?;
        let search = Search { tolerance: 1e-12, marched: 20, most: 1000 };
        let state = find(&mut passage, &[0.0, 0.0], &search, &|| true)?.state;
        passage.map(&state)?;
        anyhow::ensure!(!passage.trace().instants.is_empty(), "the stop is not met at {speed}");
        let pair = multipliers(&Tangent::of(&passage), 2, &[1.0; 2]);
        let (sum, product) = (pair[0].value + pair[1].value, pair[0].value * pair[1].value);
        let (x, exact_sum, exact_product) = exact([state[0] / OMEGA, state[1]], speed);
        most = most
            .max((state[0] / OMEGA - x[0]).abs() / CLEARANCE)
            .max((sum - exact_sum).norm())
            .max((product - exact_product).norm());
    }
    Ok(most)
}
