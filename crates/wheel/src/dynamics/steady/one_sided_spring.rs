//! Mass on a spring that a shaken stop with a spring of its own meets from one side: the equation of one mode with a boundary without mass.
//!
//! ```text
//! η̈ + 2ζω η̇ + ω² η = −φ λ,   λ = max(0, (φη + p − c)/F),   p = A cos Ωt
//! ```
//!
//! Two linear phases, each with a solution in closed form, that meet where λ = 0. Force and velocity are continuous there, so that the
//! derivative of the flow over a period is the product of the phases' own.

use std::f64::consts::TAU;

use faer::prelude::Solve;
use faer::{Mat, c64};

use super::branch::follow::{Front, Step};
use super::branch::locate::{FinerGrowth, off_by_steps};
use super::branch::{Branch, Family, Lap, Motion, Unreachable};
use super::multipliers::multipliers;
use super::periodic::{Search, find};
use super::tangent::Tangent;
use crate::dynamics::casing::{Casing, RestrictionTable};
use crate::dynamics::effects::Effects;
use crate::dynamics::initial::Stepped;
use crate::dynamics::integrate::{Passage, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

const OMEGA: f64 = 1.0;
const ZETA: f64 = 0.05;
const SHAPE: f64 = 1.0;
/// Stiffness 1/F of the stop: three times that of the spring.
const STOP: f64 = 3.0;
const CLEARANCE: f64 = 0.3;
const AMPLITUDE: f64 = 0.5;

/// State η and η̇.
type State = [f64; 2];
type Matrix = [[f64; 2]; 2];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn times(a: &Matrix, x: State) -> State {
    [a[0][0] * x[0] + a[0][1] * x[1], a[1][0] * x[0] + a[1][1] * x[1]]
}

/// Linear phase, touching or free, at a speed Ω of the stop.
struct Phase {
    speed: f64,
    stiffness: f64,
    /// Static force and amplitude of the harmonic force.
    force: (f64, f64),
}

impl Phase {
    fn new(speed: f64, touching: bool) -> Self {
        let (stiffness, force) = if touching {
            (OMEGA * OMEGA + SHAPE * SHAPE * STOP, (SHAPE * STOP * CLEARANCE, -SHAPE * STOP * AMPLITUDE))
        } else {
            (OMEGA * OMEGA, (0.0, 0.0))
        };
        Self { speed, stiffness, force }
    }

    /// Motion that the forces alone keep up.
    fn forced(&self, t: f64) -> State {
        let transfer = c64::new(self.stiffness - self.speed.powi(2), 2.0 * ZETA * OMEGA * self.speed);
        let x = c64::from_polar(self.force.1, self.speed * t) / transfer;
        [x.re + self.force.0 / self.stiffness, (x * c64::new(0.0, self.speed)).re]
    }

    /// Transition matrix of a disturbance over the time `t`.
    fn transition(&self, t: f64) -> Matrix {
        let decay = ZETA * OMEGA;
        let damped = (self.stiffness - decay * decay).sqrt();
        let (sin, cos) = (damped * t).sin_cos();
        let factor = (-decay * t).exp();
        [
            [factor * (cos + decay / damped * sin), factor * sin / damped],
            [-factor * self.stiffness / damped * sin, factor * (cos - decay / damped * sin)],
        ]
    }

    fn after(&self, x: State, from: f64, t: f64) -> State {
        let (start, end) = (self.forced(from), self.forced(from + t));
        let moved = times(&self.transition(t), [x[0] - start[0], x[1] - start[1]]);
        [moved[0] + end[0], moved[1] + end[1]]
    }
}

/// Overlap of mass and stop: positive where the stop is met.
fn overlap(x: State, speed: f64, t: f64) -> f64 {
    SHAPE * x[0] + AMPLITUDE * (speed * t).cos() - CLEARANCE
}

/// State after a period, and its derivative.
fn flow(mut x: State, speed: f64) -> (State, Matrix) {
    let period = TAU / speed;
    let (mut t, mut derivative) = (0.0, [[1.0, 0.0], [0.0, 1.0]]);
    while t < period {
        let touching = overlap(x, speed, t) > 0.0;
        let phase = Phase::new(speed, touching);
        let goes_on = |dt: f64| (overlap(phase.after(x, t, dt), speed, t + dt) > 0.0) == touching;
        // Past the present instant, which may lie between two phases; then to where this one ends.
        let least = 1e-9 * period;
        let (mut held, mut next) = (least, least);
        while t + next < period && (next == least || goes_on(next)) {
            held = next;
            next += period / 4096.0;
        }
        if t + next >= period && goes_on(period - t) {
            held = period - t;
        } else {
            let mut ended = next.min(period - t);
            while ended - held > 1e-14 * period {
                let middle = 0.5 * (held + ended);
                if goes_on(middle) { held = middle } else { ended = middle }
            }
            held = ended;
        }
        x = phase.after(x, t, held);
        derivative = product(&phase.transition(held), &derivative);
        t += held;
    }
    (x, derivative)
}

/// Periodic response near `x`, with its multipliers' sum and product, by Newton's method on the closed forms.
fn exact(mut x: State, speed: f64) -> (State, f64, f64) {
    for _ in 0..40 {
        let (end, d) = flow(x, speed);
        let (a, b, c, e) = (1.0 - d[0][0], -d[0][1], -d[1][0], 1.0 - d[1][1]);
        let (f, g) = (end[0] - x[0], end[1] - x[1]);
        let determinant = a * e - b * c;
        x = [x[0] + (e * f - b * g) / determinant, x[1] + (a * g - c * f) / determinant];
    }
    let (end, d) = flow(x, speed);
    assert!((end[0] - x[0]).abs() + (end[1] - x[1]).abs() < 1e-10, "{speed}: {end:?} {x:?}");
    (x, d[0][0] + d[1][1], d[0][0] * d[1][1] - d[0][1] * d[1][0])
}

/// Wheel of one sector with this mode, and a second mode that does not move but yields.
fn stopped_mode(speed: f64) -> ModalWheel {
    let stiff = 1e3;
    let yielding = (STOP.recip()).sqrt() * stiff;
    ModalWheel {
        speed_rad_s: speed,
        sectors: 1,
        repeats: 1,
        harmonics: vec![ModalHarmonic {
            harmonic: 0,
            single: true,
            omega: vec![OMEGA, stiff],
            contact: Mat::from_fn(3, 2, |row, mode| {
                c64::new(
                    if row > 0 {
                        0.0
                    } else if mode == 0 {
                        SHAPE
                    } else {
                        yielding
                    },
                    0.0,
                )
            }),
            gyroscopic: None,
        }],
    }
}

/// Simulation of the mode against the stop, without its wheel.
struct Stop {
    node: [ContactNode; 1],
    damping: ModalDamping,
    casing: Casing,
    steps: usize,
}

impl Stop {
    fn new(steps: usize) -> Self {
        Self {
            node: [ContactNode {
                id: 1,
                position: [1e9, 0.0, 0.0],
                normal: [1.0, 0.0, 0.0],
                dofs: [0, 1, 2],
            }],
            damping: ModalDamping { modal_ratio: ZETA, family_ratios: Vec::new(), ranks: Vec::new() },
            casing: Casing { clearance: vec![CLEARANCE], restriction: None, ramp_revolutions: 0.0 },
            steps,
        }
    }

    /// Calls `act` with the return map over a period of the stop.
    fn with<T>(&self, speed: f64, act: impl FnOnce(&mut Passage<'_>) -> T) -> T {
        let wheel = stopped_mode(speed);
        let simulation = Simulation {
            wheel: &wheel,
            contact_nodes: &self.node,
            damping: Some(&self.damping),
            casing: Some(&self.casing),
            effects: Effects::default(),
            initial: &[],
            sensors: &[],
            scheme: Scheme::MasslessBoundary { kept_modes: 1 },
            steps_per_revolution: self.steps,
            samples_per_revolution: 1,
            revolutions: 1,
            window_revolutions: 0,
            repeats: None,
            detail: None,
            states: None,
        };
        let shaken = RestrictionTable::new(|angle: f64, _| AMPLITUDE * angle.cos(), &[0.0], self.steps, 1, 8);
        act(&mut Passage::over_lobes(&simulation, 1).unwrap().against(shaken))
    }
}

impl Family for Stop {
    fn with(&self, value: f64, _: Lap, act: &mut dyn FnMut(&mut Passage<'_>)) -> Result<(), Unreachable> {
        self.with(value, |passage| act(passage));
        Ok(())
    }

    fn carry(&self, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Unreachable> {
        let mut carried = state.clone();
        carried.modes.iter_mut().for_each(|mode| mode.increment *= from / to);
        Ok(carried)
    }
}

#[test]
fn response_and_multipliers_are_those_of_the_closed_forms() {
    for speed in [0.45, 0.8, 1.2, 1.9] {
        for steps in [8_000, 64_000] {
            Stop::new(steps).with(speed, |passage| {
                let search = Search { tolerance: 1e-12, marched: 20, most: 1000 };
                let found = find(passage, &[0.0, 0.0], &search, &|| true).unwrap();
                passage.map(&found.state).unwrap();
                assert!(!passage.trace().instants.is_empty(), "{speed}: the stop is not met");
                let pair = multipliers(&Tangent::of(passage), 2, &[1.0; 2]);
                let (sum, product) = (pair[0].value + pair[1].value, pair[0].value * pair[1].value);
                // d/h is the velocity half a step before, which changes the state's numbers but not those of the derivative.
                let (x, exact_sum, exact_product) = exact([found.state[0] / OMEGA, found.state[1]], speed);
                // Damping acts alike in both phases.
                assert!((exact_product - (-2.0 * ZETA * OMEGA * TAU / speed).exp()).abs() < 1e-9);
                assert!((product - exact_product).norm() < 1e-9, "{speed}");
                // Of second order, and of first where phases end within a step.
                let step = 1.0 / steps as f64;
                let off = (found.state[0] / OMEGA - x[0]).abs();
                assert!(off < 10.0 * step * step, "{speed} {steps}: {off:e}");
                let off = (sum - exact_sum).norm();
                assert!(off < 6.0 * step, "{speed} {steps}: {off:e}");
            });
        }
    }
}

/// Speed Ω near `speed` where the response of the closed forms near `x` has this multiplier, 1 or −1: Newton's method with differences.
fn exact_change(x: State, speed: f64, multiplier: f64) -> f64 {
    let off = |u: [f64; 3]| {
        let x = [u[0], u[1]];
        let (end, d) = flow(x, u[2]);
        let (sum, product) = (d[0][0] + d[1][1], d[0][0] * d[1][1] - d[0][1] * d[1][0]);
        [end[0] - x[0], end[1] - x[1], 1.0 - multiplier * sum + product]
    };
    let mut u = [x[0], x[1], speed];
    for _ in 0..12 {
        let here = off(u);
        let slope = |j: usize| {
            let by = 1e-6;
            let aside = |by: f64| {
                let mut v = u;
                v[j] += by;
                off(v)
            };
            let (ahead, behind) = (aside(by), aside(-by));
            [0, 1, 2].map(|i| (ahead[i] - behind[i]) / (2.0 * by))
        };
        let slopes = [0, 1, 2].map(slope);
        let matrix = Mat::from_fn(3, 3, |i, j| slopes[j][i]);
        let step = matrix.partial_piv_lu().solve(Mat::from_fn(3, 1, |i, _| here[i]));
        (0..3).for_each(|i| u[i] -= step[(i, 0)]);
    }
    let left = off(u).iter().fold(0.0f64, |most, x| most.max(x.abs()));
    assert!(left < 1e-9, "{left:e}");
    u[2]
}

/// Branch around two folds, where the closed forms have them: found as the places where it turns back, and as those where a multiplier passes 1.
#[test]
fn branches_turn_back_and_change_their_stability_where_the_closed_forms_do() {
    let stop = Stop::new(8_000);
    let (start, span) = (0.6, 2.0);
    let state = stop.with(start, |passage| {
        let search = Search { tolerance: 1e-10, marched: 20, most: 1000 };
        let found = find(passage, &[0.0, 0.0], &search, &|| true).unwrap();
        passage.stepped(&found.state)
    });
    let branch = Branch { family: &stop, lap: Lap::Lobes(1), span, go_on: &|| true };
    let tell = |motion: &Motion| {
        let leading = stop.with(motion.value, |passage| {
            let state = passage.state_of(&motion.state);
            passage.map(&state).unwrap();
            multipliers(&Tangent::of(passage), 1, &[1.0; 2])[0].value
        });
        Ok((leading.norm() - 1.0, leading))
    };
    // Of first order in the step, for where phases end within one the derivative jumps.
    let close = |place: &Motion| {
        let mode = place.state.modes[0];
        let step = TAU / place.value / 8_000.0;
        let exact = exact_change([mode.displacement.re, mode.increment.re / step], place.value, 1.0);
        assert!((place.value / exact - 1.0).abs() < 1e-5, "{} {exact}", place.value);
    };
    let mut front = Front::new(Motion { value: start, state }, span, -1.0);
    let mut folds = 0;
    loop {
        let found = match branch.next(&mut front, (0.36, 4.0)).unwrap() {
            Step::Edge(found) => {
                assert_eq!(found.motion.value, 0.36);
                break;
            }
            Step::Point(found) => found,
        };
        if let Some(before) = &front.before
            && (found.motion.value - front.last.value) * (front.last.value - before.value) < 0.0
        {
            let up = (front.last.value - before.value).signum();
            let points = [(before, ()), (&front.last, ()), (&found.motion, ())];
            let place = branch.summit(points, |motion, ()| up * motion.value, |()| 0.0, |_| Ok(())).unwrap();
            assert!(place.error <= 1e-6 * place.motion.value);
            close(&place.motion);
            let [a, b] = [before, &found.motion].map(|at| (at, tell(at).unwrap().0));
            assert!(a.1 * b.1 < 0.0, "{} {}", a.1, b.1);
            let place = branch.crossing(a, b, tell).unwrap().unwrap();
            assert!(place.told.re > 0.0 && place.told.im == 0.0, "{}", place.told);
            close(&place.motion);
            folds += 1;
        }
        front.move_to(found.motion);
    }
    assert_eq!(folds, 2);
}

/// Flips at few steps, whose multipliers are off, and jump wherever a phase ends in another step: a flip is as far from that of the closed
/// forms as finer steps indicate, and no farther than the steps explain.
#[test]
fn flips_lie_within_the_error_that_finer_steps_tell() {
    let leading = |stop: &Stop, motion: &Motion| {
        stop.with(motion.value, |passage| {
            let state = passage.state_of(&motion.state);
            passage.map(&state).unwrap();
            multipliers(&Tangent::of(passage), 1, &[1.0; 2])[0].value
        })
    };
    let mut flips = 0;
    for steps in [200, 500, 1_000, 2_000, 4_000] {
        let stop = Stop::new(steps);
        let start = 1.9;
        let state = stop.with(start, |passage| {
            let search = Search { tolerance: 1e-10, marched: 20, most: 1000 };
            let found = find(passage, &[0.0, 0.0], &search, &|| true).unwrap();
            passage.stepped(&found.state)
        });
        let branch = Branch { family: &stop, lap: Lap::Lobes(1), span: 2.0, go_on: &|| true };
        let growth = |motion: &Motion| leading(&stop, motion).norm() - 1.0;
        let tell = |motion: &Motion| Ok((growth(motion), leading(&stop, motion)));
        let mut front = Front::new(Motion { value: start, state }, branch.span, 1.0);
        let mut last = growth(&front.last);
        loop {
            let (found, is_edge) = match branch.next(&mut front, (start, 3.6)).unwrap() {
                Step::Edge(found) => (found, true),
                Step::Point(found) => (found, false),
            };
            let now = growth(&found.motion);
            if last * now < 0.0 {
                let place =
                    branch.crossing((&front.last, last), (&found.motion, now), tell).unwrap().unwrap();
                assert!(place.told.re < 0.0);
                let finer = [3usize, 8].map(|times| {
                    let stop = Stop::new(times * steps);
                    let motion = Branch { family: &stop, ..branch }
                        .with_more_steps(&place.motion, times as f64)
                        .unwrap();
                    FinerGrowth { times: times as f64, growth: leading(&stop, &motion).norm() - 1.0 }
                });
                let value = place.motion.value;
                let share = (value - front.last.value) / (found.motion.value - front.last.value);
                let [before, behind] = [share - 0.1, share + 0.1]
                    .map(|share| branch.between(&front.last, &found.motion, share).unwrap().motion);
                let slope = (growth(&behind) - growth(&before)) / (behind.value - before.value);
                let error = off_by_steps(place.told.norm() - 1.0, slope, &finer).max(place.error);
                let (mode, step) = (place.motion.state.modes[0], TAU / value / steps as f64);
                let exact = exact_change([mode.displacement.re, mode.increment.re / step], value, -1.0);
                let off = (value - exact).abs();
                println!("{steps} steps: {value} for {exact}, off by {off:.1e}, error {error:.1e}");
                assert!(off <= error && error <= 20.0 / steps as f64, "{steps}: {off:e} {error:e}");
                flips += 1;
            }
            last = now;
            front.move_to(found.motion);
            if is_edge {
                break;
            }
        }
    }
    assert!(flips >= 10, "{flips}");
}
