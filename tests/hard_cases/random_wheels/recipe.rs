//! Recipes of random wheels and casings, with the reasons for their ranges.

use std::f64::consts::{PI, TAU};

use faer::{Mat, c64};
use proptest::prelude::*;
use proptest::sample::select;
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::{History, Run, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::ContactNode;
use rubmap::numerics::sector_fourier::is_single;

use crate::fixtures::Numbers;

/// Speed Ω of all wheels, rad/s: only ratios of frequencies matter.
const SPEED: f64 = 1000.0;

/// Radius of the tips: a run ends as diverged at a tenth of it.
pub(super) const RADIUS: f64 = 100.0;

pub(super) const REVOLUTIONS: usize = 2;

/// Modal mass, t: a titanium blade of some grams.
const MASS: f64 = 1e-5;

/// Shapes by which the contact nodes see the modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shapes {
    /// Independent shapes: each node sees the modes in its own way; fewer modes than nodes still cannot tell the nodes apart.
    Independent,
    /// Coincident nodes: node 1 is where node 0 is.
    Coincident,
}

/// Recipe of a case; the seed draws shapes, frequencies, normals and clearances.
#[derive(Debug, Clone)]
pub(super) struct Recipe {
    pub(super) seed: u64,
    pub(super) sectors: usize,
    pub(super) nodes: usize,
    pub(super) modes: usize,
    pub(super) decades: f64,
    pub(super) shapes: Shapes,
    damping: Option<f64>,
    lobes: u32,
    pub(super) width_rad: f64,
    clearance: f64,
    amplitude: f64,
    pub(super) ramp_revolutions: f64,
    pub(super) moving: bool,
    pub(super) steps: usize,
    stability: f64,
}

/// Recipes over all ranges. One to twelve sectors have every kind of nodal diameter, 64 the most blades there are.
/// Contact nodes and modes run from one to what a small reduced wheel has, fewer modes than nodes included. Frequencies
/// spread over no decade (all equal), the one of a blade's first families, the five of ω² over ten, and ten, beyond what
/// a reduction lets pass. Lengths are tenths of a millimetre about tips of 100 mm, clearances also zero, lobes from none
/// to thrice a clearance. Steps go from 0.2 to 0.9999 of the limit of central differences.
pub(super) fn recipes() -> impl Strategy<Value = Recipe> {
    let wheel = (
        any::<u32>(),
        prop_oneof![19 => 1..=12usize, 1 => Just(64)],
        1..=6usize,
        1..=20usize,
        select(vec![0.0, 1.0, 5.0, 10.0]),
        prop_oneof![3 => Just(Shapes::Independent), 1 => Just(Shapes::Coincident)],
        select(vec![None, Some(0.0), Some(1e-3), Some(0.3), Some(0.95)]),
    );
    let casing =
        (1..=7u32, 0.05..1.5f64, prop_oneof![1 => Just(0.0), 4 => 0.05..0.5f64], 0.0..0.6f64, 0.05..1.0f64);
    let run = (any::<bool>(), 500..3000usize, prop_oneof![3 => 0.2..0.95f64, 1 => 0.95..0.9999f64]);
    (wheel, casing, run).prop_map(|(wheel, casing, run)| {
        let (seed, sectors, nodes, modes, decades, shapes, damping) = wheel;
        let (lobes, width_rad, clearance, amplitude, ramp_revolutions) = casing;
        let (moving, steps, stability) = run;
        Recipe {
            seed: seed.into(),
            sectors,
            nodes,
            modes,
            decades,
            shapes,
            damping,
            lobes,
            width_rad,
            clearance,
            amplitude,
            ramp_revolutions,
            moving,
            steps,
            stability,
        }
    })
}

/// Case made by a recipe.
pub(super) struct Case {
    pub(super) wheel: ModalWheel,
    pub(super) contact_nodes: Vec<ContactNode>,
    damping: Option<ModalDamping>,
    pub(super) casing: Casing,
    initial: Vec<InitialMode>,
    /// Sensors along the normals of the first and the last node, at the first and the last sector.
    sensors: Vec<SensorRow>,
}

impl Recipe {
    pub(super) fn case(&self) -> Case {
        let mut numbers = Numbers::new(self.seed);
        let mut centred = move || 2.0 * numbers.next() - 1.0;
        let mut contact_nodes: Vec<_> = (0..self.nodes).map(|k| contact_node(k, &mut centred)).collect();
        // h ω_max = 2·stability with `steps` per revolution.
        let largest = self.stability * SPEED * self.steps as f64 / PI;
        let harmonics = (0..=self.sectors / 2).map(|i| self.harmonic(i, largest, &mut centred)).collect();
        let mut clearance: Vec<_> =
            contact_nodes.iter().map(|_| self.clearance * (1.0 + 0.3 * centred())).collect();
        if self.shapes == Shapes::Coincident && self.nodes > 1 {
            contact_nodes[1] = contact_nodes[0].clone();
            clearance[1] = clearance[0];
        }
        let wheel = ModalWheel { speed_rad_s: SPEED, sectors: self.sectors, repeats: 1, harmonics };
        let initial = InitialMode {
            harmonic: self.sectors / 2,
            family: 0,
            // It is a tenth of a millimetre at a tip whose shape is about 1/√m.
            displacement: c64::new(0.1 * MASS.sqrt(), 0.05 * MASS.sqrt()),
            velocity: c64::new(0.0, 0.0),
        };
        let sensors = [(0, 0), (self.nodes - 1, self.sectors - 1)].map(|(node, sector)| SensorRow {
            direction: Direction { node, components: contact_nodes[node].normal },
            sector,
        });
        Case {
            wheel,
            contact_nodes,
            damping: self.damping.map(|modal_ratio| ModalDamping {
                modal_ratio,
                family_ratios: vec![0.01],
                ranks: Vec::new(),
            }),
            casing: Casing {
                clearance,
                restriction: Some(
                    Lobes {
                        count: self.lobes,
                        amplitude: self.amplitude,
                        width_rad: self.width_rad,
                        phase_rad: centred(),
                    }
                    .into(),
                ),
                ramp_revolutions: self.ramp_revolutions,
            },
            initial: if self.moving { vec![initial] } else { Vec::new() },
            sensors: sensors.to_vec(),
        }
    }

    fn harmonic(&self, harmonic: usize, largest: f64, centred: &mut impl FnMut() -> f64) -> ModalHarmonic {
        let single = is_single(harmonic, self.sectors);
        let mut omega: Vec<_> =
            (0..self.modes).map(|_| largest * 10f64.powf(-self.decades * centred().abs())).collect();
        omega.sort_by(f64::total_cmp);
        let mut contact = Mat::from_fn(3 * self.nodes, self.modes, |_, _| {
            c64::new(centred(), if single { 0.0 } else { centred() }) / MASS.sqrt()
        });
        if self.shapes == Shapes::Coincident && self.nodes > 1 {
            for m in 0..self.modes {
                for d in 0..3 {
                    contact[(3 + d, m)] = contact[(d, m)];
                }
            }
        }
        ModalHarmonic { harmonic, single, omega, contact, gyroscopic: None }
    }
}

fn contact_node(k: usize, centred: &mut impl FnMut() -> f64) -> ContactNode {
    // The normal has any direction: a vector cut off near zero is too short to be normalised.
    let normal = loop {
        let n = [centred(), centred(), centred()];
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.1 {
            break n.map(|x| x / length);
        }
    };
    ContactNode {
        id: k as u64,
        position: [RADIUS - k as f64, 0.3 * centred(), 5.0 * k as f64],
        normal,
        dofs: [3 * k, 3 * k + 1, 3 * k + 2],
    }
}

impl Case {
    /// Runs the case and records every step.
    pub(super) fn run(&self, scheme: Scheme, steps: usize) -> Run {
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.contact_nodes,
            damping: self.damping.as_ref(),
            casing: Some(&self.casing),
            effects: Effects::default(),
            initial: &self.initial,
            sensors: &self.sensors,
            scheme,
            steps_per_revolution: steps,
            samples_per_revolution: steps,
            revolutions: REVOLUTIONS,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }

    /// Deepest penetration of a sensor over its history, by the formula of the casing.
    pub(super) fn deepest(&self, history: &History, steps: usize) -> f64 {
        let mut deepest = 0.0f64;
        for (sensor, line) in self.sensors.iter().zip(&history.displacement) {
            let node = sensor.direction.node;
            let angle =
                self.contact_nodes[node].position[1] + TAU * sensor.sector as f64 / self.wheel.sectors as f64;
            for (sample, u) in line.iter().enumerate() {
                let revolutions = (sample + 1) as f64 / steps as f64;
                let restriction = self.casing.restriction.as_ref();
                let height = restriction.map_or(0.0, |r| r.height(angle + TAU * revolutions, node));
                let gap = self.casing.clearance[node] - self.casing.growth(revolutions) * height - u;
                deepest = deepest.max(-gap);
            }
        }
        deepest
    }
}
