//! Scenes of small wheels made by hand, with the effects they name.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::clearance_change::ClearanceChange;
use rubmap::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap::dynamics::contact::disc::disc_directions;
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::{Effects, Friction, FrictionLaw};
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::{History, Outcome, Run, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap::dynamics::orbit::Orbit;
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::ContactNode;
use rubmap::numerics::sector_fourier::is_single;

use crate::fixtures::Numbers;

/// Speed Ω of all wheels, rad/s.
pub(crate) const SPEED: f64 = 1000.0;

/// Modal mass, t: shapes are about 1/√m.
pub(crate) const MASS: f64 = 1e-5;

/// Effect of the time loop; all can be combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    Friction,
    Coating,
    FlexibleCasing,
    Orbit,
    ClearanceChange,
    Mistuning,
    Excitation,
    Coriolis,
}

pub(crate) const EFFECTS: [Effect; 8] = [
    Effect::Friction,
    Effect::Coating,
    Effect::FlexibleCasing,
    Effect::Orbit,
    Effect::ClearanceChange,
    Effect::Mistuning,
    Effect::Excitation,
    Effect::Coriolis,
];

/// Abradable coating: its material, its thickness and its rods.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Abradable {
    pub(crate) material: CoatingMaterial,
    pub(crate) thickness: f64,
    pub(crate) rods_around: usize,
}

/// Start of the wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Start {
    Rest,
    Standing,
    Travelling,
}

/// Scene: a wheel, what surrounds it, and how it is integrated.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) wheel: ModalWheel,
    pub(crate) nodes: Vec<ContactNode>,
    pub(crate) damping: Option<ModalDamping>,
    pub(crate) casing: Option<Casing>,
    /// Coefficient of friction μ.
    pub(crate) friction: Option<f64>,
    /// Whether tips may stick, and slide in any direction, instead of forwards.
    pub(crate) disc: bool,
    pub(crate) coating: Option<Abradable>,
    pub(crate) flexible_casing: Option<FlexibleCasing>,
    pub(crate) orbit: Option<Orbit>,
    pub(crate) clearance_change: Option<ClearanceChange>,
    pub(crate) mistuning: Option<Vec<f64>>,
    pub(crate) excitation: Vec<EngineOrderExcitation>,
    pub(crate) initial: Vec<InitialMode>,
    pub(crate) sensors: Vec<SensorRow>,
    pub(crate) scheme: Scheme,
    pub(crate) steps: usize,
    pub(crate) samples: usize,
    pub(crate) revolutions: usize,
}

/// Wheel whose family m has the same real shape in every nodal diameter, of modal mass [`MASS`] at its largest, but for a
/// phase in every pair and a sign in every single one.
pub(crate) fn wheel(sectors: usize, nodes: usize, families: usize) -> ModalWheel {
    let mut numbers = Numbers::new(17 + sectors as u64);
    let shapes = Mat::from_fn(3 * nodes, families, |_, _| (2.0 * numbers.next() - 1.0) / MASS.sqrt());
    let harmonic = |harmonic: usize| {
        let single = is_single(harmonic, sectors);
        let omega: Vec<_> = (0..families)
            .map(|m| SPEED * (2.3 + 2.1 * m as f64 + (0.35 - 0.1 * m as f64) * harmonic as f64))
            .collect();
        let turns: Vec<_> = (0..families)
            .map(|m| match single {
                true if (harmonic + m).is_multiple_of(2) => c64::new(1.0, 0.0),
                true => c64::new(-1.0, 0.0),
                false => c64::cis(TAU * numbers.next()),
            })
            .collect();
        let contact = Mat::from_fn(3 * nodes, families, |row, m| turns[m] * shapes[(row, m)]);
        ModalHarmonic { harmonic, single, omega, contact, gyroscopic: None }
    };
    let harmonics = (0..=sectors / 2).map(harmonic).collect();
    ModalWheel { speed_rad_s: SPEED, sectors, repeats: 1, harmonics }
}

/// Sets a random skew-Hermitian g, of about `size`.
pub(crate) fn set_gyroscopic(wheel: &mut ModalWheel, size: f64) {
    let mut numbers = Numbers::new(5);
    let mut centred = move || 2.0 * numbers.next() - 1.0;
    for harmonic in &mut wheel.harmonics {
        let families = harmonic.omega.len();
        let mut g = Mat::zeros(families, families);
        for i in 0..families {
            for j in 0..=i {
                let (re, im) = (if i == j { 0.0 } else { centred() }, centred());
                let value = c64::new(re, if harmonic.single { 0.0 } else { im }) * size;
                g[(i, j)] = value;
                g[(j, i)] = -value.conj();
            }
        }
        harmonic.gyroscopic = Some(g);
    }
}

pub(crate) fn contact_nodes(count: usize) -> Vec<ContactNode> {
    let node = |k: usize| {
        let tilt = 0.4 + 0.3 * k as f64;
        let forward = 0.1 - 0.15 * k as f64;
        let across = (1.0f64 - forward * forward).sqrt();
        ContactNode {
            id: k as u64 + 1,
            position: [100.0 - 2.0 * k as f64, 0.137 - 0.21 * k as f64, 4.0 * k as f64],
            normal: [across * tilt.cos(), forward, across * tilt.sin()],
            dofs: [3 * k, 3 * k + 1, 3 * k + 2],
        }
    };
    (0..count).map(node).collect()
}

/// Direction n + μt of the force on a sliding node, with the tangent t = (e_θ − n_θ n)/|…|.
pub(crate) fn sliding(node: &ContactNode, mu: f64) -> [f64; 3] {
    let n = node.normal;
    let t = [-n[1] * n[0], 1.0 - n[1] * n[1], -n[1] * n[2]];
    let length = t.iter().map(|x| x * x).sum::<f64>().sqrt();
    [0, 1, 2].map(|d| n[d] + mu * t[d] / length)
}

impl Scene {
    /// Scene of two contact nodes and three modal families in two lobes that reach beyond the clearance, damped.
    pub(crate) fn rubbing(sectors: usize, start: Start) -> Self {
        let wheel = wheel(sectors, 2, 3);
        let nodes = contact_nodes(2);
        let (harmonic, family) = ((sectors - 1) / 2, 0);
        let omega = wheel.harmonics[harmonic].omega[family];
        let displacement = c64::new(0.12, 0.05) * MASS.sqrt();
        let velocity = match start {
            Start::Travelling => displacement * c64::new(0.0, -omega),
            Start::Rest | Start::Standing => c64::ZERO,
        };
        let push = InitialMode { harmonic, family, displacement, velocity };
        let sensors = vec![
            SensorRow { direction: Direction { node: 0, components: nodes[0].normal }, sector: 0 },
            SensorRow { direction: Direction { node: 1, components: [0.3, 1.0, -0.2] }, sector: sectors - 1 },
        ];
        Self {
            wheel,
            damping: Some(ModalDamping { modal_ratio: 0.03, family_ratios: vec![0.02], ranks: Vec::new() }),
            casing: Some(Casing {
                clearance: vec![0.3, 0.26],
                restriction: Some(
                    Lobes { count: 2, amplitude: 0.42, width_rad: 0.35, phase_rad: 0.1 }.into(),
                ),
                ramp_revolutions: 0.4,
            }),
            friction: None,
            disc: false,
            coating: None,
            flexible_casing: None,
            orbit: None,
            clearance_change: None,
            mistuning: None,
            excitation: Vec::new(),
            initial: if start == Start::Rest { Vec::new() } else { vec![push] },
            sensors,
            nodes,
            scheme: Scheme::CentralDifferences,
            // Every third step is recorded: a step is completed with the next one, or at its sample.
            steps: 900,
            samples: 300,
            revolutions: 2,
        }
    }

    /// Scene of one free motion without contact, recorded at every step.
    pub(crate) fn free(wheel: ModalWheel, initial: Vec<InitialMode>) -> Self {
        let sectors = wheel.sectors;
        let mut scene = Self::rubbing(sectors, Start::Rest);
        let nodes = wheel.harmonics[0].contact.nrows() / 3;
        scene.nodes = contact_nodes(nodes);
        let sensor = |sector: usize| SensorRow {
            direction: Direction { node: 0, components: [1.0, 0.0, 0.0] },
            sector,
        };
        scene.sensors = (0..sectors).map(sensor).collect();
        scene.casing = None;
        scene.damping = None;
        scene.wheel = wheel;
        scene.initial = initial;
        scene.samples = scene.steps;
        scene
    }

    /// Adds an effect, large enough to be seen.
    pub(crate) fn add(&mut self, effect: Effect) {
        match effect {
            Effect::Friction => self.friction = Some(0.15),
            Effect::Coating => {
                self.coating = Some(Abradable {
                    material: CoatingMaterial { modulus: 400.0, yield_stress: 2.0, hardening: 60.0 },
                    thickness: 0.1,
                    rods_around: 90,
                });
            }
            Effect::FlexibleCasing => {
                let wave = |nodal_diameter: u32, omega: f64, modal_mass: f64| CasingWave {
                    nodal_diameter,
                    omega: omega * SPEED,
                    modal_mass: modal_mass * MASS,
                };
                self.flexible_casing = Some(FlexibleCasing {
                    waves: vec![wave(0, 9.0, 60.0), wave(2, 3.1, 35.0), wave(3, 5.7, 30.0)],
                    damping_ratio: 0.01,
                });
            }
            Effect::Orbit => {
                self.orbit = Some(Orbit { radius: 0.07, whirl_ratio: -0.3, phase_rad: 0.4 });
            }
            Effect::ClearanceChange => {
                let course = vec![(0.5, 0.05), (0.9, 0.05), (1.7, -0.12)];
                let along_chord = (0..self.nodes.len()).map(|k| 1.0 - 0.4 * k as f64).collect();
                self.clearance_change = Some(ClearanceChange { course, along_chord: Some(along_chord) });
            }
            Effect::Mistuning => {
                let deviation = |s: usize| 0.08 * (1.7 * s as f64 + 0.6).sin();
                self.mistuning = Some((0..self.wheel.sectors).map(deviation).collect());
            }
            Effect::Excitation => {
                let force = |order, node, amplitude, ramp_revolutions| EngineOrderExcitation {
                    order,
                    directions: vec![
                        Direction { node, components: [0.4, 0.7, -0.5] },
                        Direction { node: 0, components: [0.0, 0.2, 0.6] },
                    ],
                    amplitude,
                    phase_rad: 0.3 * f64::from(order),
                    ramp_revolutions,
                };
                self.excitation = vec![force(1, 1, 2.0, 0.0), force(3, 0, 1.5, 0.5), force(4, 1, 3.0, 0.0)];
            }
            Effect::Coriolis => set_gyroscopic(&mut self.wheel, 0.4),
        }
    }

    pub(crate) fn with(mut self, effects: &[Effect]) -> Self {
        effects.iter().for_each(|&effect| self.add(effect));
        self
    }

    pub(crate) fn step_s(&self) -> f64 {
        TAU / (SPEED * self.steps as f64)
    }

    /// Runs the scene by the production code.
    pub(crate) fn run(&self) -> Run {
        let direction = |(node, contact): (usize, &ContactNode)| Direction {
            node,
            components: sliding(contact, self.friction.unwrap_or(0.0)),
        };
        let (law, directions) = if self.disc {
            (FrictionLaw::Disc, disc_directions(&self.nodes).unwrap())
        } else {
            (FrictionLaw::Sliding, self.nodes.iter().enumerate().map(direction).collect())
        };
        let coating = self.coating.map(|Abradable { material, thickness, rods_around }| {
            Coating::new(material, thickness, rods_around, &self.nodes, self.wheel.sectors).unwrap()
        });
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.nodes,
            damping: self.damping.as_ref(),
            casing: self.casing.as_ref(),
            effects: Effects {
                friction: (self.friction).map(|coefficient| Friction {
                    coefficient,
                    law,
                    directions: &directions,
                }),
                coating: coating.as_ref(),
                flexible_casing: self.flexible_casing.as_ref(),
                orbit: self.orbit,
                clearance_change: self.clearance_change.as_ref(),
                clearance_drift: None,
                mistuning: self.mistuning.as_deref(),
                bending: None,
                excitation: &self.excitation,
                euler_force: None,
                energies: false,
            },
            initial: &self.initial,
            sensors: &self.sensors,
            scheme: self.scheme,
            steps_per_revolution: self.steps,
            samples_per_revolution: self.samples,
            revolutions: self.revolutions,
            window_revolutions: self.revolutions,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }
}

/// History of a run that went to its end with balanced energy.
pub(crate) fn history(run: &Run) -> &History {
    let residual = run.energy.residual();
    assert!(residual < 1e-9, "energy residual {residual:e}");
    match &run.outcome {
        Outcome::Completed(history) => history,
        other => panic!("{other:?}"),
    }
}

/// Largest difference of two histories over the largest of their values.
pub(crate) fn difference(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let (mut largest, mut apart) = (0.0f64, 0.0f64);
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.len(), expected.len());
        for (f, e) in found.iter().zip(expected) {
            assert!(f.is_finite() && e.is_finite());
            largest = largest.max(e.abs());
            apart = apart.max((f - e).abs());
        }
    }
    assert!(largest > 0.0, "nothing moved");
    apart / largest
}
