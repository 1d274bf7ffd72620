//! Periodic response of a wheel that touches mildly, by harmonic balance with many harmonics: a literal reference that shares no map, no
//! step and no contact solver with the code that it checks.
//!
//! Modes with mass, z̈ + 2ζωż + ω²z = −Aλ, are Fourier series over a revolution; modes without mass give the boundary W_r λ, and the forces
//! follow instant by instant from 0 ≤ c − p − Aᵀz + W_r λ ⊥ λ ≥ 0, of which all sets of touching blades are tried.

use std::f64::consts::TAU;

use faer::prelude::Solve;
use faer::{Mat, c64};

use super::response::{record, seek};
use super::stability::Stability;
use crate::dynamics::casing::{Casing, Lobes};
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::Effects;
use crate::dynamics::integrate::{Outcome, SensorRow, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

const SECTORS: usize = 3;
const KEPT: usize = 2;
const SPEED: f64 = 1000.0;
const ZETA: f64 = 0.05;
const CLEARANCE: f64 = 0.25;
const SAMPLES: usize = 360;
const LOBE: Lobes = Lobes { count: 1, amplitude: 0.3, width_rad: 0.5, phase_rad: 0.2 };

fn wheel() -> ModalWheel {
    let harmonic = |harmonic: usize, shapes: [c64; 4]| ModalHarmonic {
        harmonic,
        single: harmonic == 0,
        omega: (0..4).map(|mode| [2300.0, 5200.0, 8000.0, 9000.0][mode] + 300.0 * harmonic as f64).collect(),
        contact: Mat::from_fn(3, 4, |row, mode| if row == 0 { shapes[mode] } else { c64::new(0.0, 0.0) }),
        gyroscopic: None,
    };
    let real = |x: f64| c64::new(x, 0.0);
    ModalWheel {
        speed_rad_s: SPEED,
        sectors: SECTORS,
        repeats: 1,
        harmonics: vec![
            harmonic(0, [real(40.0), real(-30.0), real(300.0), real(200.0)]),
            harmonic(1, [c64::new(35.0, 10.0), c64::new(-20.0, 15.0), c64::new(250.0, 90.0), real(240.0)]),
        ],
    }
}

/// Real oscillator: ω and the displacement of every blade per unit of its coordinate.
struct Oscillator {
    omega: f64,
    row: [f64; SECTORS],
}

/// Oscillators of a family.
fn oscillators(wheel: &ModalWheel, family: usize) -> Vec<Oscillator> {
    let parts = wheel.harmonics.iter().flat_map(|modes| {
        let weight = (if modes.single { 1.0 } else { 2.0 } / SECTORS as f64).sqrt();
        let at = |sector: usize| {
            let angle = TAU * (modes.harmonic * sector) as f64 / SECTORS as f64;
            modes.contact[(0, family)] * c64::new(angle.cos(), angle.sin()) * weight
        };
        let (re, im) = (std::array::from_fn(|s| at(s).re), std::array::from_fn(|s| -at(s).im));
        let of = |row: [f64; SECTORS]| Oscillator { omega: modes.omega[family], row };
        if modes.single { vec![of(re)] } else { vec![of(re), of(im)] }
    });
    parts.collect()
}

struct Balance {
    kept: Vec<Oscillator>,
    flexibility: [[f64; SECTORS]; SECTORS],
    orders: usize,
    instants: usize,
}

impl Balance {
    fn new(orders: usize) -> Self {
        let wheel = wheel();
        let mut flexibility = [[0.0; SECTORS]; SECTORS];
        for following in (KEPT..4).flat_map(|family| oscillators(&wheel, family)) {
            for (a, line) in flexibility.iter_mut().enumerate() {
                for (b, entry) in line.iter_mut().enumerate() {
                    *entry += following.row[a] * following.row[b] / following.omega.powi(2);
                }
            }
        }
        let kept = (0..KEPT).flat_map(|family| oscillators(&wheel, family)).collect();
        Self { kept, flexibility, orders, instants: 16 * orders }
    }

    /// Number of terms of an oscillator's series: mean, then cosine and sine of every order.
    fn numbers(&self) -> usize {
        2 * self.orders + 1
    }

    /// Displacement of every blade at an angle of the shaft, were there no force.
    fn free(&self, series: &[f64], angle: f64) -> [f64; SECTORS] {
        let mut at = [0.0; SECTORS];
        for (oscillator, series) in self.kept.iter().zip(series.chunks_exact(self.numbers())) {
            let mut z = series[0];
            for (order, pair) in (1..).zip(series[1..].chunks_exact(2)) {
                let (sin, cos) = (f64::from(order) * angle).sin_cos();
                z += pair[0] * cos + pair[1] * sin;
            }
            at.iter_mut().zip(oscillator.row).for_each(|(at, row)| *at += row * z);
        }
        at
    }

    /// Contact forces at an angle, with the lobe grown to a share of its height: the one set of touching blades that all conditions hold for.
    fn forces(&self, series: &[f64], angle: f64, grown: f64) -> [f64; SECTORS] {
        let free = self.free(series, angle);
        let gaps: [f64; SECTORS] = std::array::from_fn(|sector| {
            let at = angle + TAU * sector as f64 / SECTORS as f64;
            CLEARANCE - grown * LOBE.height(at) - free[sector]
        });
        for set in 0..1 << SECTORS {
            let touching: Vec<usize> = (0..SECTORS).filter(|sector| set >> sector & 1 == 1).collect();
            let n = touching.len();
            let w = Mat::from_fn(n, n, |i, j| self.flexibility[touching[i]][touching[j]]);
            let lambda = w.partial_piv_lu().solve(Mat::from_fn(n, 1, |i, _| -gaps[touching[i]]));
            let mut forces = [0.0; SECTORS];
            touching.iter().enumerate().for_each(|(i, &sector)| forces[sector] = lambda[(i, 0)]);
            let open = |sector: usize| {
                let yields: f64 = (0..SECTORS).map(|b| self.flexibility[sector][b] * forces[b]).sum();
                set >> sector & 1 == 1 || gaps[sector] + yields >= 0.0
            };
            if forces.iter().all(|&force| force >= 0.0) && (0..SECTORS).all(open) {
                return forces;
            }
        }
        panic!("no set of blades may touch")
    }

    /// Residual of every order of every equation of motion.
    fn residual(&self, series: &[f64], grown: f64) -> Vec<f64> {
        let numbers = self.numbers();
        let mut left = vec![0.0; series.len()];
        for instant in 0..self.instants {
            let angle = TAU * instant as f64 / self.instants as f64;
            let forces = self.forces(series, angle, grown);
            if forces == [0.0; SECTORS] {
                continue;
            }
            for (oscillator, left) in self.kept.iter().zip(left.chunks_exact_mut(numbers)) {
                let load: f64 = oscillator.row.iter().zip(forces).map(|(row, force)| row * force).sum();
                let load = load / self.instants as f64;
                left[0] += load;
                for (order, pair) in (1..).zip(left[1..].chunks_exact_mut(2)) {
                    let (sin, cos) = (f64::from(order) * angle).sin_cos();
                    pair[0] += 2.0 * load * cos;
                    pair[1] += 2.0 * load * sin;
                }
            }
        }
        let lines = series.chunks_exact(numbers).zip(left.chunks_exact_mut(numbers));
        for (oscillator, (series, left)) in self.kept.iter().zip(lines) {
            let omega = oscillator.omega;
            left[0] += omega * omega * series[0];
            for (order, (z, left)) in
                (1..).zip(series[1..].chunks_exact(2).zip(left[1..].chunks_exact_mut(2)))
            {
                let excited = f64::from(order) * SPEED;
                let (stiffness, damping) = (omega * omega - excited * excited, 2.0 * ZETA * omega * excited);
                left[0] += stiffness * z[0] + damping * z[1];
                left[1] += stiffness * z[1] - damping * z[0];
            }
        }
        left
    }

    /// Solves for the response, the lobe growing in steps, each by Newton's method with differences.
    fn solve(&self) -> Vec<f64> {
        let size = self.kept.len() * self.numbers();
        let mut series = vec![0.0; size];
        for grown in [0.9, 0.95, 1.0] {
            let largest = |x: &[f64]| x.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            let mut left = self.residual(&series, grown);
            for _ in 0..30 {
                if largest(&left) <= 1e-9 * SPEED * SPEED {
                    break;
                }
                let step = 1e-7;
                let mut derivative = Mat::zeros(size, size);
                for column in 0..size {
                    let mut moved = series.clone();
                    moved[column] += step;
                    let there = self.residual(&moved, grown);
                    (0..size).for_each(|row| derivative[(row, column)] = (there[row] - left[row]) / step);
                }
                let change = derivative.partial_piv_lu().solve(Mat::from_fn(size, 1, |row, _| -left[row]));
                series.iter_mut().enumerate().for_each(|(row, x)| *x += change[(row, 0)]);
                left = self.residual(&series, grown);
            }
            assert!(largest(&left) <= 1e-9 * SPEED * SPEED, "{grown}: {:e}", largest(&left));
        }
        series
    }

    /// Displacement of blade 0 at the samples of a revolution.
    fn blade(&self, series: &[f64]) -> Vec<f64> {
        let at = |sample: usize| {
            let angle = TAU * sample as f64 / SAMPLES as f64;
            let forces = self.forces(series, angle, 1.0);
            let yields: f64 = (0..SECTORS).map(|b| self.flexibility[0][b] * forces[b]).sum();
            self.free(series, angle)[0] - yields
        };
        (1..=SAMPLES).map(at).collect()
    }
}

#[test]
fn responses_are_those_of_harmonic_balance_within_its_truncation() {
    let wheel = wheel();
    let node = [ContactNode { id: 1, position: [1e9, 0.0, 0.0], normal: [1.0, 0.0, 0.0], dofs: [0, 1, 2] }];
    let damping = ModalDamping { modal_ratio: ZETA, family_ratios: Vec::new(), ranks: Vec::new() };
    let casing = Casing { clearance: vec![CLEARANCE], restriction: Some(LOBE.into()), ramp_revolutions: 1.0 };
    let radial = Direction { node: 0, components: [1.0, 0.0, 0.0] };
    let simulation = Simulation {
        wheel: &wheel,
        contact_nodes: &node,
        damping: Some(&damping),
        casing: Some(&casing),
        effects: Effects::default(),
        initial: &[],
        sensors: &[SensorRow { direction: radial, sector: 0 }],
        scheme: Scheme::MasslessBoundary { kept_modes: KEPT },
        steps_per_revolution: 100 * SAMPLES,
        samples_per_revolution: SAMPLES,
        revolutions: 1,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: None,
    };
    let response = seek(&simulation, 100, false, &|| true).response.unwrap();
    assert_eq!(response.floquet.stability, Stability::Stable);
    let run = record(&simulation, &response, &|_| true);
    assert!(run.statistics.contact_share() > 0.05, "{}", run.statistics.contact_share());
    let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
    let found = &history.displacement[0];
    let balanced = [10, 20, 40].map(|orders| {
        let balance = Balance::new(orders);
        balance.blade(&balance.solve())
    });
    let away = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    let largest = found.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let [coarse, middle, fine] = balanced.each_ref().map(|line| away(line, found) / largest);
    let truncated = away(&balanced[1], &balanced[2]) / largest;
    assert!(
        fine <= truncated && fine < 0.5 * middle && middle < 0.5 * coarse,
        "{coarse:e} {middle:e} {fine:e}"
    );
    assert!(fine < 1e-4, "{fine:e}");
}
